// odis inspect
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "command.h"
#include "console.h"
#include "inspect_saved.h"
#include "learn/inspect/picture.h"
#include "learn/inspect/saved.h"
#include "output.h"
#include "render/image/limits.h"
#include "render_arguments.h"
#include "scene_warnings.h"
#include "validators.h"

namespace odis::app {

using namespace render;

namespace {

struct InspectArguments {
  std::string file, output, json, pixel, point, normal;
  std::optional<int> spp, maxDepth, rrDepth;
  uint64_t seed = 0;
  int threads = 0;
  bool quiet = false;
  learn::InspectSettings settings;
  MethodArguments method;
  SceneArguments part;
};

// Squares of coordinates stay within single precision.
constexpr Interval<float> kCoordinates{-1e15f, 1e15f};

Float3 vector(const std::string& option, const std::string& text) {
  const auto v = parseNumbers<float>(text, ',', 3, kCoordinates);
  if (!v)
    throw UsageError(
        fmt::format("{}: found \"{}\", expected x,y,z, each {}", option, text, expectedNumber(kCoordinates)));
  return {v->at(0), v->at(1), v->at(2)};
}

void readPoint(InspectArguments& a) {
  if (!a.point.empty()) a.settings.point = vector("--point", a.point);
  if (a.normal.empty()) return;
  if (a.point.empty()) throw UsageError("--normal: goes with --point");
  a.settings.normal = vector("--normal", a.normal);
  if (dot(*a.settings.normal, *a.settings.normal) == 0) throw UsageError("--normal: expected a direction");
}

void readPlace(InspectArguments& a) {
  if (a.pixel.empty() == a.point.empty()) throw UsageError("expected --pixel x,y or --point x,y,z");
  readPoint(a);
  if (a.pixel.empty()) return;
  constexpr Interval<int> pixels{0, kMaxImageSide - 1};
  const auto at = parseNumbers<int>(a.pixel, ',', 2, pixels);
  if (!at)
    throw UsageError(
        fmt::format("--pixel: found \"{}\", expected x,y, each {}", a.pixel, expectedNumber(pixels)));
  a.settings.pixel = Vec2i(at->at(0), at->at(1));
}

// What says something about a rendering is none of a file's that a host saved.
void rejectOptionsOfScenes(const CLI::App& app, const std::string& file) {
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_name();
    const auto goes = {"FILE", "--point", "--normal", "--output", "--json", "--quiet"};
    if (option->count() > 0 && std::find(goes.begin(), goes.end(), name) == goes.end())
      throw UsageError(fmt::format("{}: goes with a scene, \"{}\" is what a host saved", name, file));
  }
}

int runInspectSaved(const CLI::App& app, InspectArguments& a) {
  rejectOptionsOfScenes(app, a.file);
  readPoint(a);
  showSaved({a.file, a.output, a.json, a.settings.point, a.settings.normal});
  return kOk;
}

int runInspect(InspectArguments& a) {
  readPlace(a);
  RenderOptions options;
  if (!a.method.film.empty()) throw UsageError("--film: has no effect, no image is made of samples");
  a.method.apply(options);
  if (options.integrator != IntegratorKind::odis || options.setting("guide") == "oracle")
    throw UsageError("odis inspect: looks into --integrator odis with the pilot's guide, expected no other");
  Outputs outputs;
  if (!a.output.empty()) outputs.add(a.output, {".png", ".exr"});
  if (!a.json.empty()) outputs.add(a.json, {".json"});
  outputs.rejectInputs({a.file, a.method.weights});
  Warnings warnings;
  const std::unique_ptr<Scene> scene = Scene::load(a.file, a.part.loadOptions(), warnings);
  outputs.rejectInputs(scene->files());
  tellWarnings(a.file, warnings, {.quiet = a.quiet, .strict = a.part.strict});
  const IntegratorSettings& asked = scene->integrator();
  options.spp = a.spp.value_or(asked.samplesPerPixel > 0 ? asked.samplesPerPixel : options.spp);
  options.maxDepth = a.maxDepth.value_or(asked.maxDepth);
  options.rrDepth = a.rrDepth.value_or(asked.rrDepth);
  options.seed = a.seed;
  options.threads = a.threads;
  const InterruptScope interruptible;
  ConsoleProgress progress(a.quiet);
  const auto inspection = learn::inspect(*scene, options, a.settings, progress);
  if (!inspection) return InterruptScope::exitCode();
  const std::string title = std::filesystem::path(a.file).filename().string();
  if (!a.output.empty())
    writeCanvas(a.output, learn::drawInspection(*inspection, title, mapColorsOf(a.output)));
  if (!a.json.empty()) writeText(a.json, learn::toJson(*inspection).dump(1) + "\n");
  fmt::print("{}", learn::inspectionText(*inspection, title));
  return kOk;
}

}  // namespace

Command addInspectCommand(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("inspect", "Look into the guide at one place");
  app->footer(
      "Traces the pilot as `odis render` does, and shows what the first vertex of a pixel that may be "
      "guided, or\n"
      "the cell at a point, is told: the pilot's samples, histograms of the cell and of those around it, "
      "maps, and\n"
      "what really arrives there.\n"
      "Of a file that a host saved (odisSaveGuide, odisSaveVertices, odisSaveFrame) it shows what is in it, "
      "and with\n"
      "--point one cell of its guide; --normal, -o, --json and -q go with it, too. See docs/inspect.md.");
  const auto a = std::make_shared<InspectArguments>();
  app->add_option("FILE", a->file, "Mitsuba 3 scene file; or a guide, vertices or a frame that a host saved")
      ->required();
  app->add_option("--pixel", a->pixel, "x,y in the full image, from the upper left, each 0 to 65535");
  app->add_option("--point", a->point, "x,y,z in the world, on a surface");
  app->add_option("--normal", a->normal, "x,y,z: where the surface at the point faces; default: any");
  app->add_option("-o,--output", a->output,
                  "Picture to write: .png, or .exr with values as they are. Of a saved guide:\n"
                  "maps of 64 cells; of a frame: the image so far; with --point: the cell's map");
  app->add_option("--json", a->json, "Write all numbers and maps");
  app->add_option("--paths", a->settings.paths, "That the converged map is made of, about")
      ->check(within(1, 1 << 30))
      ->capture_default_str();
  app->add_option("--spp", a->spp, "Of the image whose pilot it is; default: what the scene asks for, else 4")
      ->check(within(kSamplesPerPixel));
  app->add_option("--max-depth", a->maxDepth, "In place of the scene's")->check(within(kMaxDepth));
  app->add_option("--rr-depth", a->rrDepth, "In place of the scene's")->check(within(kRouletteDepth));
  app->add_option("--seed", a->seed, "Another seed, another noise")
      ->check(within(kSeed))
      ->capture_default_str();
  app->add_option("--threads", a->threads, "0: one a core")
      ->check(within(kThreadCount))
      ->capture_default_str();
  app->add_flag("-q,--quiet", a->quiet, "No progress");
  a->method.addTo(*app);
  a->part.addTo(*app);
  return {app, [a, app] { return learn::isSaved(a->file) ? runInspectSaved(*app, *a) : runInspect(*a); }};
}

}  // namespace odis::app
