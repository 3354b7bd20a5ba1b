// odis render --set: what its errors say, and that docs/settings.md has the program's table.
#include "settings.h"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "command.h"
#include "command_runner.h"
#include "support/markdown_table.h"

namespace {

using odis::app::allSettings;
using odis::app::applySettings;
using odis::app::Setting;
using odis::app::UsageError;
using odis::render::RenderOptions;
using odis::test::cellsOfRow;
using odis::test::Odis;

// What is wrong with a text of --set; empty if nothing is.
std::string complaintAbout(const std::string& text) {
  RenderOptions options;
  try {
    applySettings(options, {text});
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(Settings, LaterOnesWin) {
  RenderOptions options;
  applySettings(options, {"guide-bounces=2", "cells=64", "guide-bounces=5"});
  EXPECT_EQ(options.setting("guide-bounces"), "5");
  EXPECT_EQ(options.setting("cells"), "64");
}

TEST(Settings, ReachTheOptions) {
  RenderOptions o;
  const std::vector<std::string> ofLibrary = {"samples=even", "guide=oracle", "prior-samples=1:2:3.5:0"};
  std::vector<std::string> all = ofLibrary;
  for (const char* text : {"ppg-threshold=500", "ppg-flux=0.5", "ppg-directional=nearest", "ppg-combine=last",
                           "restir-neighbours=7"})
    all.push_back(text);
  applySettings(o, all);
  for (const std::string& text : ofLibrary) {
    const size_t equals = text.find('=');
    EXPECT_EQ(o.setting(text.substr(0, equals)), text.substr(equals + 1));
  }
  EXPECT_EQ(o.setting("cells"), "32");
  EXPECT_EQ(o.ppg.threshold, 500);
  EXPECT_EQ(o.ppg.flux, 0.5f);
  EXPECT_EQ(o.ppg.directional, odis::render::QuadtreeFilter::nearest);
  EXPECT_EQ(o.ppg.combine, odis::render::PpgOptions::Combine::last);
  EXPECT_EQ(o.restir.neighbours, 7);
}

TEST(Settings, ThatAreOptionsAreRefused) {
  EXPECT_EQ(complaintAbout("cached=on"), "--set cached: expected --cached");
  EXPECT_EQ(complaintAbout("max-depth=4"), "--set max-depth: expected --max-depth");
  EXPECT_EQ(complaintAbout("preset=paper"), "--set preset: expected --preset");
}

TEST(Settings, AnUnknownKeyIsAnsweredWithANearOne) {
  EXPECT_EQ(complaintAbout("guide-bounce=1"),
            "--set: there is no \"guide-bounce\". Did you mean guide-bounces?");
  EXPECT_EQ(complaintAbout("ligths=formula"), "--set: there is no \"ligths\". Did you mean lights?");
}

TEST(Settings, AnUnknownKeyWithoutANearOneIsAnsweredWithTheList) {
  EXPECT_EQ(complaintAbout("photon-mapping=1"),
            "--set: there is no \"photon-mapping\". --help-settings lists all");
}

TEST(Settings, AKeyAndAValueAreExpected) {
  for (const std::string text : {"cells", "=32", "=", ""})
    EXPECT_EQ(complaintAbout(text), "--set: found \"" + text + "\", expected key=value");
}

TEST(Settings, ValuesOutOfRangeAreRefused) {
  EXPECT_EQ(complaintAbout("cells=-1"), "--set cells: found \"-1\", expected a whole number from 0 to 65536");
  EXPECT_EQ(complaintAbout("bsdf-fraction=1.5"),
            "--set bsdf-fraction: found \"1.5\", expected a number from 0 to 1");
  for (const char* text :
       {"guide-bounces=-2", "cells=65537", "cells=99999999999999999999", "map-floor=-0.1", "map-floor=inf",
        "pilot-spp=1e7", "ppg-flux=0", "restir-neighbours=65", "prior-samples=250:250:120:-1"})
    EXPECT_NE(complaintAbout(text).find(", expected "), std::string::npos) << text;
}

TEST(Settings, WhatIsNoNumberIsRefused) {
  EXPECT_EQ(complaintAbout("map-floor=nan"), "--set map-floor: found \"nan\", expected a number from 0 to 1");
  EXPECT_EQ(complaintAbout("refine=two"),
            "--set refine: found \"two\", expected a whole number from 0 to 1048576");
  for (const char* text : {"bsdf-fraction=NaN", "pilot-weight=-nan", "pilot-spp=nan", "restir-radius=nan",
                           "prior-samples=nan:250:120:30", "ppg-threshold=", "cells=1.5", "cells=8x"})
    EXPECT_NE(complaintAbout(text).find(", expected "), std::string::npos) << text;
}

TEST(Settings, FourNumbersAreFour) {
  for (const char* values : {"250", "250:250:120", "250:250:120:30:30", "250 250 120 30", "a:b:c:d"})
    EXPECT_EQ(
        complaintAbout(std::string("prior-samples=") + values),
        "--set prior-samples: found \"" + std::string(values) +
            "\", expected four numbers from 0 to 1000000000 with colons between them, as in 250:250:120:30");
}

TEST(Settings, AWordThatIsNoChoiceIsRefused) {
  EXPECT_EQ(complaintAbout("lights=tree"),
            "--set lights: found \"tree\", expected one of network|formula|hierarchy");
  for (const char* text : {"roulette=", "ppg=2018", "samples=Even", "ppg-bsdf-fraction=0.5"})
    EXPECT_NE(complaintAbout(text).find(", expected one of "), std::string::npos) << text;
}

// A default that the program tells must be the one that it has: to set it changes nothing.
TEST(Settings, DefaultsAreValues) {
  for (const Setting& setting : allSettings()) {
    if (!setting.option.empty()) continue;
    const std::string value = setting.defaultValue.substr(0, setting.defaultValue.find(';'));
    EXPECT_EQ(complaintAbout(setting.key + "=" + value), "");
  }
}

TEST(Settings, DefaultsAreThoseOfTheOptions) {
  const RenderOptions expected;
  RenderOptions o;
  for (const Setting& setting : allSettings())
    if (setting.option.empty())
      setting.set(o, setting.defaultValue.substr(0, setting.defaultValue.find(';')));
  EXPECT_EQ(o.ppg.threshold, expected.ppg.threshold);
  EXPECT_EQ(o.ppg.flux, expected.ppg.flux);
  EXPECT_EQ(o.ppg.spatial, expected.ppg.spatial);
  EXPECT_EQ(o.ppg.directional, expected.ppg.directional);
  EXPECT_EQ(o.ppg.combine, expected.ppg.combine);
  EXPECT_EQ(o.ppg.bsdfFraction, expected.ppg.bsdfFraction);
  EXPECT_EQ(o.restir.neighbours, expected.restir.neighbours);
  EXPECT_EQ(o.restir.radius, expected.restir.radius);
}

// The heading that a setting belongs under.
std::string groupOf(const Setting& setting) {
  if (setting.key.rfind("ppg", 0) == 0) return "## Practical path guiding";
  if (setting.key.rfind("restir", 0) == 0) return "## Resampling";
  return "## ODIS";
}

TEST(Settings, ThePageHasTheProgramsTable) {
  std::ifstream stream(ODIS_SOURCE "/docs/settings.md");
  ASSERT_TRUE(stream);
  std::string heading;
  size_t lines = 0, row = 0, tables = 0;
  for (std::string line; std::getline(stream, line); ++lines) {
    EXPECT_LE(line.size(), 120u) << line;
    if (line.rfind("## ", 0) == 0) heading = line;
    if (line.rfind('|', 0) != 0 || line.rfind("|---", 0) == 0) continue;
    const std::vector<std::string> cells = cellsOfRow(line);
    ASSERT_EQ(cells.size(), 4u) << line;
    if (cells[0] == "key") {
      EXPECT_EQ(cells, (std::vector<std::string>{"key", "values", "default", "meaning"}));
      ++tables;
      continue;
    }
    ASSERT_LT(row, allSettings().size()) << line;
    const Setting& setting = allSettings()[row++];
    EXPECT_EQ(heading, groupOf(setting)) << line;
    EXPECT_EQ(cells[0], "`" + setting.key + "`");
    EXPECT_EQ(cells[1], setting.values) << setting.key;
    EXPECT_EQ(cells[2], setting.defaultValue) << setting.key;
    EXPECT_EQ(cells[3], setting.meaning) << setting.key;
  }
  EXPECT_EQ(row, allSettings().size()) << "settings that are not in the page follow";
  EXPECT_EQ(tables, 3u);
  EXPECT_LE(lines, 200u);
}

// Words name=value of the page's text on presets.
TEST(Settings, ThePageHasThePresets) {
  std::ifstream file(ODIS_SOURCE "/docs/settings.md");
  std::ostringstream page;
  page << file.rdbuf();
  std::string text = page.str();
  const size_t begin = text.find("- `preset`:"), end = text.find("- `pixel-maps` and", begin);
  ASSERT_NE(end, std::string::npos);
  text = text.substr(begin, end - begin);
  std::string paper, fast, *preset = &paper;
  std::replace(text.begin(), text.end(), '`', ' ');
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (word == "paper-fast") preset = &fast;
    if (word.find('=') != std::string::npos) *preset += " " + word;
  }
  for (const odis::Setting& setting : odis::settings()) {
    if (setting.name == std::string("preset")) continue;
    EXPECT_EQ(odis::readSetting("preset=paper", setting.name), odis::readSetting(paper, setting.name));
    EXPECT_EQ(odis::readSetting("preset=paper-fast", setting.name),
              odis::readSetting(paper + fast, setting.name));
  }
}

TEST(Settings, HelpHasTheProgramsTable) {
  const std::string text = odis::app::settingsText();
  for (const Setting& setting : allSettings())
    EXPECT_EQ(text.find("\n  " + setting.key + " = " + setting.values + "\n      default: " +
                        setting.defaultValue + "\n      " + setting.meaning + "\n") != std::string::npos,
              setting.option.empty())
        << setting.key;
}

TEST_F(Odis, MistakesInSettingsAreWrongUsage) {
  expectFailure("render room.xml --set guide-bounce=1", 2, "Did you mean guide-bounces?");
  expectFailure("render room.xml --set photon-mapping=1", 2, "--help-settings lists all");
  expectFailure("render room.xml --set cells", 2, "expected key=value");
  expectFailure("render room.xml --set cells=-1", 2, "expected a whole number from 0 to 65536");
  expectFailure("render room.xml --set lights=tree", 2, "expected one of network|formula|hierarchy");
  expectFailure("render room.xml --set", 2, "--set");
  expectFailure("render room.xml --guide-bounce 1", 2, "Did you mean --set guide-bounces=...?");
  expectFailure("compare room.xml -o out --methods 'a=--set cells=-1'", 2, "--set cells");
  expectFailure("inspect room.xml --pixel 6,4 --set cells=-1", 2, "--set cells");
  EXPECT_FALSE(exists("room.exr"));
  EXPECT_EQ(run("render room.xml -q --set guide-bounces=1 --set cells=16").code, 0);
}

// With oneDNN the preset renders, to the same bits for any number of threads; without, it says what to
// install.
TEST_F(Odis, ThePapersPresetRenders) {
  const odis::test::Outcome first =
      run("render room.xml -q --preset paper-fast --threads 1 -o one.exr --png one.png");
  if (first.code != 0) {
    EXPECT_NE(first.text.find("oneDNN is missing"), std::string::npos) << first.text;
    GTEST_SKIP() << "without oneDNN";
  }
  EXPECT_EQ(run("render room.xml -q --preset paper-fast --threads 3 -o three.exr --png three.png").code, 0);
  EXPECT_EQ(runShell("cmp one.png three.png").code, 0);
  // Presets are where settings start from.
  EXPECT_EQ(run("render room.xml -q --preset paper --set pixel-network=fast-gan --set pixel-tile=2 --set "
                "map-cosine=on -o image.exr")
                .code,
            0);
  EXPECT_EQ(run("render room.xml -q --preset paper --set pixel-maps=histogram -o image.exr").code, 0);
}

// What hardly anybody changes is a setting, so that the list of options stays one that can be read.
TEST_F(Odis, RenderHasFewOptions) {
  const odis::test::Outcome help = run("render --help");
  ASSERT_EQ(help.code, 0);
  std::istringstream stream(help.text);
  int options = 0;
  for (std::string line; std::getline(stream, line);) {
    const size_t first = line.find_first_not_of(' ');
    if (line.find("--help ") != std::string::npos || line.find("-h,") != std::string::npos) continue;
    options += first != std::string::npos && first > 0 && line[first] == '-' &&
               (line[first + 1] == '-' || std::isalpha(static_cast<unsigned char>(line[first + 1])));
  }
  EXPECT_GT(options, 10);
  EXPECT_LE(options, 33) << help.text;
}

}  // namespace
