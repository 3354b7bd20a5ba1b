// `odis render --denoise` and `odis denoise`.
#include <nlohmann/json.hpp>

#include "command_runner.h"
#include "render/image/write.h"
#include "support/denoiser.h"

namespace {

using odis::render::ExrFile;
using odis::render::readExr;
using odis::test::Outcome;

class Denoising : public odis::test::Odis {
 protected:
  ExrFile image(const std::string& name) const { return readExr(file(name).string()); }
  std::string text(const std::string& name) const {
    std::ifstream stream(file(name));
    return {std::istreambuf_iterator<char>(stream), {}};
  }
};

TEST_F(Denoising, WithoutALibraryNothingIsRendered) {
  write("old.exr", "old");
  const Outcome outcome =
      runShell("ODIS_OIDN=nowhere/lib.so '" ODIS_COMMAND "' render room.xml -q --denoise -o old.exr");
  EXPECT_EQ(outcome.code, 5) << outcome.text;
  EXPECT_NE(outcome.text.find("error: ODIS_OIDN: nowhere/lib.so: cannot open"), std::string::npos)
      << outcome.text;
  EXPECT_EQ(text("old.exr"), "old");
  // Whoever doesn't denoise needs no library.
  EXPECT_EQ(runShell("ODIS_OIDN=nowhere/lib.so '" ODIS_COMMAND "' render room.xml -q -o i.exr").code, 0);
}

TEST_F(Denoising, SaysWhereItLookedForTheLibrary) {
  const Outcome outcome =
      runShell("env -u ODIS_OIDN -u VIRTUAL_ENV XDG_DATA_HOME=\"$PWD/none\" '" ODIS_COMMAND
               "' render room.xml -q --denoise -o i.exr");
  if (outcome.code == 0) GTEST_SKIP() << "the system has Open Image Denoise";
  EXPECT_EQ(outcome.code, 5) << outcome.text;
  for (const char* part : {"`scripts/setup --denoise` installs it", "set ODIS_OIDN",
                           "libOpenImageDenoise.so.2", "VIRTUAL_ENV (not set)", "none/odis/denoise"})
    EXPECT_NE(outcome.text.find(part), std::string::npos) << part << "\n" << outcome.text;
  EXPECT_FALSE(exists("i.exr"));
}

TEST_F(Denoising, ChangesNothingOfTheSamples) {
  ODIS_NEEDS_DENOISER();
  for (const std::string integrator : {"path", "odis", "restir"}) {
    const std::string options = "render room.xml -q --spp 4 --film pixels --integrator " + integrator;
    ASSERT_EQ(run(options + " -o plain.exr").code, 0);
    const Outcome outcome =
        run(options + " -o denoised.exr --denoise --png look.png --stats-json stats.json");
    ASSERT_EQ(outcome.code, 0) << outcome.text;
    const ExrFile plain = image("plain.exr"), denoised = image("denoised.exr");
    for (const std::string channel : {"R", "G", "B"}) {
      EXPECT_EQ(plain.channels.at(channel), denoised.channels.at("noisy." + channel)) << integrator;
      EXPECT_NE(plain.channels.at(channel), denoised.channels.at(channel)) << integrator;
    }
    EXPECT_EQ(plain.channels.count("noisy.R"), 0u);
    EXPECT_EQ(plain.metadata.count("odis:denoiser"), 0u);
    EXPECT_TRUE(denoised.metadata.at("odis:denoiser").starts_with("Open Image Denoise "));
    EXPECT_EQ(denoised.metadata.at("odis:denoiserAuxiliaries"), "albedo and normal, clean");
    EXPECT_EQ(denoised.channels.count("albedo.R"), 1u);
    const std::string stats = text("stats.json");
    EXPECT_NE(stats.find("\"denoiser\": \"Open Image Denoise "), std::string::npos) << stats;
    EXPECT_NE(stats.find("\"auxiliaries\": \""), std::string::npos) << stats;
    EXPECT_TRUE(exists("look.png"));
  }
}

TEST_F(Denoising, OfAFileComesToTheSameBits) {
  ODIS_NEEDS_DENOISER();
  const std::string render = "render room.xml -q --spp 4 --crop 2,1,8,6 ";
  ASSERT_EQ(run(render + "--denoise --aov depth -o at-once.exr --threads 1").code, 0);
  ASSERT_EQ(run("denoise at-once.exr -q -o later.exr --threads 2").code, 0);
  ASSERT_EQ(run("denoise later.exr -q -o again.exr").code, 0);
  const ExrFile atOnce = image("at-once.exr"), later = image("later.exr"), again = image("again.exr");
  EXPECT_EQ(later.window.x, 2);
  EXPECT_EQ(later.window.fullWidth, 12);
  for (const std::string channel : {"R", "G", "B", "noisy.R", "noisy.G", "noisy.B"}) {
    EXPECT_EQ(atOnce.channels.at(channel), later.channels.at(channel)) << channel;
    EXPECT_EQ(atOnce.channels.at(channel), again.channels.at(channel)) << channel;
  }
  EXPECT_EQ(later.channels.at("depth.Z"), atOnce.channels.at("depth.Z"));
  EXPECT_EQ(later.metadata.at("odis:seed"), "0");
  EXPECT_EQ(later.metadata.at("odis:secondsAuxiliaries"), atOnce.metadata.at("odis:secondsAuxiliaries"));
  EXPECT_EQ(later.metadata.at("odis:denoiserAuxiliaries"), "albedo and normal, clean");
  // Features of the image's own few samples are denoised first.
  ASSERT_EQ(run(render + "--aov albedo,normal -o plain.exr").code, 0);
  ASSERT_EQ(run("denoise plain.exr -q -o plain-denoised.exr").code, 0);
  EXPECT_EQ(image("plain-denoised.exr").metadata.at("odis:denoiserAuxiliaries"),
            "albedo and normal, prefiltered");
}

// Neighbours share their noise on a film that splats, which is the default without --denoise only.
TEST_F(Denoising, WarnsOfSplattedImages) {
  ODIS_NEEDS_DENOISER();
  ASSERT_EQ(run("render room.xml -q --denoise -o denoised.exr").code, 0);
  EXPECT_EQ(image("denoised.exr").metadata.at("odis:film"), "pixels");
  ASSERT_EQ(run("render room.xml -q -o splat.exr").code, 0);
  ASSERT_EQ(run("render room.xml -q --film pixels -o pixels.exr").code, 0);
  const Outcome splatted = run("denoise splat.exr -o a.exr"), apart = run("denoise pixels.exr -o b.exr");
  EXPECT_EQ(splatted.code, 0);
  EXPECT_NE(splatted.text.find("warning: splat.exr: was splatted"), std::string::npos) << splatted.text;
  EXPECT_EQ(apart.text.find("splatted"), std::string::npos) << apart.text;
  const Outcome both = run("render room.xml --denoise --film splat -o c.exr");
  EXPECT_EQ(both.code, 0);
  EXPECT_NE(both.text.find("warning: --film splat"), std::string::npos) << both.text;
}

TEST_F(Denoising, TakesLayersOfOtherFiles) {
  ODIS_NEEDS_DENOISER();
  ASSERT_EQ(run("render room.xml -q --spp 4 --aov albedo,normal -o all.exr").code, 0);
  ASSERT_EQ(run("image convert all.exr --layer albedo -o albedo.exr").code, 0);
  ASSERT_EQ(run("image merge beauty=all.exr -o renamed.exr").code, 0);
  ASSERT_EQ(run("render room.xml -q --spp 4 -o plain.exr").code, 0);
  ASSERT_EQ(run("denoise all.exr -q -o expected.exr").code, 0);
  ASSERT_EQ(run("denoise plain.exr -q --albedo albedo.exr --normal all.exr -o a.exr").code, 0);
  ASSERT_EQ(run("denoise renamed.exr -q --layer beauty -o b.exr").code, 0);
  const std::vector<float> expected = image("expected.exr").channels.at("R");
  EXPECT_EQ(image("a.exr").channels.at("R"), expected);
  EXPECT_EQ(image("b.exr").channels.at("beauty.R"), expected);  // in its place

  const Outcome alone = run("denoise plain.exr -o c.exr");
  EXPECT_EQ(alone.code, 0);
  EXPECT_NE(alone.text.find("warning: plain.exr: found no albedo"), std::string::npos) << alone.text;
  EXPECT_EQ(image("c.exr").metadata.at("odis:denoiserAuxiliaries"), "none");
  ASSERT_EQ(run("denoise all.exr -q --aux none -o d.exr").code, 0);
  EXPECT_EQ(image("d.exr").channels.at("R"), image("c.exr").channels.at("R"));
}

// Transparency, and whatever else there is, stays as it was.
TEST_F(Denoising, KeepsOtherChannels) {
  ODIS_NEEDS_DENOISER();
  std::vector<float> alpha, color;
  for (int i = 0; i < 96; ++i) alpha.push_back(float(i % 3) / 2), color.push_back(float(i % 7));
  odis::render::writeExr(file("in.exr").string(), {12, 8, 0, 0, 12, 8},
                         {{"A", alpha.data()}, {"R", color.data()}, {"G", color.data()}, {"B", color.data()}},
                         {});
  ASSERT_EQ(run("denoise in.exr -q -o out.exr --png out.png").code, 0);
  EXPECT_EQ(image("out.exr").channels.at("A"), alpha);
  EXPECT_EQ(image("out.exr").channels.at("noisy.G"), color);
  EXPECT_TRUE(exists("out.png"));
}

TEST_F(Denoising, MakesThreeChannelsOfOne) {
  ODIS_NEEDS_DENOISER();
  std::vector<float> grey;
  for (int i = 0; i < 96; ++i) grey.push_back(float(i % 7));
  odis::render::writeExr(file("in.exr").string(), {12, 8, 0, 0, 12, 8}, {{"Y", grey.data()}}, {});
  ASSERT_EQ(run("denoise in.exr -q -o out.exr").code, 0);
  const ExrFile out = image("out.exr");
  EXPECT_EQ(out.channels.count("Y"), 0u);
  EXPECT_EQ(out.channels.at("noisy.R"), grey);
  EXPECT_NE(out.channels.at("R"), grey);
  EXPECT_EQ(out.channels.at("R"), out.channels.at("B"));
}

TEST_F(Denoising, ComparisonsMeasureBoth) {
  ODIS_NEEDS_DENOISER();
  const std::string compare =
      "compare room.xml -o out --denoise --spp 1,4 --seeds 2 --reference-spp 64 --images -q --methods "
      "'path=--integrator path,restir=--integrator restir'";
  const Outcome outcome = run(compare);
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("The same images denoised:"), std::string::npos) << outcome.text;
  EXPECT_TRUE(exists("out/images/room-4.png") && exists("out/images/room-4-denoised.png"));

  const auto json = nlohmann::json::parse(text("out/comparison.json"));
  EXPECT_TRUE(json.at("denoiser").get<std::string>().starts_with("Open Image Denoise"));
  ASSERT_EQ(json.at("rows").size(), 8u);
  ASSERT_EQ(json.at("runs").size(), 16u);
  for (const auto& row : json.at("rows")) {
    const bool denoised = row.at("denoised");
    EXPECT_EQ(row.at("image").get<std::string>().find("-denoised-") != std::string::npos, denoised) << row;
    EXPECT_TRUE(exists("out/" + row.at("image").get<std::string>())) << row;
    EXPECT_GT(row.at("ssim"), 0) << row;
  }
  const std::string page = text("out/report.html");
  EXPECT_NE(page.find("\"denoised\":true"), std::string::npos);

  // Going on renders nothing again: times stay.
  ASSERT_EQ(run(compare).code, 0);
  EXPECT_EQ(nlohmann::json::parse(text("out/comparison.json")).at("runs"), json.at("runs"));
  // Without the denoiser the same results are half of them.
  ASSERT_EQ(run("compare room.xml -o out --spp 1,4 --seeds 2 --reference-spp 64 -q --methods "
                "'path=--integrator path,restir=--integrator restir'")
                .code,
            0);
  const auto plain = nlohmann::json::parse(text("out/comparison.json"));
  EXPECT_EQ(plain.at("runs").size(), 8u);
  EXPECT_EQ(plain.at("runs").at(0), json.at("runs").at(0));
  EXPECT_TRUE(plain.at("denoiser").is_null());
}

TEST_F(Denoising, ComparisonsNeedTheLibraryFirst) {
  const Outcome outcome =
      runShell("ODIS_OIDN=nowhere/lib.so '" ODIS_COMMAND "' compare room.xml -o out --denoise -q");
  EXPECT_EQ(outcome.code, 5) << outcome.text;
  EXPECT_FALSE(exists("out"));
}

}  // namespace
