// odis compare
#include "eval/compare.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <set>

#include "command.h"
#include "console.h"
#include "eval/comparison_table.h"
#include "eval/image_file.h"
#include "output.h"
#include "render_arguments.h"
#include "validators.h"

namespace odis::app {

namespace {

struct Arguments {
  eval::CompareSettings settings;
  std::vector<std::string> methods{"path=--integrator path", "odis=--integrator odis"};
  SceneArguments part;
  int threads = 0;
  bool quiet = false;
};

class ConsoleObserver : public eval::CompareObserver {
 public:
  explicit ConsoleObserver(bool quiet) : m_quiet(quiet), m_progress(quiet) {}
  void start(const std::string& what) override { m_progress.setTitle(what); }
  void warnings(const render::Warnings& warnings) override {
    for (const std::string& text : warnings.texts())
      if (!m_quiet) say(fmt::format("warning: {}\n", text));
  }
  render::Progress& progress() override { return m_progress; }

 private:
  bool m_quiet;
  ConsoleProgress m_progress;
};

}  // namespace

static std::vector<eval::Method> parseMethods(const std::vector<std::string>& texts, int threads) {
  std::vector<eval::Method> methods;
  std::set<std::string> names;
  for (const std::string& text : texts) {
    const size_t equals = text.find('=');
    if (equals == 0 || equals == std::string::npos)
      throw UsageError(fmt::format("--methods: found \"{}\", expected name=options", text));
    eval::Method method{text.substr(0, equals), text.substr(equals + 1), {}};
    if (method.name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.") !=
        std::string::npos)
      throw UsageError(
          fmt::format("--methods: \"{}\": a name is made of letters, digits, - _ and .", method.name));
    if (!names.insert(method.name).second)
      throw UsageError(fmt::format("--methods: two methods are named \"{}\"", method.name));
    method.options = parseMethod(method.text);
    method.options.threads = threads;
    methods.push_back(std::move(method));
  }
  return methods;
}

static int run(Arguments& a) {
  eval::CompareSettings& settings = a.settings;
  settings.methods = parseMethods(a.methods, a.threads);
  settings.load = a.part.loadOptions();
  if (settings.pixels > 0 && (settings.load.resolution || settings.load.crop))
    throw UsageError("--pixels sets the size: it can't go with --resolution or --crop");
  if (!settings.reference.empty() && settings.scenes.size() > 1)
    throw UsageError("--reference is the image of one scene: it can't go with several");
  std::set<std::string> names;
  for (const std::string& scene : settings.scenes)
    if (!names.insert(eval::sceneName(scene)).second)
      throw UsageError(fmt::format("{}: two scenes are named \"{}\"", scene, eval::sceneName(scene)));
  if (!settings.reference.empty()) eval::readColor(settings.reference);  // before time is spent
  std::error_code failed;
  std::filesystem::create_directories(settings.folder, failed);
  if (failed) throw WriteError(fmt::format("{}: {}", settings.folder, failed.message()));

  const InterruptScope interruptible;
  ConsoleObserver observer(a.quiet);
  const std::vector<eval::Measurement> measurements = eval::compare(settings, observer);
  const std::vector<eval::ComparisonRow> rows = eval::summarize(measurements);
  const std::string table = eval::markdownTable(rows);
  writeText(settings.folder + "/comparison.md", table);
  writeText(settings.folder + "/comparison.json", eval::jsonText(rows, measurements));
  fmt::print("{}", table);
  return InterruptScope::exitCode();
}

Command addCompareCommand(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("compare", "Compare ways to render scenes by error, rays and time");
  app->footer(
      "Prints the median over seeds of the relMSE without the worst 0.1 % of the pixels, and ratios to the "
      "first\n"
      "method. Results are kept in DIR/results.jsonl: an interrupted comparison goes on where it stopped.");
  const auto a = std::make_shared<Arguments>();
  eval::CompareSettings& settings = a->settings;
  app->add_option("SCENE", settings.scenes, "Mitsuba 3 scene files")->required();
  app->add_option("--methods", a->methods, "name=options of `odis render`, with commas between methods")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->capture_default_str();
  const CLI::Range positive(1, 1 << 24);
  app->add_option("--spp", settings.spp, "Samples per pixel of each method")
      ->check(positive)
      ->capture_default_str();
  app->add_option("--seeds", settings.seeds, "How often each method renders")
      ->check(positive)
      ->capture_default_str();
  app->add_option("--reference-spp", settings.referenceSpp, "Samples per pixel of references; they are kept")
      ->check(positive)
      ->capture_default_str();
  app->add_option("--reference", settings.reference, "EXR file to use as the reference");
  app->add_option("--pixels", settings.pixels, "Make the images about so many pixels large")->check(positive);
  app->add_option("--max-depth", settings.maxDepth, "In place of the scenes'")
      ->check(CLI::Range(-1, 1 << 20));
  app->add_option("--rr-depth", settings.rrDepth, "In place of the scenes'")->check(CLI::Range(1, 1 << 20));
  app->add_option("-o,--output", settings.folder, "Folder for results, references and images")->required();
  app->add_flag("--images", settings.images,
                "Write seed 0 as EXR and PNG, and a PNG of all methods side by side");
  app->add_option("--exposure", settings.exposure, "Of the PNGs, in stops")
      ->check(stops())
      ->capture_default_str();
  app->add_flag("--fresh", settings.fresh, "Forget earlier results; references are kept");
  app->add_option("--threads", a->threads, "0: one a core")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  app->add_flag("-q,--quiet", a->quiet, "Print the table only");
  a->part.addTo(*app);
  return {app, [a] { return run(*a); }};
}

}  // namespace odis::app
