// odis analyze
#include "eval/analyze.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>

#include "command.h"
#include "compare_arguments.h"
#include "console.h"
#include "eval/analysis_text.h"
#include "output.h"
#include "scene_warnings.h"
#include "validators.h"

namespace odis::app {

namespace {

struct AnalyzeArguments {
  std::vector<std::string> scenes, methods{"path=--integrator path", "odis=--integrator odis"};
  std::string output;
  eval::AnalyzeSettings settings;
  SceneArguments part;
  int pixels = 14400, threads = 0;
  bool json = false, quiet = false;
};

}  // namespace

static int runAnalyze(AnalyzeArguments& a) {
  eval::AnalyzeSettings& settings = a.settings;
  settings.methods = parseMethods(a.methods, a.threads);
  for (const eval::Method& method : settings.methods)
    if (method.options.film == render::FilmKind::splat)
      throw UsageError("--methods: --film splat: has no effect, single samples have no film");
  settings.load = a.part.loadOptions();
  if (!settings.load.crop) settings.load.pixels = a.pixels;
  Outputs outputs;
  if (!a.output.empty()) outputs.add(a.output, {".json"});
  outputs.rejectInputs(a.scenes);

  const InterruptScope interruptible;
  ConsoleProgress progress(a.quiet);
  std::vector<eval::SceneAnalysis> scenes;
  for (const std::string& path : a.scenes) {
    progress.setTitle(eval::sceneName(path));
    render::Warnings warnings;
    eval::SceneAnalysis scene = eval::analyzeScene(settings, path, warnings, progress);
    tellWarnings(path, warnings, {.quiet = a.quiet, .strict = a.part.strict});
    if (InterruptScope::interrupted()) break;
    if (!a.json) fmt::print("{}\n", eval::analysisTable(scene, settings.methods));
    std::fflush(stdout);
    scenes.push_back(std::move(scene));
  }
  if (!a.json && scenes.size() > 1) fmt::print("{}", eval::analysisSummary(scenes, settings.methods));
  // Method options may hold bytes that are no UTF-8.
  const std::string json = eval::analysisJson(scenes, settings)
                               .dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) +
                           "\n";
  if (a.json) fmt::print("{}", json);
  if (!a.output.empty() && !scenes.empty()) writeText(a.output, json);
  return InterruptScope::exitCode();
}

Command addAnalyzeCommand(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("analyze", "Split the variance of a sample by its causes");
  app->footer(
      "A share is what would go away if these random decisions, and nothing else, were perfect. Shares add "
      "up\n"
      "to more than 100 % where causes act together. In units of relMSE, without the worst 0.1 % of the\n"
      "pixels; after +-, standard errors. See docs/variance.md.");
  const auto a = std::make_shared<AnalyzeArguments>();
  eval::AnalyzeSettings& settings = a->settings;
  app->add_option("SCENE", a->scenes, "Mitsuba 3 scene files")->required();
  app->add_option("--methods", a->methods, "name=options of `odis render`, with commas between methods")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->capture_default_str();
  app->add_option("--spp", settings.samples, "Samples per pixel, and for each cause as many more")
      ->check(within(2, 1 << 20))
      ->capture_default_str();
  app->add_option("--image-spp", settings.imageSpp,
                  "Samples per pixel of the image whose last sample is looked at: what its guide has learned")
      ->check(within(2, 1 << 20))
      ->capture_default_str();
  app->add_option("--reference-spp", settings.referenceSpp,
                  "Samples per pixel of what variances are relative to")
      ->check(within(kSamplesPerPixel))
      ->capture_default_str();
  app->add_option("--pixels", a->pixels,
                  "Render images of about this many pixels, if --resolution and --crop say nothing")
      ->check(within(kPixelCount))
      ->capture_default_str();
  app->add_option("--max-depth", settings.maxDepth, "In place of the scenes'")->check(within(kMaxDepth));
  app->add_option("--rr-depth", settings.rrDepth, "In place of the scenes'")->check(within(kRouletteDepth));
  app->add_option("--seed", settings.seed, "Another seed, another noise")
      ->check(within(kSeed))
      ->capture_default_str();
  app->add_option("--threads", a->threads, "0: one a core")
      ->check(within(kThreadCount))
      ->capture_default_str();
  app->add_option("-o,--output", a->output, "JSON file to write as well");
  app->add_flag("--json", a->json, "Print JSON");
  app->add_flag("-q,--quiet", a->quiet, "No progress, of warnings only those of a picture that changes");
  a->part.addTo(*app);
  return {app, [a] { return runAnalyze(*a); }};
}

}  // namespace odis::app
