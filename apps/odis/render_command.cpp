// odis render
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <chrono>
#include <ctime>
#include <filesystem>
#include <limits>
#include <memory>
#include <new>

#include "command.h"
#include "console.h"
#include "denoising.h"
#include "effects.h"
#include "numbers.h"
#include "output.h"
#include "records.h"
#include "render/integrators/auxiliary_images.h"
#include "render_arguments.h"
#include "render_outcome.h"
#include "saved_rendering.h"
#include "scene_warnings.h"
#include "stats.h"
#include "viewer.h"

namespace odis::app {

using namespace render;

static RenderOptions renderOptions(const RenderArguments& a, const Scene& scene, const Layers& layers) {
  const IntegratorSettings& settings = scene.integrator();
  RenderOptions options;
  options.film = a.denoise ? FilmKind::pixels : FilmKind::splat;
  a.method.apply(options);
  options.spp = a.spp.value_or(settings.samplesPerPixel > 0 ? settings.samplesPerPixel : options.spp);
  options.maxDepth = a.maxDepth.value_or(settings.maxDepth);
  options.rrDepth = a.rrDepth.value_or(settings.rrDepth);
  options.seed = a.seed;
  options.threads = a.threads;
  options.timeLimit = a.timeLimit;
  options.variance = a.variance;
  options.features = layers.any();
  options.guideFeatures = layers.guide;
  options.records = !a.recordsFile.empty();
  options.saving = savingOf(a, options, scene);
  return options;
}

static int printReplay(const RenderArguments& a, const Scene& scene, const RenderOptions& options) {
  const auto place = parseNumbers<int>(a.replay, ',', 3, {0, std::numeric_limits<int>::max()});
  if (!place)
    throw UsageError(
        fmt::format("--replay: found \"{}\", expected x,y,sample, whole numbers from 0", a.replay));
  const int x = place->at(0), y = place->at(1), sample = place->at(2);
  const FilmSettings& film = scene.film();
  if (x >= film.width || y >= film.height || sample >= options.spp)
    throw UsageError(fmt::format("--replay: {} is outside of the image of {} x {} pixels of {} samples",
                                 a.replay, film.width, film.height, options.spp));
  fmt::print("{}\n", render::replay(scene, options, Vec2i(x, y), sample));
  return kOk;
}

static double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

static Outputs outputsOf(const RenderArguments& a) {
  try {
    if (!a.tev.empty()) TevAddress{a.tev};
  } catch (const std::runtime_error& error) {
    throw UsageError(fmt::format("--tev: {}", error.what()));
  }
  Outputs outputs;
  outputs.add(a.output, {".exr", ".png"});
  if (!a.png.empty()) outputs.add(a.png, {".png"});
  if (!a.statsFile.empty()) outputs.add(a.statsFile, {});
  if (!a.recordsFile.empty()) outputs.add(a.recordsFile, {".npy"});
  outputs.rejectInputs({a.resume});
  // A rendering may go on with the file that it is saved to.
  if (a.saveMinutes > 0) outputs.add(savedFile(a), {});
  outputs.rejectInputs({a.scene, a.method.weights});
  return outputs;
}

// Renders what the denoiser is told beside colours. Returns false, and says so, if the user interrupted it or
// what came before.
static bool addAuxiliaries(const RenderArguments& a, const Scene& scene, RenderedImage& image,
                           Progress& progress, Denoising& denoising) {
  const auto start = std::chrono::steady_clock::now();
  AuxiliaryImages auxiliaries;
  if (!InterruptScope::interrupted()) auxiliaries = renderAuxiliaries(scene, a.seed, a.threads, progress);
  if (auxiliaries.albedo.empty()) {
    say("interrupted: the image is not denoised\n");
    return false;
  }
  image.albedo = std::move(auxiliaries.albedo);
  image.normal = std::move(auxiliaries.normal);
  denoising.secondsAuxiliaries = secondsSince(start);
  return true;
}

// Denoises the image, which stays as it is where that is interrupted or fails. Returns the failure: the image
// is to be written first.
static std::optional<DenoiserError> denoiseImage(const RenderArguments& a, const Scene& scene,
                                                 const Denoiser& denoiser, RenderedImage& image,
                                                 Progress& progress, Denoising& denoising) {
  try {
    if (!addAuxiliaries(a, scene, image, progress, denoising)) return {};
    const DenoiserInput input{image.width, image.height, image.color, image.albedo, image.normal};
    if (auto colors = denoiseColors(denoiser, input, Auxiliaries::clean, progress, denoising))
      image.noisy = std::exchange(image.color, std::move(*colors));
  } catch (const DenoiserError& error) {
    return error;
  } catch (const std::bad_alloc&) {
    return DenoiserError("albedo and normals for the denoiser: not enough memory");
  }
  return {};
}

// Writes all that was asked for. Returns which files, the image first.
static WrittenFiles writeOutputs(const RenderArguments& a, const RenderResult& result,
                                 const FilmSettings& film, const Layers& layers, RunStats& stats) {
  const auto start = std::chrono::steady_clock::now();
  const WrittenFiles files({a.output, a.png, a.recordsFile, a.statsFile});
  if (endsWith(a.output, ".png"))
    writePreview(a.output, result.image, a.exposure);
  else
    writeLayers(a.output, result.image, film, layers, statsMetadata(stats));
  if (!a.png.empty()) writePreview(a.png, result.image, a.exposure);
  if (!a.recordsFile.empty()) writeRecords(a.recordsFile, result.records);
  stats.secondsWrite = secondsSince(start);
  if (!a.statsFile.empty()) writeText(a.statsFile, statsJson(stats));
  if (a.stats) fmt::print("{}", statsTable(stats));
  return files;
}

// Layers of zeros would pass for measurements.
static void leaveOutUnknown(const RenderArguments& a, const RenderOptions& options, RenderResult& result,
                            Layers& layers) {
  if (!result.image.variance.empty() && result.stats.fewestSamples < 2) {
    if (!a.quiet) sayWarning("--variance: a pixel has fewer than 2 samples: no variance is written");
    result.image.variance.clear();
  }
  if (layers.guide && !isGuiding(options, result.stats)) {
    if (!a.quiet) sayWarning("--aov guide: nothing was guided: no layer of the guide is written");
    layers.guide = false;
  }
}

static void describeRun(const RenderArguments& a, const Scene& scene, const RenderOptions& options,
                        const RenderStats& rendered, RunStats& stats) {
  stats.render = rendered;
  stats.bytesScene = scene.bytes();
  stats.bytesPeak = peakMemory();
  stats.seed = a.seed;
  stats.cached = isCaching(options) && isGuiding(options, rendered);
  if (options.integrator == IntegratorKind::odis)
    stats.costs = {{float(options.settingNumber("guided-cost")),
                    float(options.settingNumber("built-cell-cost")),
                    float(options.settingNumber("recorded-ray-cost"))}};
  stats.scene = a.scene;
  stats.integrator = a.method.integrator;
  stats.film = filmName(filmKindFor(*scene.film().filter, options.film));
  stats.commandLine = a.commandLine;
}

static int runRender(RenderArguments& a) {
  // Find out what is wrong with the command line before time is spent.
  if (a.output.empty()) a.output = std::filesystem::path(a.scene).stem().string() + ".exr";
  Layers layers = parseLayers(a.aov);
  const LoadOptions load = a.part.loadOptions();
  if (!a.recordsFile.empty() && a.method.integrator != "odis")
    throw UsageError("--records: only --integrator odis has a pilot to record");
  checkSaving(a);
  if (a.replay.empty()) requireEffects(a, layers);
  const Outputs outputs = a.replay.empty() ? outputsOf(a) : Outputs();
  std::optional<Denoiser> denoiser;
  if (a.denoise && a.replay.empty()) denoiser.emplace(a.threads);

  const render::ThreadLimit threads(a.threads);
  const auto start = std::chrono::steady_clock::now();
  Warnings warnings;
  const std::unique_ptr<Scene> scene = Scene::load(a.scene, load, warnings);
  outputs.rejectInputs(scene->files());
  RunStats stats;
  stats.secondsLoad = secondsSince(start);
  tellWarnings(a.scene, warnings, {a.quiet, a.verbose, a.part.strict});
  const RenderOptions options = renderOptions(a, *scene, layers);
  if (!a.replay.empty()) return printReplay(a, *scene, options);
  tellWithoutEffect(a, options, scene->film());
  if (a.verbose)
    say(fmt::format("{}: {} shapes, {} lights, {}; loaded in {}\n", a.scene, scene->shapes().size(),
                    scene->emitters().size(), bytesText(double(scene->bytes())),
                    durationText(stats.secondsLoad)));

  const InterruptScope interruptible;
  std::optional<Viewer> viewer;
  ConsoleProgress progress(a.quiet);
  if (!a.tev.empty()) progress.setViewer(viewer.emplace(TevAddress(a.tev), a.output));
  const std::clock_t processorStart = std::clock();
  RenderResult result = render::render(*scene, options, progress);
  stats.processorSeconds = double(std::clock() - processorStart) / CLOCKS_PER_SEC;
  if (result.stats.interrupted) tellOfSaved(a);
  if (!isWorthWriting(a, result.stats)) return renderExitCode(a, result.stats);
  std::optional<DenoiserError> failure;
  if (denoiser) failure = denoiseImage(a, *scene, *denoiser, result.image, progress, stats.denoising);
  leaveOutUnknown(a, options, result, layers);
  if (stats.denoising.secondsAuxiliaries > 0)
    layers.albedo = layers.normal = true;  // as the denoiser had them

  describeRun(a, *scene, options, result.stats, stats);
  const WrittenFiles files = writeOutputs(a, result, scene->film(), layers, stats);
  if (!a.quiet)
    say(files.text(fmt::format("after {}, {}", durationText(secondsSince(start)),
                               samplesText(result.stats, options.spp))));
  if (viewer) viewer->show(result.image.width, result.image.height, std::move(result.image.color));
  if (!result.stats.interrupted) removeSaved(a);
  if (failure) throw *failure;
  return renderExitCode(a, result.stats);
}

Command addRenderCommand(CLI::App& parent, const std::string& commandLine) {
  CLI::App* app = parent.add_subcommand("render", "Render a scene");
  const auto arguments = std::make_shared<RenderArguments>();
  arguments->addTo(*app);
  arguments->commandLine = commandLine;
  return {app, [arguments] { return runRender(*arguments); }};
}

}  // namespace odis::app
