#include "settings.h"

#include <fmt/format.h>

#include <algorithm>

#include "command.h"
#include "numbers.h"
#include "suggest.h"

namespace odis::app {

using namespace render;

namespace {

using Set = std::function<void(RenderOptions&, const std::string&)>;

[[noreturn]] void fail(const std::string& key, const std::string& value, const std::string& expected) {
  throw UsageError(fmt::format("--set {}: found \"{}\", expected {}", key, value, expected));
}

template <class Number>
Setting number(const std::string& key, Number least, Number most, const std::string& defaultValue,
               const std::string& meaning, const std::function<void(RenderOptions&, Number)>& set) {
  const Interval<Number> range{least, most};
  const auto parse = [=](RenderOptions& options, const std::string& text) {
    const std::optional<Number> value = parseNumber<Number>(text);
    if (!value || !range.contains(*value)) fail(key, text, expectedNumber(range));
    set(options, *value);
  };
  return {key, range.text(), defaultValue, meaning, parse};
}

// One word of several; the first is the default if none is said to be.
template <class Value>
Setting choice(const std::string& key, const std::vector<std::pair<std::string, Value>>& words,
               const std::string& defaultValue, const std::string& meaning,
               const std::function<void(RenderOptions&, Value)>& set) {
  std::string names;
  for (const auto& [word, value] : words) names += (names.empty() ? "" : "|") + word;
  const auto parse = [=](RenderOptions& options, const std::string& text) {
    for (const auto& [word, value] : words)
      if (word == text) return set(options, value);
    fail(key, text, "one of " + names);
  };
  return {key, names, defaultValue, meaning, parse};
}

constexpr Interval<float> kPriorSamples{0, 1e9f};

void setPriorSamples(RenderOptions& options, const std::string& text) {
  const auto values = parseNumbers<float>(text, ':', kCellLevels, kPriorSamples);
  if (!values)
    fail("prior-samples", text,
         "four numbers from " + kPriorSamples.text() + " with colons between them, as in 250:250:120:30");
  std::copy_n(values->begin(), kCellLevels, options.guideOptions.priorSamples);
}

std::vector<Setting> settingsOfPaths() {
  using Options = RenderOptions;
  return {
      choice<SampleSpread>("samples",
                           {{"auto", SampleSpread::automatic},
                            {"even", SampleSpread::even},
                            {"adaptive", SampleSpread::adaptive}},
                           "auto",
                           "As many in each pixel, or more where it is noisy. auto: adaptive for odis.",
                           [](Options& o, SampleSpread v) { o.samples = v; }),
      number<int>("guide-bounces", -1, 1 << 20, "-1", "How many vertices of a path are guided; -1: all.",
                  [](Options& o, int v) { o.guideBounces = v; }),
      choice<GuideKind>("guide",
                        {{"network", GuideKind::network},
                         {"histogram", GuideKind::histogram},
                         {"oracle", GuideKind::oracle}},
                        "network", "What makes the maps: network, formula, or formula from an oracle.",
                        [](Options& o, GuideKind v) { o.guide = v; }),
      number<int>("oracle-spp", 1, 1 << 20, "64",
                  "Samples per pixel of the oracle, which are no part of the image.",
                  [](Options& o, int v) { o.oracleSpp = v; }),
      choice<LightChoiceKind>("lights",
                              {{"network", LightChoiceKind::network},
                               {"formula", LightChoiceKind::formula},
                               {"hierarchy", LightChoiceKind::hierarchy}},
                              "network", "How lights are chosen: network, formula, or hierarchy of lights.",
                              [](Options& o, LightChoiceKind v) { o.lights = v; }),
      choice<RouletteKind>("roulette",
                           {{"formula", RouletteKind::formula}, {"throughput", RouletteKind::throughput}},
                           "formula", "Ends guided paths by the light that comes back, or by throughput.",
                           [](Options& o, RouletteKind v) { o.roulette = v; }),
      choice<bool>("ended-paths", {{"mean", true}, {"nothing", false}}, "mean",
                   "What a path adds that roulette ends: the mean of its cell, or nothing.",
                   [](Options& o, bool v) { o.guideOptions.controlVariate = v; }),
      number<float>("cached-error", 0, 1e6, "0",
                    "With --cached: how far off paths may be, over the pixel's value. 0: by --spp.",
                    [](Options& o, float v) { o.guideOptions.cachedError = v; }),
      choice<ShadowRayKind>("shadow-rays",
                            {{"roulette", ShadowRayKind::roulette}, {"all", ShadowRayKind::all}}, "roulette",
                            "By roulette where the light would add little to the pixel, or all.",
                            [](Options& o, ShadowRayKind v) { o.shadowRays = v; }),
  };
}

std::vector<Setting> settingsOfPilotAndCells() {
  using Options = RenderOptions;
  return {
      number<double>("pilot-spp", 0, 1e6, "0",
                     "Samples per pixel of the pilot. 0: 0.25 in large images of few samples, else 1.",
                     [](Options& o, double v) { o.pilotSpp = v; }),
      number<int>("refine", 0, 1 << 20, "3",
                  "Guided samples per pixel that the guide learns from, too, after 1, 3, 7, ... of them.",
                  [](Options& o, int v) { o.refineSpp = v; }),
      number<double>("pilot-weight", 0, 1e6, "0.6", "Weight of a pilot sample; a guided one's is 1.",
                     [](Options& o, double v) { o.pilotWeight = v; }),
      number<float>("guided-cost", 0, 1e6, "1",
                    "Time of a guided ray over another's. 0: guide and refine even if it does not pay.",
                    [](Options& o, float v) { o.costs.guidedRay = v; }),
      number<float>("built-cell-cost", 0, 1e6, "70",
                    "Time to build a cell, over that of a ray, as odis bench measures it.",
                    [](Options& o, float v) { o.costs.builtCell = v; }),
      number<float>("recorded-ray-cost", 0, 1e6, "0.15", "Time to record what a ray brings, likewise.",
                    [](Options& o, float v) { o.costs.recordedRay = v; }),
      number<float>("bsdf-fraction", 0, 1, "0",
                    "Probability that a guided draw stays with the BSDF. 0: by variance and cost.",
                    [](Options& o, float v) { o.guideOptions.fixedBsdfFraction = v; }),
      number<int>("cells", 0, 1 << 16, "32; paper: 0",
                  "Finest cells along the diagonal of what the pilot saw. 0: no cells.",
                  [](Options& o, int v) { o.guideOptions.cellsPerDiagonal = v; }),
      {"prior-samples", "four times " + kPriorSamples.text(), "250:250:120:30",
       "Samples a coarser level is worth, finest first.", setPriorSamples},
      number<float>("map-floor", 0, 1, "0.03", "Share of the uniform distribution in every map.",
                    [](Options& o, float v) { o.guideOptions.floor = v; }),
  };
}

std::vector<Setting> settingsOfPixels() {
  using Options = RenderOptions;
  return {
      choice<OdisPixelMaps>("pixel-maps",
                            {{"none", ODIS_PIXEL_MAPS_NONE},
                             {"histogram", ODIS_PIXEL_MAPS_HISTOGRAM},
                             {"network", ODIS_PIXEL_MAPS_NETWORK},
                             {"oracle", ODIS_PIXEL_MAPS_ORACLE}},
                            "none; paper: network", "What makes maps at pixels.",
                            [](Options& o, OdisPixelMaps v) { o.guideOptions.pixelMaps = v; }),
      choice<std::string>("pixel-network",
                          {{"model", ""},
                           {"paper", "paper"},
                           {"paper-gan", "paper-gan"},
                           {"fast", "fast"},
                           {"fast-gan", "fast-gan"}},
                          "model; paper: paper", "Which network; model: --weights'.",
                          [](Options& o, const std::string& v) { o.pixelNetwork = v; }),
      number<uint32_t>("pixel-tile", 1, 16, "1; paper-fast: 4",
                       "A map for each square of so many pixels a side.",
                       [](Options& o, uint32_t v) { o.guideOptions.pixelTile = v; }),
      number<float>("pixel-share", 0, 1, "1", "Share of a pixel's map; the rest is the map of its cell.",
                    [](Options& o, float v) { o.guideOptions.pixelShare = v; }),
      choice<bool>("pixel-light", {{"all", true}, {"without-direct", false}}, "all",
                   "Whether histogram and oracle at pixels hold direct light.",
                   [](Options& o, bool v) { o.guideOptions.pixelDirectLight = v; }),
      choice<bool>("map-cosine", {{"on", true}, {"off", false}}, "on; paper: off",
                   "Whether maps are multiplied by the cosine at a vertex.",
                   [](Options& o, bool v) { o.guideOptions.cosineProduct = v; }),
  };
}

std::vector<Setting> settingsOfRivals() {
  using Options = RenderOptions;
  using Spatial = PpgOptions::Spatial;
  using Combine = PpgOptions::Combine;
  using Fraction = PpgOptions::BsdfFraction;
  return {
      choice<PpgOptions>("ppg", {{"2019", PpgOptions()}, {"2017", PpgOptions::firstPublished()}}, "2019",
                         "Improved, or as first published. To be given before the settings of its parts.",
                         [](Options& o, const PpgOptions& v) { o.ppg = v; }),
      number<float>("ppg-threshold", 1, 1e9f, "4000; 2017: 12000",
                    "Samples that halve a leaf of the first iteration.",
                    [](Options& o, float v) { o.ppg.threshold = v; }),
      number<float>("ppg-flux", 1e-6f, 1, "0.01", "Fraction of a leaf's light that divides a quadrant.",
                    [](Options& o, float v) { o.ppg.flux = v; }),
      choice<Spatial>("ppg-spatial",
                      {{"nearest", Spatial::nearest}, {"jitter", Spatial::jitter}, {"box", Spatial::box}},
                      "jitter; 2017: nearest", "Which leaves record a vertex.",
                      [](Options& o, Spatial v) { o.ppg.spatial = v; }),
      choice<QuadtreeFilter>("ppg-directional",
                             {{"nearest", QuadtreeFilter::nearest}, {"box", QuadtreeFilter::box}},
                             "box; 2017: nearest", "Which quadrants record a direction.",
                             [](Options& o, QuadtreeFilter v) { o.ppg.directional = v; }),
      choice<Combine>("ppg-combine", {{"last", Combine::last}, {"variance", Combine::inverseVariance}},
                      "variance; 2017: last", "Which iterations make the image.",
                      [](Options& o, Combine v) { o.ppg.combine = v; }),
      choice<Fraction>("ppg-bsdf-fraction", {{"half", Fraction::fixed}, {"learned", Fraction::learned}},
                       "learned; 2017: half", "Probability that a draw stays with the BSDF.",
                       [](Options& o, Fraction v) { o.ppg.bsdfFraction = v; }),
      number<int>("restir-neighbours", 0, 64, "4", "Pixels whose sample is resampled as well.",
                  [](Options& o, int v) { o.restir.neighbours = v; }),
      number<float>("restir-radius", 0, 1e4f, "16", "How far away they are at most, in pixels.",
                    [](Options& o, float v) { o.restir.radius = v; }),
  };
}

}  // namespace

const std::vector<Setting>& allSettings() {
  static const std::vector<Setting> all = [] {
    std::vector<Setting> result = settingsOfPaths();
    for (const auto more : {settingsOfPilotAndCells, settingsOfPixels, settingsOfRivals})
      for (Setting& setting : more()) result.push_back(std::move(setting));
    return result;
  }();
  return all;
}

void applySettings(RenderOptions& options, const std::vector<std::string>& texts) {
  for (const std::string& text : texts) {
    const size_t equals = text.find('=');
    if (equals == 0 || equals == std::string::npos)
      throw UsageError(fmt::format("--set: found \"{}\", expected key=value", text));
    const std::string key = text.substr(0, equals);
    const std::vector<Setting>& all = allSettings();
    const auto setting = std::find_if(all.begin(), all.end(), [&](const Setting& s) { return s.key == key; });
    if (setting == all.end()) {
      std::vector<std::string> keys;
      for (const Setting& s : all) keys.push_back(s.key);
      const std::string near = nearest(key, keys);
      throw UsageError(
          fmt::format("--set: there is no \"{}\". {}", key,
                      near.empty() ? "--help-settings lists all" : "Did you mean " + near + "?"));
    }
    setting->set(options, text.substr(equals + 1));
  }
}

std::string settingsText() {
  std::string text = "--set key=value, as often as you like; later ones win.\n";
  for (const Setting& s : allSettings())
    text +=
        fmt::format("\n  {} = {}\n      default: {}\n      {}\n", s.key, s.values, s.defaultValue, s.meaning);
  return text;
}

}  // namespace odis::app
