// The table of what is set by name.
#include "odis/options/settings.h"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

namespace odis::core {
namespace {

// What is wrong with a text; empty if nothing is.
std::string wrongWith(const std::string& text) {
  FrameOptions options;
  try {
    applySettings(options, text);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

// A value other than the default.
std::string otherValue(const OdisSetting& setting) {
  const std::string values = setting.values, usual = setting.defaultValue;
  if (usual.find(':') != std::string::npos) return "1:2.5:0:1e-20";
  if (values.find('|') == std::string::npos) return usual == "1" ? "0.5" : "1";
  const std::string first = values.substr(0, values.find('|'));
  return first == usual ? values.substr(values.rfind('|') + 1) : first;
}

TEST(SettingsTable, HasEachNameOnceAndItsDefault) {
  std::set<std::string> names;
  for (const OdisSetting& setting : allSettings()) {
    EXPECT_TRUE(names.insert(setting.name).second) << setting.name;
    EXPECT_EQ(wrongWith(std::string(setting.name) + "=" + setting.defaultValue), "") << setting.name;
    EXPECT_EQ(readSetting("", setting.name), setting.defaultValue);
    EXPECT_GT(std::string(setting.help).size(), 10u);
  }
}

// A text of all settings brings back what each of them was.
TEST(SettingsTable, WritesWhatItReads) {
  for (const OdisSetting& setting : allSettings()) {
    const std::string name = setting.name;
    if (name == "preset" || setting.owner == ODIS_SETTING_OF_PATHS) continue;
    std::string value = otherValue(setting);
    if (value == "0.5" && wrongWith(name + "=" + value) != "") value = "2";
    FrameOptions options, again;
    applySettings(options, name + "=" + value);
    EXPECT_EQ(readSetting(settingsText(options), name), value) << name;
    EXPECT_NE(settingsText(options), settingsText(FrameOptions())) << name;
    applySettings(again, settingsText(options));
    EXPECT_EQ(settingsText(again), settingsText(options)) << name;
    requireRanges(options);
  }
}

TEST(SettingsTable, NumbersKeepEveryBit) {
  FrameOptions options, again;
  options.guide.floor = 0.1f / 3;
  options.pilotSamplesPerPixel = 1.0 / 3;
  options.guidedCost = 1e-30f;
  applySettings(again, settingsText(options));
  EXPECT_EQ(again.guide.floor, options.guide.floor);
  EXPECT_EQ(again.pilotSamplesPerPixel, options.pilotSamplesPerPixel);
  EXPECT_EQ(again.guidedCost, options.guidedCost);
}

TEST(SettingsTable, LaterWordsWinAndPresetsAreWords) {
  FrameOptions options;
  applySettings(options, "  cells=3\tpreset=paper \n refine=2 ");
  EXPECT_EQ(options.guide.cellsPerDiagonal, 0);
  EXPECT_EQ(options.refinementSamples, 2u);
  EXPECT_EQ(options.guide.pixelMaps, PixelMapKind::network);
  EXPECT_EQ(options.guide.fixedBsdfFraction, 0.5f);
  EXPECT_EQ(readSetting("preset=paper", "guide-bounces"), "1");
  EXPECT_EQ(readSetting("preset=paper guide-bounces=3", "guide-bounces"), "3");
  EXPECT_EQ(readSetting("preset=paper-fast", "pixel-tile"), "4");
}

TEST(SettingsTable, SaysWhatIsWrong) {
  EXPECT_EQ(wrongWith("cels=3"), "there is no setting \"cels\". Did you mean cells?");
  EXPECT_EQ(wrongWith("photon-mapping=1"), "there is no setting \"photon-mapping\"");
  EXPECT_EQ(wrongWith("refine=1 cells"), "found \"cells\", expected name=value");
  EXPECT_EQ(wrongWith("cells=1.5"), "cells: found \"1.5\", expected a whole number from 0 to 65536");
  EXPECT_EQ(wrongWith("map-floor=nan"), "map-floor: found \"nan\", expected a number from 0 to 1");
  EXPECT_EQ(wrongWith("lights=tree"), "lights: found \"tree\", expected one of network|formula|hierarchy");
  EXPECT_EQ(wrongWith("roulette="), "roulette: found \"\", expected one of formula|throughput");
  EXPECT_EQ(wrongWith("preset=papre"), "preset: found \"papre\", expected one of default|paper|paper-fast");
  for (const char* samples : {"250", "1:2:3", "1:2:3:4:5", "1:2:3:", ":1:2:3", "1:2:3:-1", "a:b:c:d"})
    EXPECT_NE(wrongWith(std::string("prior-samples=") + samples).find("four numbers"), std::string::npos);
}

}  // namespace
}  // namespace odis::core
