#include "render_arguments.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "command.h"
#include "effects.h"
#include "render/image/limits.h"
#include "settings.h"
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
  app.add_option("--sampler", sampler, "Where random numbers come from")
      ->check(CLI::IsMember({"sobol", "independent"}))
      ->capture_default_str()
      ->group(group);
  app.add_option("--film", film,
                 "splat: a sample counts in all pixels that its filter reaches; pixels: in one, as denoisers "
                 "want it; default: splat without --denoise, else pixels")
      ->check(CLI::IsMember({"splat", "pixels"}))
      ->group(group);
  app.add_option("--preset", preset,
                 "Settings to start from; paper, paper-fast: the method of Bako et al. 2019, docs/paper.md")
      ->check(CLI::IsMember({"default", "paper", "paper-fast"}))
      ->capture_default_str()
      ->group(group);
  app.add_option("--weights", weights, "File of weights for the networks, in place of those built in")
      ->group(group);
  app.add_flag(
         "--cached", cached,
         "End paths with the mean radiance of where they arrive: less noise, but biased: docs/cached.md")
      ->group(group);
  app.add_option("--set", settings,
                 "Changes a part of the method: --set key=value; --help-settings lists the keys")
      ->allow_extra_args(false)
      ->group(group);
  app.add_flag_callback(
         "--help-settings",
         [] {
           fmt::print("{}", settingsText());
           throw CLI::Success();
         },
         "List the keys of --set")
      ->group(group);
}

void MethodArguments::apply(RenderOptions& options) const {
  options.integrator = integrator == "path"      ? IntegratorKind::path
                       : integrator == "ppg"     ? IntegratorKind::ppg
                       : integrator == "openpgl" ? IntegratorKind::openpgl
                       : integrator == "restir"  ? IntegratorKind::restir
                                                 : IntegratorKind::odis;
  options.sampler = sampler == "sobol" ? SamplerKind::sobol : SamplerKind::independent;
  if (!film.empty()) options.film = film == "splat" ? FilmKind::splat : FilmKind::pixels;
  if (preset != "default" && options.integrator != IntegratorKind::odis)
    throw UsageError("--preset: expected --integrator odis, others have no presets");
  options.set("preset=" + preset);
  if (!weights.empty()) {
    options.model = Model::load(weights);
    options.set("pixel-network=model");
  }
  if (cached) options.set("cached=on");
  if (cached && options.integrator != IntegratorKind::odis)
    throw UsageError("--cached: only --integrator odis has a cache");
  applySettings(options, settings);
  requireEffects(options, settings);
  if (cached && options.settingNumber("cells") == 0)
    throw UsageError("--cached: has no effect without cells, whose radiance it is (--set cells)");
  const bool usesNetworks =
      options.setting("guide") == "network" || options.setting("lights") == "network" ||
      (options.setting("pixel-maps") == "network" && options.setting("pixel-network") == "model");
  if (!weights.empty() && !(options.integrator == IntegratorKind::odis && usesNetworks))
    throw UsageError("--weights: this method has no networks");
}

void SceneArguments::addTo(CLI::App& app) {
  const std::string group = "Scene";
  app.add_option("-D,--define", defines, "Replaces a <default> of the scene file: -D key=value")
      ->allow_extra_args(false)
      ->group(group);
  app.add_option("--resolution", resolution,
                 "Size of the full image, in place of the scene's: 640x360, each 1 to 65536")
      ->group(group);
  app.add_option("--crop", crop, "Part of the image to render: x,y,width,height, each 0 to 65536")
      ->group(group);
  app.add_flag("--strict", strict, "What would be a warning, as it changes the picture, is an error")
      ->group(group);
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
  app.add_option("--exposure", exposure, "Of the PNG, in stops")
      ->check(within(kStops))
      ->capture_default_str();
  app.add_option("--spp", spp, "Samples per pixel, pilot included; default: what the scene asks for, else 4")
      ->check(within(kSamplesPerPixel));
  app.add_option("--seed", seed, "Another seed, another noise")->check(within(kSeed))->capture_default_str();
  app.add_option("--threads", threads, "0: one a core")->check(within(kThreadCount))->capture_default_str();
  app.add_option("--max-depth", maxDepth,
                 "Bounces; -1: no limit, 1: lights only, 2: direct light; default: scene's")
      ->check(within(kMaxDepth));
  app.add_option("--rr-depth", rrDepth, "Russian roulette starts here; default: scene's")
      ->check(within(kRouletteDepth));
  app.add_option("--time-limit", timeLimit,
                 "Stop after this many seconds; the exit code is 6 if --spp was not reached; 0: no limit")
      ->check(within(0.0, 1e9))
      ->capture_default_str();
  app.add_option("--save-every", saveMinutes,
                 "Minutes between saves of the unfinished rendering to OUTPUT.odis, for --resume; 0: none")
      ->check(within(0.0, 1e6))
      ->capture_default_str();
  app.add_option("--resume", resume,
                 "Go on with a file that --save-every left; the options must be the same otherwise");
  app.add_option("--aov", aov, "Further layers: alpha,albedo,normal,position,depth,roughness,guide or all");
  app.add_flag("--denoise", denoise,
               "Denoise with Open Image Denoise; the image as rendered stays as the layer noisy");
  app.add_flag("--variance", variance, "Write each pixel's estimated variance as a layer");
  app.add_flag("--stats", stats, "Print what it cost");
  app.add_option("--stats-json", statsFile, "Write what it cost");
  app.add_option("--records", recordsFile, "Write the pilot's vertices as a NumPy array, .npy");
  app.add_option("--tev", tev, "Show the image in the viewer tev at host:port, while it is rendered");
  app.add_option("--replay", replay, "x,y,sample: print that one path instead of rendering");
  CLI::Option* silent = app.add_flag("-q,--quiet", quiet, "Print errors and what changes the picture only");
  app.add_flag("-v,--verbose", verbose, "Say what is done, and what in the scene has no effect")
      ->excludes(silent);
  method.addTo(app);
  part.addTo(app);
}

Vec2i parseResolution(const std::string& text) {
  constexpr Interval<int> sides{1, kMaxImageSide};
  const auto size = parseNumbers<int>(text, 'x', 2, sides);
  if (!size)
    throw UsageError(fmt::format(
        "--resolution: found \"{}\", expected WIDTHxHEIGHT, as in 640x360, each a whole number from {}", text,
        sides.text()));
  return {size->at(0), size->at(1)};
}

Crop parseCrop(const std::string& text) {
  constexpr Interval<int> pixels{0, kMaxImageSide};
  const auto crop = parseNumbers<int>(text, ',', 4, pixels);
  if (!crop || crop->at(2) < 1 || crop->at(3) < 1)
    throw UsageError(
        fmt::format("--crop: found \"{}\", expected x,y,width,height in pixels, as in 0,0,64,64, each a "
                    "whole number from {}",
                    text, pixels.text()));
  return {crop->at(0), crop->at(1), crop->at(2), crop->at(3)};
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
