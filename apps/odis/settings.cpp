#include "settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "command.h"
#include "numbers.h"
#include "suggest.h"

namespace odis::app {

using namespace render;

namespace {

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

// The option of the command line that a setting of the library is set by; "" if it is --set.
std::string optionOf(const std::string& key) {
  static const std::map<std::string, std::string> options = {{"preset", "--preset"},
                                                             {"cached", "--cached"},
                                                             {"max-depth", "--max-depth"},
                                                             {"guided", "--integrator"},
                                                             {"pilot-vertices", "--records"}};
  const auto found = options.find(key);
  return found == options.end() ? "" : found->second;
}

Setting ofLibrary(const odis::Setting& setting) {
  const std::string key = setting.name, option = optionOf(setting.name);
  const auto set = [=](RenderOptions& options, const std::string& value) {
    if (!option.empty()) throw UsageError(fmt::format("--set {}: expected {}", key, option));
    // The library's texts have a blank between two words: a value with one is none.
    const bool isWord = value.find_first_of(" \t\n\r") == std::string::npos;
    const std::string shown = isWord ? value : "?", text = key + "=" + shown;
    try {
      odis::readSetting(text, key);
    } catch (const odis::Error& error) {
      std::string message = error.what();
      message.replace(message.find('"' + shown + '"') + 1, shown.size(), value);
      throw UsageError("--set " + message);
    }
    options.set(text);
  };
  return {key, setting.values, setting.defaultValue, setting.help, set, option};
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
    std::vector<Setting> result;
    for (const odis::Setting& setting : odis::settings()) result.push_back(ofLibrary(setting));
    for (Setting& setting : settingsOfRivals()) result.push_back(std::move(setting));
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
    if (s.option.empty())
      text += fmt::format("\n  {} = {}\n      default: {}\n      {}\n", s.key, s.values, s.defaultValue,
                          s.meaning);
  return text;
}

}  // namespace odis::app
