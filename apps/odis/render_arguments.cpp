#include "render_arguments.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <limits>
#include <sstream>

#include "command.h"
#include "render/image/limits.h"
#include "suggest.h"
#include "validators.h"

namespace odis::app {

using namespace render;

void MethodArguments::addTo(CLI::App& app) {
  const std::string group = "Method";
  app.add_option("--integrator", integrator,
                 "path: plain path tracing; odis: guided by a pilot; others: docs/rivals.md")
      ->check(CLI::IsMember({"path", "odis", "ppg", "openpgl", "restir"}))
      ->capture_default_str()
      ->group(group);
  app.add_option("--samples", samples,
                 "How samples are spread: as many for every pixel, or more where the first ones differ more, "
                 "for about as many rays; auto: adaptive for odis, even for others")
      ->check(CLI::IsMember({"auto", "even", "adaptive"}))
      ->capture_default_str()
      ->group(group);
  app.add_option("--guide", guide,
                 "How the pilot is turned into maps: by the network, by the histogram formula, or by the "
                 "formula from "
                 "the many more samples of an oracle")
      ->check(CLI::IsMember({"network", "histogram", "oracle"}))
      ->capture_default_str()
      ->group(group);
  app.add_option("--weights", weights, "File of weights for the networks, in place of those built in")
      ->check(CLI::ExistingFile)
      ->group(group);
  app.add_option("--guide-bounces", guideBounces, "How many vertices of a path are guided; -1: all")
      ->check(CLI::Range(-1, 1 << 20))
      ->capture_default_str()
      ->group(group);
  app.add_option(
         "--roulette", roulette,
         "Whether guided paths go on: by their throughput, or by what the pilot saw come back, weighed by "
         "formula or by the network")
      ->check(CLI::IsMember({"throughput", "formula", "network"}))
      ->capture_default_str()
      ->group(group);
  app.add_option("--ended-paths", endedPaths,
                 "What paths add that learned roulette ends: nothing, or the mean of their cell")
      ->check(CLI::IsMember({"nothing", "mean"}))
      ->capture_default_str()
      ->group(group);
  app.add_option("--shadow-rays", shadowRays,
                 "Of guided paths: all, or by roulette where the light would add little to the pixel")
      ->check(CLI::IsMember({"all", "roulette"}))
      ->capture_default_str()
      ->group(group);
  app.add_option("--pilot-spp", pilotSpp,
                 "Samples per pixel of the pilot; 0.25: one in 2x2 pixels; 0: that in large images of less "
                 "than 8 samples, else 1")
      ->check(numberBetween(0, 1e6))
      ->capture_default_str()
      ->group(group);
  app.add_option("--refine", refineSpp,
                 "Guided samples per pixel that the guide learns from as well: it is rebuilt after 1, 3, 7, "
                 "... if as many are left")
      ->check(CLI::Range(0, 1 << 20))
      ->capture_default_str()
      ->group(group);
  app.add_option("--lights", lights,
                 "How guided vertices choose a light: by the hierarchy of lights, or from what the pilot "
                 "saw, by formula "
                 "or by the network")
      ->check(CLI::IsMember({"hierarchy", "formula", "network"}))
      ->capture_default_str()
      ->group(group);
  app.add_option("--oracle-spp", oracleSpp, "Samples per pixel that the oracle is made from")
      ->check(CLI::Range(1, 1 << 20))
      ->capture_default_str()
      ->group(group);
  app.add_option("--sampler", sampler, "Where random numbers come from")
      ->check(CLI::IsMember({"sobol", "independent"}))
      ->capture_default_str()
      ->group(group);
  addCellsTo(app);
  ppg.addTo(app);
  restir.addTo(app);
}

void MethodArguments::addCellsTo(CLI::App& app) {
  const std::string group = "Cells";
  app.add_option("--cells", cells.cellsPerDiagonal, "Finest cells along the diagonal of what the pilot saw")
      ->check(CLI::Range(1, 1 << 16))
      ->capture_default_str()
      ->group(group);
  app.add_option("--trust", trust, "Samples' worth of the coarser level in each finer one, finest first")
      ->expected(kCellLevels)
      ->check(numberBetween(0, 1e9))
      ->capture_default_str()
      ->group(group);
  app.add_option("--map-floor", cells.floor, "Share of the uniform distribution in every map")
      ->check(numberBetween(0, 1))
      ->capture_default_str()
      ->group(group);
  app.add_option(
         "--alpha", cells.fixedAlpha,
         "Share of the samples that stays with the BSDF, everywhere; 0: by predicted variance and cost")
      ->check(numberBetween(0, 1))
      ->capture_default_str()
      ->group(group);
  app.add_option("--pilot-weight", pilotWeight,
                 "Of a pilot sample relative to a guided one; -1: by predicted variance")
      ->check(numberBetween(-1, 1e6))
      ->capture_default_str()
      ->group(group);
}

void MethodArguments::apply(RenderOptions& options) const {
  options.integrator = integrator == "path"      ? IntegratorKind::path
                       : integrator == "ppg"     ? IntegratorKind::ppg
                       : integrator == "openpgl" ? IntegratorKind::openpgl
                       : integrator == "restir"  ? IntegratorKind::restir
                                                 : IntegratorKind::odis;
  options.samples = samples == "even"       ? SampleSpread::even
                    : samples == "adaptive" ? SampleSpread::adaptive
                                            : SampleSpread::automatic;
  options.sampler = sampler == "sobol" ? SamplerKind::sobol : SamplerKind::independent;
  options.guide = guide == "oracle"      ? GuideKind::oracle
                  : guide == "histogram" ? GuideKind::histogram
                                         : GuideKind::network;
  if (!weights.empty()) options.networks = std::make_shared<Networks>(loadNetworks(weights));
  options.roulette = roulette == "throughput" ? RouletteKind::throughput
                     : roulette == "formula"  ? RouletteKind::formula
                                              : RouletteKind::network;
  options.guideBounces = guideBounces;
  options.pilotSpp = pilotSpp;
  options.lights = lights == "hierarchy" ? LightChoiceKind::hierarchy
                   : lights == "formula" ? LightChoiceKind::formula
                                         : LightChoiceKind::network;
  options.shadowRays = shadowRays == "all" ? ShadowRayKind::all : ShadowRayKind::roulette;
  options.refineSpp = refineSpp;
  options.oracleSpp = oracleSpp;
  options.pilotWeight = pilotWeight;
  options.guideOptions = cells;
  options.guideOptions.controlVariate = endedPaths == "mean";
  options.ppg = ppg.options();
  options.restir = restir.options;
  std::copy(trust.begin(), trust.end(), options.guideOptions.trust);
}

void SceneArguments::addTo(CLI::App& app) {
  const std::string group = "Scene";
  app.add_option("-D,--define", defines, "Replaces a <default> of the scene file: -D key=value")
      ->allow_extra_args(false)
      ->group(group);
  app.add_option("--resolution", resolution, "Size of the full image, in place of the scene's: 640x360")
      ->group(group);
  app.add_option("--crop", crop, "Part of the image to render: x,y,width,height")->group(group);
}

LoadOptions SceneArguments::loadOptions() const {
  LoadOptions options;
  for (const std::string& define : defines) options.defines.insert(parseDefine(define));
  if (!resolution.empty()) options.resolution = parseResolution(resolution);
  if (!crop.empty()) options.crop = parseCrop(crop);
  return options;
}

void RenderArguments::addTo(CLI::App& app) {
  app.add_option("SCENE", scene, "Mitsuba 3 scene file")->required();
  app.add_option("-o,--output", output,
                 "Image to write, .exr or .png; default: the scene's name, in this folder");
  app.add_option("--png", png, "Write a PNG for a look as well");
  app.add_option("--exposure", exposure, "Of the PNG, in stops")->check(stops())->capture_default_str();
  app.add_option("--spp", spp, "Samples per pixel, pilot included; default: what the scene asks for, else 4")
      ->check(CLI::Range(1, 1 << 24));
  app.add_option("--seed", seed, "Another seed, another noise")
      ->check(numberBetween(0, double(std::numeric_limits<uint64_t>::max())))
      ->capture_default_str();
  app.add_option("--threads", threads, "0: one a core")->check(CLI::Range(0, 4096))->capture_default_str();
  app.add_option("--max-depth", maxDepth,
                 "Bounces; -1: no limit, 1: lights only, 2: direct light; default: scene's")
      ->check(CLI::Range(-1, 1 << 20));
  app.add_option("--rr-depth", rrDepth, "Russian roulette starts here; default: scene's")
      ->check(CLI::Range(1, 1 << 20));
  app.add_option("--time-limit", timeLimit, "Stop after so many seconds; 0: no limit")
      ->check(numberBetween(0, 1e9))
      ->capture_default_str();
  app.add_option("--aov", aov, "Further layers: albedo,normal,position,depth,roughness,guide or all");
  app.add_flag("--variance", variance, "Write each pixel's estimated variance as a layer");
  app.add_flag("--stats", stats, "Print what it cost");
  app.add_option("--stats-json", statsFile, "Write what it cost");
  app.add_option("--records", recordsFile, "Write the pilot's vertices as a NumPy array, .npy");
  app.add_option("--tev", tev, "Show the image in tev, at host:port");
  app.add_option("--replay", replay, "x,y,sample: print that one path instead of rendering");
  app.add_flag("-q,--quiet", quiet, "Print errors only");
  app.add_flag("-v,--verbose", verbose, "Say what is done");
  method.addTo(app);
  part.addTo(app);
}

Vec2i parseResolution(const std::string& text) {
  std::istringstream stream(text);
  Vec2i size(0, 0);
  char times = 0;
  stream >> size.x >> times >> size.y;
  if (!stream || !stream.eof() || times != 'x' || size.x < 1 || size.y < 1)
    throw UsageError(fmt::format("--resolution: found \"{}\", expected WIDTHxHEIGHT, as in 640x360", text));
  if (size.x > kMaxImageSide || size.y > kMaxImageSide)
    throw UsageError(
        fmt::format("--resolution: found {}, expected at most {} pixels a side", text, kMaxImageSide));
  return size;
}

Crop parseCrop(const std::string& text) {
  std::istringstream stream(text);
  Crop crop;
  char commas[3] = {};
  stream >> crop.x >> commas[0] >> crop.y >> commas[1] >> crop.width >> commas[2] >> crop.height;
  const bool separated = commas[0] == ',' && commas[1] == ',' && commas[2] == ',';
  if (!stream || !stream.eof() || !separated || crop.x < 0 || crop.y < 0 || crop.width < 1 || crop.height < 1)
    throw UsageError(
        fmt::format("--crop: found \"{}\", expected x,y,width,height in pixels, as in 0,0,64,64", text));
  return crop;
}

std::pair<std::string, std::string> parseDefine(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos)
    throw UsageError(fmt::format("-D: found \"{}\", expected key=value", text));
  return {text.substr(0, equals), text.substr(equals + 1)};
}

RenderOptions parseMethod(const std::string& text) {
  CLI::App app("method");
  MethodArguments arguments;
  arguments.addTo(app);
  try {
    app.parse(text);
  } catch (const CLI::ParseError& error) {
    const std::string hint = suggestFor(app, app);
    throw UsageError(
        fmt::format("--methods: \"{}\": {}{}", text, error.what(), hint.empty() ? "" : "\n" + hint));
  }
  RenderOptions options;
  arguments.apply(options);
  return options;
}

}  // namespace odis::app
