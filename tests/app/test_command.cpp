// Runs the built command: exit codes, messages, and what is left on disk.
#include "command_runner.h"

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "render/image/write.h"

namespace {

namespace fs = std::filesystem;
using odis::test::Odis;
using odis::test::Outcome;

TEST_F(Odis, HelpAndVersion) {
  EXPECT_EQ(run("--help").code, 0);
  EXPECT_NE(run("--help").text.find("Exit codes"), std::string::npos);
  EXPECT_NE(run("render --help").text.find("--set"), std::string::npos);
  EXPECT_EQ(run("render --help-settings").code, 0);
  EXPECT_NE(run("render --help-settings").text.find("guide-bounces = "), std::string::npos);
  EXPECT_EQ(run("--version").code, 0);
  EXPECT_EQ(run("--version").text.rfind("odis ", 0), 0u);
}

TEST_F(Odis, WrongUsageIsTwo) {
  expectFailure("", 2, "expected a command: one of");
  expectFailure("rendr room.xml", 2, "Did you mean render?");
  expectFailure("rendr room.xml", 2, "there is no command \"rendr\", expected one of render, compare");
  expectFailure("image inof", 2, "there is no command \"inof\", expected one of info, convert");
  expectFailure("--foo", 2, "there is no option \"--foo\"");
  expectFailure("render", 2, "SCENE");
  expectFailure("render room.xml --ssp 4", 2, "Did you mean --spp?");
  expectFailure("render room.xml --spp 0", 2, "--spp");
  expectFailure("render room.xml --spp four", 2, "--spp");
  expectFailure("render room.xml --integrator bdpt", 2, "bdpt");
  expectFailure("render room.xml --resolution 640", 2, "expected WIDTHxHEIGHT");
  expectFailure("render room.xml --crop 0,0,5", 2, "expected x,y,width,height");
  expectFailure("render room.xml -D radiance", 2, "expected key=value");
  expectFailure("render room.xml --aov normals", 2, "expected alpha, albedo");
  expectFailure("render room.xml -o image.jpg", 2, "expected a name that ends in .exr or .png");
  expectFailure("render room.xml --replay 1,2", 2, "expected x,y,sample");
  expectFailure("render room.xml --replay 99,2,0", 2, "outside");
  expectFailure("render room.xml --crop 10,0,4,4", 2, "expected one within the 12x8 pixels");
  expectFailure("render room.xml --resolution 65537x2", 2, "from 1 to 65536");
  expectFailure("render room.xml --seed -1", 2, "--seed");
  for (const char* option : {"--exposure", "--time-limit"})
    expectFailure(std::string("render room.xml ") + option + " nan", 2, option);
  for (const char* key : {"bsdf-fraction", "map-floor", "pilot-weight"})
    expectFailure(std::string("render room.xml --set ") + key + "=nan", 2, std::string("--set ") + key);
  expectFailure("scene", 2, "expected a command: one of");
  expectFailure("compare room.xml -o out --methods path", 2, "expected name=options");
  expectFailure("compare room.xml -o out --methods 'a=--guide-bounce 1'", 2,
                "Did you mean --set guide-bounces=...?");
  expectFailure("compare room.xml -o out --methods a=,a=", 2, "two methods");
  expectFailure("compare room.xml room.xml -o out", 2, "two scenes");
  for (const char* spp : {"0", "4,x", "4,,8", "4,8,", "8,4", "4,4", "4.5", "' '", "99999999"})
    expectFailure(std::string("compare room.xml -o out --spp ") + spp, 2, "--spp: found");
  expectFailure("compare room.xml -o out --methods a= --equal-time", 2, "there is only one");
}

// What of a scene changes the picture, is another way to the same, or changes nothing.
TEST_F(Odis, SaysWhatChangesThePicture) {
  write("words.xml", R"(<scene version="3.0.0">
  <integrator type="volpath"/>
  <sensor type="perspective"><float name="focus_distance" value="3"/>
    <film type="hdrfilm"><integer name="width" value="4"/><integer name="height" value="4"/></film>
  </sensor>
  <shape type="sphere"><bsdf type="velvet"/></shape>
  <shape type="hair"/>
  <emitter type="constant"/>
</scene>)");
  const std::string command = "render words.xml --spp 1 ";
  const std::string difference = "warning: words.xml:6:24: the bsdf 'velvet' is unknown",
                    sum = "words.xml: 2 differences change the picture\n", note = "note: words.xml:2:3: ",
                    hint = "note: words.xml:3:30: 'focus_distance' of the sensor 'perspective' has no effect";
  const struct {
    const char* option;
    bool note, hint;
  } cases[] = {{"", true, false}, {"-q", false, false}, {"-v", true, true}};
  for (const auto& c : cases) {
    const Outcome outcome = run(command + c.option);
    const auto says = [&](const std::string& text) { return outcome.text.find(text) != std::string::npos; };
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    EXPECT_TRUE(says(difference) && says(sum)) << c.option << outcome.text;
    EXPECT_EQ(says(note), c.note) << c.option << outcome.text;
    EXPECT_EQ(says(hint), c.hint) << c.option << outcome.text;
  }
  for (const std::string strict : {"render words.xml -q", "scene info words.xml",
                                   "compare words.xml -o out -q", "analyze words.xml -q"}) {
    const Outcome outcome = run(strict + " --strict");
    EXPECT_EQ(outcome.code, 3) << strict;
    EXPECT_NE(outcome.text.find("error: words.xml:6:24: the bsdf 'velvet'"), std::string::npos)
        << outcome.text;
    EXPECT_NE(outcome.text.find("error: " + sum), std::string::npos) << outcome.text;
  }
  EXPECT_EQ(run("render room.xml -q --spp 1 --strict").text, "");
}

TEST_F(Odis, BadSceneIsThreeAndLeavesNothing) {
  write("broken.xml", "<scene version=\"3.0.0\">\n  <shape type=\"sphere\">\n</scene>");
  write("number.xml",
        "<scene version=\"3.0.0\">\n  <shape type=\"sphere\"><float name=\"radius\" "
        "value=\"big\"/></shape>\n</scene>");
  expectFailure("render nowhere.xml", 3, "nowhere.xml");
  expectFailure("render broken.xml", 3, "broken.xml:");
  expectFailure("render number.xml", 3, "number.xml:2:");
  expectFailure("scene info broken.xml", 3, "broken.xml:");
  EXPECT_FALSE(exists("nowhere.exr"));
  EXPECT_FALSE(exists("broken.exr"));
  EXPECT_FALSE(exists("number.exr"));
}

TEST_F(Odis, OutputThatCannotBeWrittenIsFour) {
  expectFailure("render room.xml -o nowhere/image.exr", 4, "no such folder");
  fs::create_directory(file("folder.exr"));
  expectFailure("render room.xml -o folder.exr", 4, "is a folder");
  // Where nobody can write, root included; found out before rendering.
  expectFailure("render room.xml -o /proc/image.exr", 4, "/proc/image.exr");
  expectFailure("render room.xml --stats-json /proc/stats.json", 4, "/proc/stats.json");
  EXPECT_FALSE(exists("room.exr"));
}

TEST_F(Odis, RendersWithMetadataAndStats) {
  const Outcome outcome =
      run("render room.xml --integrator path --seed 3 --variance --aov all --stats-json s.json --stats");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("samples per pixel"), std::string::npos) << outcome.text;
  const odis::render::ExrFile image = odis::render::readExr(file("room.exr").string());
  EXPECT_EQ(image.window.width, 12);
  for (const char* channel :
       {"R", "G", "B", "variance.R", "albedo.G", "N.X", "P.Z", "depth.Z", "roughness.Y"})
    EXPECT_EQ(image.channels.count(channel), 1u) << channel;
  EXPECT_EQ(image.metadata.at("odis:seed"), "3");
  EXPECT_EQ(image.metadata.at("odis:spp"), "2");  // as the scene asks for
  EXPECT_NE(image.metadata.at("odis:commandLine").find("--seed 3"), std::string::npos);
  std::ifstream stream(file("s.json"));
  const nlohmann::json stats = nlohmann::json::parse(stream);
  EXPECT_EQ(stats.at("samples"), 12 * 8 * 2);
  EXPECT_GT(stats.at("bytes").at("peak"), 0);
  EXPECT_TRUE(stats.at("seconds").contains("guided"));
  EXPECT_GT(stats.at("processorSeconds"), 0);
}

TEST_F(Odis, CostsThatDecisionsWeighedAreInTheHeader) {
  const auto metadata = [&](const std::string& options) {
    EXPECT_EQ(run("render room.xml -q -o costs.exr --stats-json s.json " + options).code, 0) << options;
    return odis::render::readExr(file("costs.exr").string()).metadata;
  };
  EXPECT_EQ(metadata("--integrator path").count("odis:costs"), 0u);
  EXPECT_EQ(metadata("").at("odis:costs"), "guided ray 1, built cell 70, recorded ray 0.15");
  EXPECT_EQ(metadata("--set built-cell-cost=500 --set recorded-ray-cost=0").at("odis:costs"),
            "guided ray 1, built cell 500, recorded ray 0");
  std::ifstream stream(file("s.json"));
  EXPECT_EQ(nlohmann::json::parse(stream).at("costs").at("builtCell"), 500);
}

TEST_F(Odis, BenchMeasuresWhatOperationsCost) {
  const Outcome outcome = run("bench room.xml -q --json --rounds 1 --pixels 4096");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  const nlohmann::json row = nlohmann::json::parse(outcome.text).at(0);
  EXPECT_GT(row.at("guidedRayCost"), 0.0);
  EXPECT_GT(row.at("builtCellCost"), 0.0);
  EXPECT_GT(row.at("recordedRayCost"), -1.0);
  const Outcome table = run("bench room.xml room.xml -q --rounds 1 --pixels 1024");
  EXPECT_NE(table.text.find("| built cell | recorded ray |\n"), std::string::npos) << table.text;
  EXPECT_NE(table.text.find("--set built-cell-cost="), std::string::npos) << table.text;
}

TEST_F(Odis, ConstantSkyIsOneAndDefinesReachTheScene) {
  ASSERT_EQ(run("render room.xml --integrator path -D radiance=2 --crop 0,0,2,2 -o sky.exr -q").code, 0);
  const odis::render::ExrFile image = odis::render::readExr(file("sky.exr").string());
  EXPECT_EQ(image.window.width, 2);
  EXPECT_NEAR(image.channels.at("G")[0], 2.0f, 1e-4f);
}

TEST_F(Odis, MetricsAndMontage) {
  ASSERT_EQ(run("render room.xml --integrator path -o a.exr -q").code, 0);
  ASSERT_EQ(run("render room.xml --integrator path --resolution 6x4 -o b.exr -q").code, 0);
  const Outcome same = run("metrics a.exr a.exr --json");
  ASSERT_EQ(same.code, 0) << same.text;
  EXPECT_EQ(nlohmann::json::parse(same.text).at("relMse"), 0.0);
  expectFailure("metrics a.exr b.exr", 3, "one size");
  expectFailure("metrics a.exr missing.exr", 3, "missing.exr");
  expectFailure("metrics a.exr room.xml", 3, "room.xml");
  expectFailure("montage room.xml -o both.png", 3, "room.xml");
  expectFailure("compare room.xml -o out --reference room.xml", 3, "room.xml");
  expectFailure("compare room.xml -o out --reference b.exr -q", 3, "is 6 x 4");
  EXPECT_EQ(run("montage a.exr b.exr -o both.png").code, 0);
  // The layers of other programs: Blender's, one of any name, two of which one has to be named.
  ASSERT_EQ(run("image merge ViewLayer.Combined=a.exr -o blender.exr").code, 0);
  ASSERT_EQ(run("image merge beauty=a.exr -o beauty.exr").code, 0);
  ASSERT_EQ(run("image merge one=a.exr two=b2.exr -o two.exr").code, 3);
  ASSERT_EQ(run("render room.xml --integrator path --seed 1 -o c.exr -q").code, 0);
  ASSERT_EQ(run("image merge one=a.exr two=c.exr -o two.exr").code, 0);
  for (const char* images : {"blender.exr a.exr", "a.exr blender.exr", "beauty.exr blender.exr",
                             "two.exr a.exr --layer one", "a.exr two.exr --reference-layer one"}) {
    const Outcome outcome = run(std::string("metrics --json ") + images);
    EXPECT_EQ(outcome.code, 0) << images << outcome.text;
    EXPECT_EQ(nlohmann::json::parse(outcome.text).at("relMse"), 0.0) << images;
  }
  expectFailure("metrics two.exr a.exr", 3, "two.exr: no layer \"\" with R, G and B");
  EXPECT_EQ(run("montage blender.exr beauty.exr -o both.png").code, 0);
  EXPECT_EQ(run("image convert blender.exr -o blender.png").code, 0);
  EXPECT_EQ(run("compare room.xml -o out --seeds 1 --reference blender.exr -q").code, 0);
  EXPECT_TRUE(exists("both.png"));
}

TEST_F(Odis, InspectsAPlace) {
  const Outcome outcome = run("inspect room.xml --pixel 6,4 -o cell.png --json cell.json --paths 1 -q");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("vertex 1 of pixel 6,4"), std::string::npos) << outcome.text;
  EXPECT_TRUE(exists("cell.png"));
  std::ifstream stream(file("cell.json"));
  EXPECT_EQ(nlohmann::json::parse(stream).at("vertex").at("depth"), 1);
  ASSERT_EQ(run("inspect room.xml --point 0,0,3 --paths 1 -o cell.exr -q").code, 0);
  EXPECT_EQ(odis::render::readExr(file("cell.exr").string()).window.width, 1408);
  expectFailure("inspect room.xml", 2, "expected --pixel x,y or --point x,y,z");
  expectFailure("inspect room.xml --pixel 6", 2, "expected x,y, each a whole number");
  expectFailure("inspect room.xml --pixel 6,4.5", 2, "whole number");
  expectFailure("inspect room.xml --pixel 12,4", 2, "12,4 is outside of the image, expected x from 0 to 11");
  expectFailure("inspect room.xml --pixel 0,0", 2, "meets nothing that may be guided");
  expectFailure("inspect room.xml --point 0,0,nan", 2, "expected x,y,z, each a number");
  expectFailure("inspect room.xml --point 50,0,3 -q", 2, "the nearest place that it saw");
  expectFailure("inspect room.xml --pixel 6,4 --integrator path", 2, "--integrator odis");
}

TEST_F(Odis, InspectsWhatAHostSaved) {
  const std::string saved = ODIS_SOURCE "/fuzz/corpus/saved/";
  const Outcome guide = run("inspect '" + saved + "guide' --point 0.5,0.5,0 -o cell.png --json cell.json");
  ASSERT_EQ(guide.code, 0) << guide.text;
  EXPECT_NE(guide.text.find("guide: a guide"), std::string::npos) << guide.text;
  EXPECT_TRUE(exists("cell.png"));
  std::ifstream stream(file("cell.json"));
  EXPECT_EQ(nlohmann::json::parse(stream).at("cell").at("map").at("side"), 16);
  ASSERT_EQ(run("inspect '" + saved + "guide' -o sheet.exr").code, 0);
  EXPECT_EQ(odis::render::readExr(file("sheet.exr").string()).window.width, 8 + 8 * 104);
  ASSERT_EQ(run("inspect '" + saved + "frame-guided' -o frame.exr").code, 0);
  const odis::render::ExrFile image = odis::render::readExr(file("frame.exr").string());
  EXPECT_EQ(image.window.width, 4);
  EXPECT_EQ(image.channels.at("G")[5], 1);
  EXPECT_NE(run("inspect '" + saved + "vertices'").text.find("by depth"), std::string::npos);
}

TEST_F(Odis, ImageTools) {
  ASSERT_EQ(run("render room.xml --integrator path -o a.exr --aov albedo -q").code, 0);
  ASSERT_EQ(run("render room.xml --integrator path --seed 1 -o b.exr --aov albedo -q").code, 0);
  const Outcome info = run("image info a.exr b.exr");
  EXPECT_EQ(info.code, 0) << info.text;
  for (const char* text : {"a.exr: 12 x 8 pixels", "albedo.R", "odis:seed: 1"})
    EXPECT_NE(info.text.find(text), std::string::npos) << info.text;
  EXPECT_EQ(run("image convert a.exr -o a.png --layer albedo --exposure 1").code, 0);
  EXPECT_EQ(run("image convert a.png -o back.exr").code, 0);
  EXPECT_EQ(run("image diff a.exr b.exr -o d.exr --kind signed").code, 0);
  for (const char* kind : {"signed", "absolute", "relative", "flip"})
    EXPECT_EQ(run(std::string("image diff a.exr b.exr -o d.png --kind ") + kind).code, 0) << kind;
  EXPECT_NE(run("image diff a.exr b.exr -o e.exr").text.find(" of 96 pixels differ\n"), std::string::npos);
  for (const char* output : {"e.exr", "e.png"})
    EXPECT_EQ(run(std::string("image diff a.exr a.exr -o ") + output).text, "the images are equal\n")
        << output;
  EXPECT_EQ(run("image average a.exr b.exr -o mean.exr").code, 0);
  EXPECT_EQ(run("image merge a.exr other=b.exr mean=mean.exr -o all.exr").code, 0);
  const odis::render::ExrFile all = odis::render::readExr(file("all.exr").string());
  const odis::render::ExrFile difference = odis::render::readExr(file("d.exr").string());
  for (size_t i = 0; i < all.channels.at("R").size(); ++i) {
    const float a = all.channels.at("R")[i], b = all.channels.at("other.R")[i];
    EXPECT_FLOAT_EQ(all.channels.at("mean.R")[i], (a + b) / 2);
    EXPECT_FLOAT_EQ(difference.channels.at("R")[i], a - b);
  }
  expectFailure("image", 2, "expected a command: one of");
  expectFailure("image info", 2, "IMAGES");
  expectFailure("image info nowhere.exr", 3, "nowhere.exr");
  expectFailure("image convert a.exr -o a.jpg", 2, "expected a name that ends in .png or .exr");
  expectFailure("image convert a.exr -o c.png --layer depth", 3, "no layer \"depth\"");
  expectFailure("image diff a.exr -o d.png", 2, "IMAGES");
  expectFailure("image merge a.exr b.exr -o c.exr", 3, "name one of them");
  ASSERT_EQ(run("render room.xml --integrator path --resolution 6x4 -o small.exr -q").code, 0);
  expectFailure("image average a.exr small.exr -o c.exr", 3, "one size");
  expectFailure("image diff a.exr small.exr -o d.exr", 3, "differ in size");
  EXPECT_FALSE(exists("c.exr"));
}

TEST_F(Odis, ComparesAndResumes) {
  const std::string arguments =
      "compare room.xml -o out --spp 2,4 --seeds 2 --reference-spp 16 --images -q --equal-time";
  const Outcome first = run(arguments);
  ASSERT_EQ(first.code, 0) << first.text;
  EXPECT_NE(first.text.find("| room"), std::string::npos) << first.text;
  EXPECT_TRUE(exists("out/comparison.md"));
  EXPECT_TRUE(exists("out/report.html"));
  EXPECT_TRUE(exists("out/images/room-2.png"));
  EXPECT_TRUE(exists("out/images/room-4.png"));
  const Outcome second = run(arguments);
  EXPECT_EQ(second.text, first.text);  // times too: nothing was rendered again

  std::ifstream stream(file("out/comparison.json"));
  const nlohmann::json json = nlohmann::json::parse(stream);
  // Seeds, samples; odis also at equal time, where a sample fits.
  const size_t rows = json.at("rows").size();
  EXPECT_EQ(json.at("runs").size(), 2 * rows);
  EXPECT_GE(rows, 2u * 2);
  EXPECT_LE(rows, 2u * (2 + 1));
  // Where as many samples fit, nothing is rendered again.
  std::set<std::string> images;
  for (const auto& run : json.at("runs"))
    if (run.at("seed") == 0) images.insert(run.at("method").get<std::string>() + run.at("samples").dump());
  size_t rendered = 0;
  for (const auto& entry : std::filesystem::directory_iterator(file("out/images")))
    rendered += entry.path().extension() == ".exr";
  EXPECT_EQ(rendered, images.size());
  EXPECT_NE(json.at("command").get<std::string>().find("--spp 2,4"), std::string::npos);
  const auto& scene = json.at("scenes").at(0);
  EXPECT_TRUE(exists(scene.at("reference")));
  EXPECT_GT(scene.at("referenceError").at("relMse"), 0);
  for (const auto& run : json.at("runs")) {
    EXPECT_GE(run.at("cpuSeconds"), 0);
    EXPECT_GT(run.at("rays"), 0);
    EXPECT_EQ(run.at("method") == "odis" || !run.at("equalTime"), true);
    if (run.at("seed") == 0) EXPECT_TRUE(exists("out/" + run.at("image").get<std::string>()));
  }
}

TEST_F(Odis, ComparesWithinOneHundredColumns) {
  const std::string arguments = "compare room.xml -o out --seeds 3 --reference-spp 16 -q --equal-time";
  const auto widest = [](const std::string& text) {
    std::istringstream lines(text);
    size_t most = 0;
    for (std::string line; std::getline(lines, line);) most = std::max(most, line.size());
    return most;
  };
  const Outcome narrow = run(arguments), wide = run(arguments + " --wide");
  EXPECT_EQ(narrow.code, 0) << narrow.text;
  EXPECT_LE(widest(narrow.text), 100u) << narrow.text;
  EXPECT_GT(widest(wide.text), 100u) << wide.text;
  EXPECT_EQ(runShell("cat out/comparison.md").text, wide.text);
  // The time that it may take comes before the first picture.
  const Outcome told =
      runShell("'" ODIS_COMMAND
               "' compare room.xml -o long --reference-spp 16777216 2> told & "
               "while ! grep -q about told && kill -0 $!; do sleep .1; done; kill -KILL $!; wait; cat told");
  EXPECT_NE(told.text.find("renderings, about "), std::string::npos) << told.text;
}

TEST_F(Odis, AnalyzesVariance) {
  const Outcome table = run("analyze room.xml --spp 2 --reference-spp 4 --resolution 12x8 -q -o split.json");
  ASSERT_EQ(table.code, 0) << table.text;
  EXPECT_EQ(table.text.rfind("| room, 12 x 8: % of the variance | path | odis |", 0), 0u) << table.text;
  std::ifstream stream(file("split.json"));
  const nlohmann::json json = nlohmann::json::parse(stream);
  const nlohmann::json& scene = json.at("scenes").at(0);
  EXPECT_EQ(scene.at("scene"), "room");
  ASSERT_EQ(scene.at("methods").size(), 2u);
  EXPECT_GT(scene.at("methods").at(1).at("variance"), 0.0);
  EXPECT_EQ(scene.at("methods").at(0).at("shares").at(0).at("cause"), "pixel and lens");
  // Of several scenes, a table a method as well.
  write("other.xml", "<scene version=\"3.0.0\"><emitter type=\"constant\"/></scene>");
  const Outcome both = run("analyze room.xml other.xml --spp 2 --reference-spp 4 --pixels 64 -q");
  EXPECT_EQ(both.code, 0) << both.text;
  EXPECT_NE(both.text.find("| path: % of the variance | pixel, lens |"), std::string::npos) << both.text;
  EXPECT_NE(both.text.find("\n| mean |"), std::string::npos) << both.text;
  expectFailure("analyze room.xml --methods restir=--integrator\\ restir", 2, "made of many paths");
  expectFailure("analyze room.xml -o split.txt", 2, "expected a name that ends in .json");
}

// A comparison that was cut off after some results, the last of them half written, ends as one that was not:
// only what is missing is rendered.
TEST_F(Odis, InterruptedComparisonGoesOn) {
  const std::string arguments = "compare room.xml -o out --spp 2,4 --seeds 3 --reference-spp 16";
  ASSERT_EQ(run(arguments).code, 0);
  std::vector<std::string> lines;
  std::ifstream whole(file("out/results.jsonl"));
  for (std::string line; std::getline(whole, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 12u);
  std::string kept;
  for (size_t i = 0; i < 5; ++i) kept += lines[i] + "\n";
  write("out/results.jsonl", kept + lines[5].substr(0, 40) + "\n");

  const Outcome resumed = run(arguments);
  ASSERT_EQ(resumed.code, 0) << resumed.text;
  std::vector<nlohmann::json> after;
  std::ifstream stream(file("out/results.jsonl"));
  for (std::string line; std::getline(stream, line);)
    if (nlohmann::json::accept(line)) after.push_back(nlohmann::json::parse(line));
  ASSERT_EQ(after.size(), 12u);
  for (size_t i = 0; i < after.size(); ++i) {
    const nlohmann::json before = nlohmann::json::parse(lines[i]);
    EXPECT_EQ(after[i].at("key"), before.at("key")) << i;
    EXPECT_EQ(after[i].at("relMse"), before.at("relMse")) << i;  // the same bits
    if (i < 5) EXPECT_EQ(after[i], before) << i;                 // not rendered again
  }
  // An image that was lost is rendered again, too.
  fs::remove_all(file("out/images"));
  ASSERT_EQ(run(arguments).code, 0);
  EXPECT_TRUE(exists("out/" + after[0].at("image").get<std::string>()));
}

// Results of the first scene are those of the second, which is the same, by the second one's name.
TEST_F(Odis, ScenesOfTheSameContentCanBeCompared) {
  fs::create_directories(file("hall"));
  fs::copy_file(file("room.xml"), file("hall/scene.xml"));
  const Outcome outcome =
      run("compare room.xml hall/scene.xml -o out --spp 2 --seeds 1 --reference-spp 16 --equal-time");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("hall"), std::string::npos) << outcome.text;
  std::ifstream stream(file("out/comparison.json"));
  const nlohmann::json json = nlohmann::json::parse(stream);
  std::map<std::string, int> rows;
  for (const nlohmann::json& row : json.at("rows")) ++rows[row.at("scene")];
  EXPECT_GT(rows["room"], 0);
  EXPECT_EQ(rows["hall"], rows["room"]);
}

// The script behind `make bench`: what it leaves, and what of a page it replaces.
TEST_F(Odis, BenchWritesReportAndTables) {
  fs::create_directories(file("scenes/hall"));
  fs::rename(file("room.xml"), file("scenes/hall/scene.xml"));
  write("page.md", "before\n<!-- bench:begin -->\nold\n<!-- bench:end -->\nafter\n");
  const std::string bench = "SPP=2,4 SEEDS=2 PIXELS=96 REFERENCE_SPP=8 PAGE=page.md '" ODIS_SOURCE
                            "/scripts/bench' '" ODIS_COMMAND "' scenes out 2>&1";
  for (int round = 0; round < 2; ++round) {  // the second replaces what the first wrote
    const Outcome outcome = runShell(bench);
    ASSERT_EQ(outcome.code, 0) << outcome.text;
    std::ifstream stream(file("page.md"));
    const std::string page{std::istreambuf_iterator<char>(stream), {}};
    EXPECT_EQ(page.rfind("before\n<!-- bench:begin -->\n", 0), 0u) << page;
    EXPECT_NE(page.find("\n<!-- bench:end -->\nafter\n"), std::string::npos) << page;
    EXPECT_EQ(page.find("old"), std::string::npos) << page;
    const size_t row = page.find("| hall ");
    EXPECT_NE(row, std::string::npos) << page;
    const std::regex moreSamples(R"(\| hall +\| \w+ +\| +4 \|)");
    EXPECT_FALSE(std::regex_search(page, moreSamples)) << page;  // the fewest samples only
    size_t rows = 0;
    for (size_t at = row; at != std::string::npos; at = page.find("| hall ", at + 1)) ++rows;
    // Of five methods, of as many of the other four as have time for a sample, and of the reference.
    EXPECT_GE(rows, 6u) << page;
    EXPECT_LE(rows, 10u) << page;
  }
  EXPECT_TRUE(exists("out/report.html"));
  EXPECT_TRUE(exists("out/results.md"));
  EXPECT_TRUE(exists("out/images/hall-2.png"));
  EXPECT_FALSE(exists("out/tables.part"));
  write("page.md", "no markers\n");
  EXPECT_EQ(runShell(bench).code, 2);
  EXPECT_EQ(runShell("'" ODIS_SOURCE "/scripts/bench' '" ODIS_COMMAND "' nowhere out").code, 2);
}

// Lines that stay, as in a log, come every ten seconds at most: what is done sooner has one for its end, or
// none.
TEST_F(Odis, ProgressTakesFewLinesWithoutATerminal) {
  const auto expectLines = [&](const std::string& arguments, size_t atTheEnd) {
    const auto start = std::chrono::steady_clock::now();
    const Outcome outcome = runShell("'" ODIS_COMMAND "' " + arguments + " >out.txt 2>err.txt; cat err.txt");
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    EXPECT_EQ(outcome.text.find('\r'), std::string::npos);
    const auto lines = size_t(std::count(outcome.text.begin(), outcome.text.end(), '\n'));
    EXPECT_LE(lines, atTheEnd + size_t(seconds.count() / 10)) << outcome.text;
  };
  expectLines("render room.xml --spp 500", 1);  // what is written
  expectLines("analyze room.xml --spp 4 --image-spp 4 --reference-spp 16", 0);
  expectLines("compare room.xml -o out --spp 2 --seeds 2 --reference-spp 16", 1);  // where the report is
}

}  // namespace
