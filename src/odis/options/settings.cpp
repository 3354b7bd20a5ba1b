#include "odis/options/settings.h"

#include <algorithm>
#include <charconv>
#include <functional>
#include <numeric>
#include <stdexcept>

namespace odis::core {

namespace {

using Options = FrameOptions;

// One setting: how it is shown, and how it is read and written.
struct Row {
  std::string name, values, help, defaultValue = {};
  OdisSettingOwner owner = ODIS_SETTING_OF_GUIDES;
  bool research = true;
  // Changes options; throws std::invalid_argument for what is no value.
  std::function<void(Options&, std::string_view)> set = {};
  // Null where the options don't hold it.
  std::function<std::string(const Options&)> get = {};
};

[[noreturn]] void refuse(const std::string& name, std::string_view value, const std::string& expected) {
  throw std::invalid_argument(name + ": found \"" + std::string(value) + "\", expected " + expected);
}

template <class Number>
std::string textOf(Number value) {
  char text[64];
  const auto [end, error] = std::to_chars(text, text + sizeof text, value);
  return {text, end};
}

// The numbers that a setting may be.
template <class Number>
struct Range {
  Number least, most;

  // Reads a decimal number; false if the text is none, or one out of the range.
  bool parse(std::string_view text, Number& value) const {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    return error == std::errc() && stop == end && value >= least && value <= most;
  }
  std::string text() const { return shown(least) + " to " + shown(most); }
  std::string expected() const {
    return (std::is_integral_v<Number> ? "a whole number from " : "a number from ") + text();
  }

 private:
  // Large numbers without an exponent.
  static std::string shown(Number value) {
    return Number(int64_t(value)) == value ? textOf(int64_t(value)) : textOf(value);
  }
};

// `at` gives the place of a value in options, const ones and others.
template <class Number, class At>
Row number(const std::string& name, Range<Number> range, const std::string& help, At at) {
  Row row{name, range.text(), help};
  row.set = [=](Options& options, std::string_view text) {
    Number value{};
    if (!range.parse(text, value)) refuse(name, text, range.expected());
    at(options) = value;
  };
  row.get = [=](const Options& options) { return textOf(at(options)); };
  return row;
}

// A word, and what it stands for.
template <class Value>
using Words = std::vector<std::pair<std::string, Value>>;

template <class Value>
std::string namesOf(const Words<Value>& words) {
  std::string names;
  for (const auto& [word, value] : words) names += (names.empty() ? "" : "|") + word;
  return names;
}
template <class Value>
const Value& find(const Words<Value>& words, const std::string& name, std::string_view text) {
  for (const auto& [word, value] : words)
    if (word == text) return value;
  refuse(name, text, "one of " + namesOf(words));
}

template <class Value, class At>
Row choice(const std::string& name, const Words<Value>& words, const std::string& help, At at) {
  Row row{name, namesOf(words), help};
  row.set = [=](Options& options, std::string_view text) { at(options) = find(words, name, text); };
  row.get = [=](const Options& options) {
    for (const auto& [word, value] : words)
      if (value == at(options)) return word;
    return std::string("no word");  // which is refused
  };
  return row;
}
const Words<bool> kOnOff = {{"on", true}, {"off", false}};

// A number for each level of cells, with colons between them.
Row priorSamples(const std::string& name, const std::string& help) {
  constexpr Range<float> range{0, 1e9f};
  Row row{name, "four times " + range.text(), help};
  row.set = [=](Options& options, std::string_view text) {
    std::array<float, kCellLevels> samples{};
    std::string_view rest = text;
    bool isSound = std::count(text.begin(), text.end(), ':') == kCellLevels - 1;
    for (float& value : samples) {
      const size_t end = std::min(rest.find(':'), rest.size());
      isSound &= range.parse(rest.substr(0, end), value);
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    if (!isSound)
      refuse(name, text,
             "four numbers from " + range.text() + " with colons between them, as in 250:250:120:30");
    options.guide.priorSamples = samples;
  };
  row.get = [](const Options& options) {
    std::string text;
    for (const float samples : options.guide.priorSamples) {
      if (!text.empty()) text += ':';
      text += textOf(samples);
    }
    return text;
  };
  return row;
}

// A setting of what the host's paths do: checked here, and read by the host (odisReadSetting).
Row ofPaths(const std::string& name, const std::string& values, const std::string& defaultValue,
            const std::string& help, const std::function<void(std::string_view)>& check) {
  Row row{name, values, help, defaultValue, ODIS_SETTING_OF_PATHS};
  row.set = [check](Options&, std::string_view text) { check(text); };
  return row;
}
// One word of several; the first is the default.
Row wordOfPaths(const std::string& name, const std::vector<std::string>& words, const std::string& help) {
  Words<bool> checked;
  for (const std::string& word : words) checked.emplace_back(word, true);
  return ofPaths(name, namesOf(checked), words.front(), help,
                 [=](std::string_view text) { find(checked, name, text); });
}
Row guideBounces() {
  const std::string name = "guide-bounces";
  constexpr Range<int> range{-1, 1 << 20};
  return ofPaths(name, range.text(), "-1", "How many vertices of a path are guided; -1: all.",
                 [=](std::string_view text) {
                   int value = 0;
                   if (!range.parse(text, value)) refuse(name, text, range.expected());
                 });
}

Row ofFrames(Row row) {
  row.owner = ODIS_SETTING_OF_FRAMES;
  return row;
}
Row forUsers(Row row) {
  row.research = false;
  return row;
}

constexpr Range<float> kShare{0, 1}, kUpToAMillion{0, 1e6f};
constexpr Range<uint32_t> kSamples{0, 1 << 20};

// Paths and passes.
std::vector<Row> rowsOfPaths() {
  return {
      forUsers(ofFrames(choice<SampleSpread>(
          "samples",
          {{"auto", SampleSpread::automatic},
           {"even", SampleSpread::even},
           {"adaptive", SampleSpread::adaptive}},
          "As many in each pixel, or more in noisy ones. auto: adaptive where guided.",
          [](auto& o) -> auto& { return o.samples; }))),
      guideBounces(),
      choice<GuideKind>(
          "guide",
          {{"network", GuideKind::network},
           {"histogram", GuideKind::histogram},
           {"oracle", GuideKind::oracle}},
          "What makes the maps: network, formula, or formula from an oracle.",
          [](auto& o) -> auto& { return o.guide.guide; }),
      ofFrames(number<uint32_t>(
          "oracle-spp", {1, 1 << 20}, "Samples per pixel of the oracle, which are no part of the image.",
          [](auto& o) -> auto& { return o.oracleSpp; })),
      choice<LightChoiceKind>(
          "lights",
          {{"network", LightChoiceKind::network},
           {"formula", LightChoiceKind::formula},
           {"hierarchy", LightChoiceKind::hierarchy}},
          "How lights are chosen: network, formula, or hierarchy of lights.",
          [](auto& o) -> auto& { return o.guide.lights; }),
      wordOfPaths("roulette", {"formula", "throughput"},
                  "Ends guided paths by the light that comes back, or by throughput."),
      choice<bool>(
          "ended-paths", {{"mean", true}, {"nothing", false}},
          "What a path adds that roulette ends: the mean of its cell, or nothing.",
          [](auto& o) -> auto& { return o.guide.controlVariate; }),
      forUsers(choice<bool>(
          "cached", kOnOff, "Whether paths may end with cached radiance, which is biased.",
          [](auto& o) -> auto& { return o.guide.cached; })),
      forUsers(number(
          "cached-error", kUpToAMillion,
          "How far off paths may be then, over the pixel's value. 0: by the samples.",
          [](auto& o) -> auto& { return o.guide.cachedError; })),
      wordOfPaths("shadow-rays", {"roulette", "all"},
                  "By roulette where the light would add little to the pixel, or all."),
      forUsers(number<uint32_t>(
          "max-depth", {0, UINT32_MAX}, "Depth at which all paths end; 0: none.",
          [](auto& o) -> auto& { return o.guide.maxDepth; })),
  };
}

std::vector<Row> rowsOfPilotAndCells() {
  return {
      forUsers(ofFrames(choice<bool>(
          "guided", kOnOff, "Whether there is a pilot and a guide.",
          [](auto& o) -> auto& { return o.guided; }))),
      ofFrames(number<double>(
          "pilot-spp", {0, 1e6},
          "Samples per pixel of the pilot. 0: 0.25 in large images of few samples, else 1.",
          [](auto& o) -> auto& { return o.pilotSamplesPerPixel; })),
      ofFrames(choice<bool>(
          "pilot-vertices", {{"kept", true}, {"dropped", false}},
          "Whether the pilot's vertices stay when the guide is built.",
          [](auto& o) -> auto& { return o.keepPilotVertices; })),
      ofFrames(number(
          "refine", kSamples,
          "Guided samples per pixel that the guide learns from, too, after 1, 3, 7, ... of them.",
          [](auto& o) -> auto& { return o.refinementSamples; })),
      ofFrames(number(
          "pilot-weight", kUpToAMillion, "Weight of a pilot sample; a guided one's is 1.",
          [](auto& o) -> auto& { return o.pilotWeight; })),
      forUsers(ofFrames(number(
          "guided-cost", kUpToAMillion,
          "Time of a guided ray over another's. 0: guide and refine even if it does not pay.",
          [](auto& o) -> auto& { return o.guidedCost; }))),
      forUsers(ofFrames(number(
          "built-cell-cost", kUpToAMillion,
          "Time to build a cell, over that of a ray, as odis bench measures it.",
          [](auto& o) -> auto& { return o.builtCellCost; }))),
      forUsers(ofFrames(number(
          "recorded-ray-cost", kUpToAMillion, "Time to record what a ray brings, likewise.",
          [](auto& o) -> auto& { return o.recordedRayCost; }))),
      number(
          "bsdf-fraction", kShare,
          "Probability that a guided draw stays with the BSDF. 0: by variance and cost.",
          [](auto& o) -> auto& { return o.guide.fixedBsdfFraction; }),
      number<int32_t>(
          "cells", {0, 1 << 16}, "Finest cells along the diagonal of what the pilot saw. 0: no cells.",
          [](auto& o) -> auto& { return o.guide.cellsPerDiagonal; }),
      priorSamples("prior-samples", "Samples a coarser level is worth, finest first."),
      number(
          "map-floor", kShare, "Share of the uniform distribution in every map.",
          [](auto& o) -> auto& { return o.guide.floor; }),
      number<float>(
          "map-clamp", {0.001f, 1e9f},
          "A sample counts at most this many times its neighbourhood's mean in maps.",
          [](auto& o) -> auto& { return o.guide.clamp; }),
      choice<bool>(
          "maps", {{"auto", false}, {"always", true}},
          "Whether cells have maps where coarse ones save much, or always.",
          [](auto& o) -> auto& { return o.guide.alwaysMaps; }),
  };
}

// The method of the paper.
std::vector<Row> rowsOfPixels() {
  return {
      choice<PixelMapKind>(
          "pixel-maps",
          {{"none", PixelMapKind::none},
           {"histogram", PixelMapKind::histogram},
           {"network", PixelMapKind::network},
           {"oracle", PixelMapKind::oracle}},
          "What makes maps at pixels.", [](auto& o) -> auto& { return o.guide.pixelMaps; }),
      choice<std::string>(
          "pixel-network",
          {{"model", ""},
           {"paper", "paper"},
           {"paper-gan", "paper-gan"},
           {"fast", "fast"},
           {"fast-gan", "fast-gan"}},
          "Which network; model: that of the weights.",
          [](auto& o) -> auto& { return o.guide.pixelNetwork; }),
      number<uint32_t>(
          "pixel-tile", {1, 16}, "Side of the square of pixels that shares a map.",
          [](auto& o) -> auto& { return o.guide.pixelTile; }),
      number(
          "pixel-share", kShare, "Share of a pixel's map; the rest is the map of its cell.",
          [](auto& o) -> auto& { return o.guide.pixelShare; }),
      choice<bool>(
          "pixel-light", {{"all", true}, {"without-direct", false}},
          "Whether histogram and oracle at pixels hold direct light.",
          [](auto& o) -> auto& { return o.guide.pixelDirectLight; }),
      choice<bool>(
          "map-cosine", kOnOff, "Whether maps hold the mean cosine of their cell's vertices.",
          [](auto& o) -> auto& { return o.guide.cosineProduct; }),
  };
}

// Texts of settings that have a name. `paper` and `paper-fast` are the method of Bako et al. 2019, with a map
// for each pixel or for tiles of 4 x 4: maps at pixels, half and half with the BSDF, and nothing else that is
// learned.
const std::vector<std::pair<std::string, std::string>>& presets() {
  static const std::string paper =
      "pixel-maps=network pixel-network=paper map-cosine=off bsdf-fraction=0.5 cells=0 guide-bounces=1 "
      "roulette=throughput lights=hierarchy shadow-rays=all samples=even refine=0 pilot-spp=1 pilot-weight=1 "
      "guided-cost=0";
  static const std::vector<std::pair<std::string, std::string>> all = {
      {"default", ""}, {"paper", paper}, {"paper-fast", paper + " pixel-network=fast pixel-tile=4"}};
  return all;
}
constexpr std::string_view kPreset = "preset";

std::vector<Row> makeRows() {
  std::vector<Row> rows;
  std::vector<std::string> names;
  for (const auto& [name, text] : presets()) names.push_back(name);
  Row preset =
      wordOfPaths(std::string(kPreset), names, "Settings to start from; paper: that of Bako et al. 2019.");
  preset.owner = ODIS_SETTING_OF_ALL;
  rows.push_back(forUsers(std::move(preset)));
  for (const auto more : {rowsOfPaths, rowsOfPilotAndCells, rowsOfPixels})
    for (Row& row : more()) rows.push_back(std::move(row));
  for (Row& row : rows)
    if (row.get) row.defaultValue = row.get(Options());
  return rows;
}
const std::vector<Row>& allRows() {
  static const std::vector<Row> rows = makeRows();
  return rows;
}

// How many letters are to be inserted, removed or changed (Levenshtein).
size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t(0));
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i + 1;
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, diagonal + 1, row[j] + 1});
    }
  }
  return row.back();
}

const Row& rowNamed(std::string_view name) {
  const std::vector<Row>& rows = allRows();
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.name == name; });
  if (found != rows.end()) return *found;
  const auto distance = [&](const Row& row) { return editDistance(name, row.name); };
  const auto near = std::min_element(rows.begin(), rows.end(),
                                     [&](const Row& a, const Row& b) { return distance(a) < distance(b); });
  const bool isNear = distance(*near) <= std::max<size_t>(2, name.size() / 3);
  throw std::invalid_argument("there is no setting \"" + std::string(name) + "\"" +
                              (isNear ? ". Did you mean " + near->name + "?" : ""));
}

// Calls `use` with each setting and value of a text, and those of presets in their place.
template <class Use>
void forEachSetting(std::string_view text, const Use& use) {
  constexpr std::string_view kBlanks = " \t\n\r";
  for (size_t begin = 0; (begin = text.find_first_not_of(kBlanks, begin)) != text.npos;) {
    const size_t end = std::min(text.find_first_of(kBlanks, begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    begin = end;
    const size_t equals = word.find('=');
    if (equals == 0 || equals == word.npos)
      throw std::invalid_argument("found \"" + std::string(word) + "\", expected name=value");
    const std::string_view value = word.substr(equals + 1);
    use(rowNamed(word.substr(0, equals)), value);
    if (word.substr(0, equals) == kPreset)
      for (const auto& [name, settings] : presets())
        if (name == value) forEachSetting(settings, use);
  }
}

// A text of the settings that options hold, of those rows that are chosen.
template <class IsChosen>
std::string textOfRows(const FrameOptions& options, const IsChosen& isChosen) {
  std::string text;
  for (const Row& row : allRows())
    if (row.get && isChosen(row)) text += (text.empty() ? "" : " ") + row.name + "=" + row.get(options);
  return text;
}

}  // namespace

const std::vector<OdisSetting>& allSettings() {
  static const std::vector<OdisSetting> all = [] {
    std::vector<OdisSetting> settings;
    for (const Row& row : allRows()) {
      OdisSetting setting;
      setting.name = row.name.c_str();
      setting.values = row.values.c_str();
      setting.defaultValue = row.defaultValue.c_str();
      setting.help = row.help.c_str();
      setting.owner = row.owner;
      setting.research = row.research;
      settings.push_back(setting);
    }
    return settings;
  }();
  return all;
}

void applySettings(FrameOptions& options, std::string_view text) {
  forEachSetting(text, [&](const Row& row, std::string_view value) { row.set(options, value); });
}

std::string readSetting(std::string_view text, std::string_view name) {
  const Row& asked = rowNamed(name);
  std::string result = asked.defaultValue;
  FrameOptions options;
  forEachSetting(text, [&](const Row& row, std::string_view value) {
    row.set(options, value);
    if (&row == &asked) result = value;
  });
  return result;
}

std::string settingsText(const FrameOptions& options) {
  return textOfRows(options, [](const Row&) { return true; });
}

std::string settingsText(const GuideOptions& options) {
  FrameOptions all;
  all.guide = options;
  return textOfRows(all, [](const Row& row) { return row.owner == ODIS_SETTING_OF_GUIDES; });
}

std::string differingSetting(const GuideOptions& a, const GuideOptions& b) {
  FrameOptions first, second;
  first.guide = a;
  second.guide = b;
  for (const Row& row : allRows())
    if (row.get && row.get(first) != row.get(second)) return row.name;
  return "";
}

void requireRanges(const FrameOptions& options) {
  FrameOptions checked;
  applySettings(checked, settingsText(options));
}

}  // namespace odis::core
