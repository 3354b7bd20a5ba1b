// Options that change nothing beside others are refused, or told.
#include <nlohmann/json.hpp>

#include "command_runner.h"
#include "render/image/write.h"
#include "render_arguments.h"
#include "settings.h"

namespace {

using odis::render::readExr;
using odis::test::Outcome;

// A value of each setting that it takes.
std::string anyValue(const odis::app::Setting& setting) {
  if (setting.key == "prior-samples") return "1:1:1:1";
  const size_t word = setting.values.find('|');
  return word != std::string::npos ? setting.values.substr(0, word)
                                   : setting.values.substr(0, setting.values.find(' '));
}

bool isTaken(const std::string& method) {
  try {
    odis::app::parseMethod(method);
    return true;
  } catch (const odis::app::UsageError&) {
    return false;
  }
}

// Which integrators take a key; a new setting has to join.
TEST(Effects, SettingsBelongToIntegrators) {
  for (const odis::app::Setting& setting : odis::app::allSettings()) {
    if (!setting.option.empty()) continue;
    std::string takenBy;
    for (const std::string integrator : {"path", "odis", "ppg", "openpgl", "restir"}) {
      std::string method = "--integrator " + integrator + " --set " + setting.key + "=" + anyValue(setting);
      if (integrator == "odis" && setting.key != "cells")
        method += " --cached --set pixel-maps=histogram --set guide=oracle";
      const bool refines = setting.key == "refine" || setting.key.ends_with("-cost");
      const bool network = setting.key == "pixel-network" || setting.key == "pixel-maps";
      if (integrator == "odis" && refines) method = "--set " + setting.key + "=" + anyValue(setting);
      if (integrator == "odis" && network)
        method = "--set pixel-maps=network --set " + setting.key + "=" + anyValue(setting);
      if (isTaken(method)) takenBy += integrator + " ";
    }
    std::string expected = "odis ";
    if (setting.key.starts_with("ppg")) expected = "ppg ";
    if (setting.key.starts_with("restir")) expected = "restir ";
    if (setting.key == "samples") expected = "path odis ";
    if (setting.key == "guide-bounces") expected = "odis ppg openpgl ";
    EXPECT_EQ(takenBy, expected) << setting.key;
  }
}

TEST(Effects, SettingsNeedOthers) {
  const std::pair<const char*, const char*> pairs[] = {
      {"--set oracle-spp=8", "--set guide=oracle"},
      {"--set oracle-spp=8", "--set pixel-maps=oracle"},
      {"--set cached-error=1", "--cached"},
      {"--set prior-samples=1:1:1:1", "--set guide=histogram"},
      {"--set pixel-tile=2", "--set pixel-maps=histogram"},
      {"--set pixel-share=0.5", "--set pixel-maps=histogram"},
      {"--set pixel-network=fast", "--set pixel-maps=network"},
      {"--set pixel-light=all", "--set pixel-maps=histogram"},
      {"--set map-floor=0.1 --set cells=0", "--set pixel-maps=histogram"},
  };
  for (const auto& [without, with] : pairs) {
    EXPECT_FALSE(isTaken(without)) << without;
    EXPECT_TRUE(isTaken(std::string(with) + " " + without)) << with << " " << without;
    EXPECT_TRUE(isTaken(std::string(without) + " " + with)) << without << " " << with;
  }
  for (const char* contradiction :
       {"--set ended-paths=nothing --set roulette=throughput", "--set refine=3 --set guide=oracle",
        "--set built-cell-cost=9 --set refine=0", "--set recorded-ray-cost=9 --set guided-cost=0",
        "--set guide=histogram --set cells=0", "--set cells=0 --cached", "--preset paper --cached",
        "--integrator path --weights " ODIS_SOURCE "/weights/odis.weights"})
    EXPECT_FALSE(isTaken(contradiction)) << contradiction;
}

class EffectsOfOptions : public odis::test::Odis {
 protected:
  Outcome render(const std::string& options) const {
    const Outcome outcome = run("render room.xml -o i.exr " + options);
    EXPECT_EQ(outcome.code, 0) << options << "\n" << outcome.text;
    return outcome;
  }
  static void expectText(const Outcome& outcome, const std::string& part) {
    EXPECT_NE(outcome.text.find(part), std::string::npos) << part << "\n" << outcome.text;
  }
  static void expectNoText(const Outcome& outcome, const std::string& part) {
    EXPECT_EQ(outcome.text.find(part), std::string::npos) << part << "\n" << outcome.text;
  }
  odis::render::ExrFile image() const { return readExr(file("i.exr").string()); }
};

TEST_F(EffectsOfOptions, RefusedBeforeRendering) {
  expectFailure("render room.xml --integrator path --set cells=3", 2,
                "--set cells: only --integrator odis has this setting");
  expectFailure("render room.xml --integrator path --aov depth,guide", 2,
                "--aov guide: only --integrator odis has a guide, found path");
  expectFailure("render room.xml --spp 1 --variance", 2, "--variance: one sample per pixel has none");
  expectFailure("render room.xml -o i.png --aov depth", 2, "--aov: i.png has no layers");
  expectFailure("render room.xml -o i.png --variance", 2, "--variance: i.png has no layers");
  expectFailure("render room.xml --exposure 1", 2, "--exposure: is of PNGs");
  expectFailure("render room.xml -q -v", 2, "--quiet excludes --verbose");
  EXPECT_FALSE(exists("room.exr") || exists("i.png"));
  // All layers that there are.
  render("-q --integrator path --aov all");
  EXPECT_EQ(image().channels.count("guide.cell"), 0u);
  EXPECT_EQ(image().channels.count("depth.Z"), 1u);
}

// The pilot of a small image is one sample per pixel, after which there is nothing to guide.
TEST_F(EffectsOfOptions, PilotsAloneArePlainPathTracing) {
  const std::string json = " --stats-json s.json";
  expectText(render("--spp 1 --aov all --cached" + json), "nothing is guided, this is plain path tracing");
  const auto stats = nlohmann::json::parse(std::ifstream(file("s.json")));
  EXPECT_EQ(stats.at("cells"), 0);
  EXPECT_EQ(stats.at("pilotVertices"), 0);
  EXPECT_EQ(stats.at("cached"), false);
  const auto guided = image();
  EXPECT_EQ(guided.metadata.at("odis:cached"), "no");
  EXPECT_EQ(guided.channels.count("guide.cell"), 0u);
  render("-q --spp 1 --integrator path");
  EXPECT_EQ(image().channels.at("R"), guided.channels.at("R"));
  expectNoText(render("--spp 2"), "nothing is guided");
  expectText(render("--spp 4 --set pilot-spp=4"), "nothing is guided");
  // Whoever asks for the pilot's vertices gets them.
  render("-q --spp 1 --records r.npy");
  EXPECT_GT(std::filesystem::file_size(file("r.npy")), 1000u);
}

TEST_F(EffectsOfOptions, NothingIsCachedAtSmallDepths) {
  expectText(render("--cached --max-depth 7"),
             "note: --cached: has no effect with a max_depth below 8, found 7");
  EXPECT_EQ(image().metadata.at("odis:cached"), "no");
  const auto uncached = image().channels;
  render("-q --max-depth 7");
  EXPECT_EQ(image().channels, uncached);
  expectNoText(render("--cached --max-depth 8"), "no effect");
  EXPECT_EQ(image().metadata.at("odis:cached"), "yes: the image is biased");
}

TEST_F(EffectsOfOptions, SamplesAreSpreadFromFourOn) {
  for (const std::string integrator : {"path", "odis"}) {
    const std::string method = "--set samples=adaptive --integrator " + integrator;
    expectText(render("--spp 3 " + method), "samples=adaptive: needs 4 samples per pixel, found 3");
    expectNoText(render("--spp 4 " + method), "note: ");
  }
  expectText(render("--spp 6 --set samples=adaptive --set pilot-spp=4"),
             "needs 7 samples per pixel, found 6");
  EXPECT_EQ(render("-q --spp 3 --set samples=adaptive").text, "");
  expectText(render("--set cells=0"), "note: --set cells=0: nothing is guided");
}

// A time limit, or a method, may leave pixels with one sample.
TEST_F(EffectsOfOptions, NoVarianceOfOneSample) {
  expectText(render("--spp 2 --variance --set pilot-weight=0"), "no variance is written");
  EXPECT_EQ(image().channels.count("variance.R"), 0u);
  expectNoText(render("--spp 2 --variance"), "no variance");
  EXPECT_EQ(image().channels.count("variance.R"), 1u);
}

}  // namespace
