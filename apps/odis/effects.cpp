#include "effects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "command.h"
#include "console.h"

namespace odis::app {

using namespace render;

namespace {

using Holds = bool (*)(const RenderOptions&);

// A condition that some keys need, in words that follow "has no effect".
struct Need {
  std::vector<std::string> keys;
  Holds holds;
  const char* otherwise;
};

bool hasOracle(const RenderOptions& o) {
  return o.setting("guide") == "oracle" || o.setting("pixel-maps") == "oracle";
}
bool hasPixelMaps(const RenderOptions& o) {
  return o.setting("pixel-maps") != "none";
}
bool hasCells(const RenderOptions& o) {
  return o.settingNumber("cells") > 0;
}
bool refines(const RenderOptions& o) {
  return o.settingNumber("refine") > 0 && o.settingNumber("guided-cost") > 0 &&
         o.settingNumber("bsdf-fraction") == 0 && !hasOracle(o);
}

const std::vector<Need>& needs() {
  static const std::vector<Need> all = {
      {{"oracle-spp"}, hasOracle, "without guide=oracle or pixel-maps=oracle"},
      {{"refine"}, [](const RenderOptions& o) { return !hasOracle(o); }, "with an oracle"},
      {{"built-cell-cost", "recorded-ray-cost"},
       refines,
       "with refine=0, guided-cost=0, a bsdf-fraction or an oracle"},
      {{"ended-paths"},
       [](const RenderOptions& o) { return o.setting("roulette") == "formula"; },
       "without roulette=formula"},
      {{"cached-error"},
       [](const RenderOptions& o) { return o.setting("cached") == "on"; },
       "without --cached"},
      {{"prior-samples"},
       [](const RenderOptions& o) { return o.setting("guide") != "network"; },
       "without guide=histogram or guide=oracle"},
      {{"guide", "prior-samples", "pixel-share"}, hasCells, "without cells"},
      {{"guide-bounces", "roulette", "ended-paths", "shadow-rays", "refine", "guided-cost", "bsdf-fraction",
        "map-floor", "map-cosine", "lights"},
       isGuiding,
       "with cells=0 and without maps at pixels: nothing is guided"},
      {{"pixel-tile", "pixel-share"}, hasPixelMaps, "without maps at pixels (pixel-maps)"},
      {{"pixel-network"},
       [](const RenderOptions& o) { return o.setting("pixel-maps") == "network"; },
       "without pixel-maps=network"},
      {{"pixel-light"},
       [](const RenderOptions& o) {
         return o.setting("pixel-maps") == "histogram" || o.setting("pixel-maps") == "oracle";
       },
       "without pixel-maps=histogram or pixel-maps=oracle"}};
  return all;
}

// The integrators that have a setting, also as the beginning of a sentence.
struct SettingOwners {
  std::vector<IntegratorKind> integrators;
  const char* text;
};
SettingOwners ownersOf(const std::string& key) {
  using Kind = IntegratorKind;
  if (key.starts_with("ppg")) return {{Kind::ppg}, "ppg has"};
  if (key.starts_with("restir")) return {{Kind::restir}, "restir has"};
  if (key == "samples") return {{Kind::odis, Kind::path}, "odis and path have"};
  if (key == "guide-bounces") return {{Kind::odis, Kind::ppg, Kind::openpgl}, "odis, ppg and openpgl have"};
  return {{Kind::odis}, "odis has"};
}

bool contains(const auto& values, const auto& value) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

// The least number of samples per pixel that can be spread over the pixels unevenly.
int leastToSpread(const RenderOptions& o) {
  const double pilot = o.integrator == IntegratorKind::odis ? o.settingNumber("pilot-spp") : 0;
  return std::max(4, int(std::floor(pilot)) + 3);
}

}  // namespace

void requireEffects(const RenderOptions& options, const std::vector<std::string>& settings) {
  for (const std::string& setting : settings) {
    const std::string key = setting.substr(0, setting.find('='));
    const SettingOwners owners = ownersOf(key);
    if (!contains(owners.integrators, options.integrator))
      throw UsageError(fmt::format("--set {}: only --integrator {} this setting", key, owners.text));
    if (options.integrator != IntegratorKind::odis) continue;
    for (const Need& need : needs())
      if (contains(need.keys, key) && !need.holds(options))
        throw UsageError(fmt::format("--set {}: has no effect {}", key, need.otherwise));
  }
}

void requireEffects(const RenderArguments& a, Layers& layers) {
  if (layers.guide && a.method.integrator != "odis") {
    if (("," + a.aov + ",").find(",guide,") != std::string::npos)
      throw UsageError("--aov guide: only --integrator odis has a guide, found " + a.method.integrator);
    layers.guide = false;
  }
  if (endsWith(a.output, ".png"))
    for (const auto& [option, isGiven] : {std::pair("--aov", layers.any()), {"--variance", a.variance}})
      if (isGiven)
        throw UsageError(
            fmt::format("{}: {} has no layers, expected an output that ends in .exr", option, a.output));
  requirePngToExpose(a.exposure, a.png, a.output);
}

void requirePngToExpose(float exposure, const std::string& png, const std::string& output) {
  if (exposure != 0 && png.empty() && !endsWith(output, ".png"))
    throw UsageError("--exposure: is of PNGs, expected --png or an output that ends in .png");
}

void tellWithoutEffect(const RenderArguments& a, const RenderOptions& options, const FilmSettings& film) {
  if (options.variance && options.spp < 2)
    throw UsageError("--variance: one sample per pixel has none, expected --spp 2 or more");
  std::string notes;
  if (options.setting("cached") == "on" && !isCaching(options))
    notes += fmt::format("note: --cached: has no effect with a max_depth below {}, found {}: not biased\n",
                         ODIS_LEAST_CACHED_MAX_DEPTH, options.maxDepth);
  if (options.setting("samples") == "adaptive" && options.spp < leastToSpread(options))
    notes += fmt::format("note: --set samples=adaptive: needs {} samples per pixel, found {}\n",
                         leastToSpread(options), options.spp);
  if (options.integrator == IntegratorKind::odis && !isGuiding(options))
    notes += "note: --set cells=0: nothing is guided without cells and maps at pixels\n";
  if (options.film == FilmKind::splat && film.filter->reach() > kMostSplatReach)
    notes +=
        fmt::format("note: --film splat: the filter reaches over {} pixels, more than {}: --film pixels\n",
                    film.filter->reach(), kMostSplatReach);
  if (!a.quiet) say(notes);
  if (a.denoise && filmKindFor(*film.filter, options.film) == FilmKind::splat && !a.quiet)
    sayWarning(
        "--film splat: neighbouring pixels share their noise, which the denoiser takes for detail; "
        "--film pixels denoises better");
}

}  // namespace odis::app
