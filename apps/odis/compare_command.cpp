// odis compare
#include "eval/compare.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <climits>
#include <filesystem>
#include <memory>

#include "command.h"
#include "compare_arguments.h"
#include "console.h"
#include "eval/comparison_json.h"
#include "eval/image_file.h"
#include "eval/markdown.h"
#include "eval/pictures.h"
#include "eval/report.h"
#include "eval/summary.h"
#include "output.h"
#include "render/files/replace_file.h"
#include "scene_warnings.h"

namespace odis::app {

namespace {

// A bar for each rendering if stderr is a terminal, otherwise a line every ten seconds.
class ConsoleObserver : public eval::CompareObserver {
 public:
  ConsoleObserver(bool quiet, bool strict)
      : m_quiet(quiet), m_strict(strict), m_terminal(onTerminal()), m_progress(quiet || !m_terminal) {}

  void begin(const eval::Outlook& outlook) override {
    if (m_quiet || outlook.secondsLeft < 1) return;
    say(fmt::format(
        "{} renderings, about {} by a sample per pixel of the first scene; less where results are "
        "there already\n",
        outlook.total, durationText(outlook.secondsLeft)));
  }
  void start(const std::string& what, const eval::Outlook& outlook) override {
    std::string title = fmt::format("[{}/{}", outlook.done + 1, outlook.total);
    if (outlook.secondsLeft > 0) title += ", " + durationText(outlook.secondsLeft) + " left";
    title += "] " + what;
    m_progress.setTitle(title);
    if (!m_quiet && !m_terminal && m_pace.isDue()) say(title + "\n");
  }
  void warnings(const std::string& scene, const render::Warnings& warnings) override {
    tellWarnings(scene, warnings, {.quiet = m_quiet, .strict = m_strict});
  }
  render::Progress& progress() override { return m_progress; }

 private:
  bool m_quiet, m_strict, m_terminal;
  ConsoleProgress m_progress;
  LinePace m_pace;
};

}  // namespace

// Images are named after scene and method; these are other letters of their names.
constexpr size_t kLongestNames = NAME_MAX - 65;

static void checkNames(const eval::CompareSettings& settings) {
  namespace fs = std::filesystem;
  for (const std::string& scene : settings.scenes)
    for (const eval::Method& method : settings.methods)
      if (eval::sceneName(scene).size() + method.name.size() > kLongestNames)
        throw UsageError(
            fmt::format("the scene \"{}\" and the method \"{}\" give their names to images: expected at "
                        "most {} letters in both",
                        eval::sceneName(scene), method.name, kLongestNames));
  const fs::path images = fs::weakly_canonical(fs::path(settings.folder) / "images");
  if (!settings.reference.empty() && fs::weakly_canonical(settings.reference).parent_path() == images)
    throw UsageError(fmt::format(
        "--reference: {} is in the folder that images are written to, expected another", settings.reference));
}

static void prepareFolder(const eval::CompareSettings& settings) {
  render::makeFolder(settings.folder);
  Outputs outputs;
  for (const char* name : {"results.jsonl", "comparison.md", "comparison.json", "report.html"})
    outputs.add(settings.folder + "/" + name, {});
  outputs.rejectInputs(settings.scenes);
  outputs.rejectInputs({settings.reference});
}

// Where a method has no row at equal time: not one sample fits in that of the first method.
static void tellWhatDoesNotFit(const eval::CompareSettings& settings,
                               const std::vector<eval::ComparisonRow>& rows) {
  for (const eval::ComparisonRow& row : rows) {
    if (row.equalTime || row.denoised || row.isMean() || row.method == settings.methods.front().name)
      continue;
    const bool fits = std::any_of(rows.begin(), rows.end(), [&](const eval::ComparisonRow& other) {
      return other.equalTime && other.scene == row.scene && other.method == row.method &&
             other.spp == row.spp;
    });
    if (!fits)
      say(fmt::format("{}: no sample of {} fits in the time of {} of {}\n", row.scene, row.method, row.spp,
                      settings.methods.front().name));
  }
}

static int runCompare(CompareArguments& a) {
  a.apply();
  const eval::CompareSettings& settings = a.settings;
  // Before time is spent.
  checkNames(settings);
  if (!settings.reference.empty()) eval::readColor(settings.reference);
  prepareFolder(settings);

  const InterruptScope interruptible;
  ConsoleObserver observer(a.quiet, a.part.strict);
  const eval::Comparison comparison = eval::compare(settings, observer);
  if (comparison.measurements.empty()) {
    say("interrupted before there was a result; nothing is written\n");
    return InterruptScope::exitCode();
  }
  const std::vector<eval::ComparisonRow> rows = eval::summarize(comparison.measurements);
  const std::string tables = eval::markdownTables(rows, comparison.scenes);
  eval::Provenance provenance{a.commandLine, eval::machineName()};
  if (settings.denoiser) provenance.denoiser = settings.denoiser->name();
  const auto json = eval::comparisonJson(comparison, rows, settings.methods, provenance);
  writeText(settings.folder + "/comparison.md", tables);
  // The command line may hold bytes that are no UTF-8.
  writeText(settings.folder + "/comparison.json",
            json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  if (!rows.empty())
    writeText(settings.folder + "/report.html", eval::reportPage(comparison, rows, json, settings.folder));
  if (a.images) eval::writePictures(comparison, rows, settings.folder, a.exposure);
  fmt::print("{}", a.wide ? tables : eval::narrowTables(rows, comparison.scenes));
  if (settings.equalTime && !a.quiet) tellWhatDoesNotFit(settings, rows);
  if (!rows.empty() && !a.quiet)
    say(fmt::format("report: {0}/report.html; all columns (--wide): {0}/comparison.md\n", settings.folder));
  return InterruptScope::exitCode();
}

Command addCompareCommand(CLI::App& parent, const std::string& commandLine) {
  CLI::App* app = parent.add_subcommand("compare", "Compare ways to render scenes by error, rays and time");
  app->footer(
      "Prints medians over seeds and ratios to the first method with 95 % intervals; --wide also how many\n"
      "samples the first method needs for the same error. Error: the relMSE without the worst 0.1 % of the\n"
      "pixels. Time is that of the processor: seconds of all its cores together.\n"
      "DIR/report.html shows everything with the pictures. Results are kept in DIR/results.jsonl: an\n"
      "interrupted comparison goes on where it stopped.");
  const auto a = std::make_shared<CompareArguments>();
  a->commandLine = commandLine;
  a->addTo(*app);
  return {app, [a] { return runCompare(*a); }};
}

}  // namespace odis::app
