// `odis render --film`.
#include <nlohmann/json.hpp>

#include "command_runner.h"
#include "render/image/write.h"

namespace {

using odis::render::ExrFile;
using odis::render::readExr;
using odis::test::Outcome;

class Film : public odis::test::Odis {
 protected:
  void SetUp() override {
    Odis::SetUp();
    for (const char* filter : {"box", "gaussian"}) writeScene(std::string(filter) + ".xml", filter);
  }
  void writeScene(const std::string& name, const std::string& filter) const {
    write(name,
          "<scene version=\"3.0.0\"><sensor type=\"perspective\"><film type=\"hdrfilm\"><integer "
          "name=\"width\" value=\"40\"/><integer name=\"height\" value=\"30\"/><rfilter type=\"" +
              filter +
              "\"/></film></sensor><shape type=\"sphere\"><point name=\"center\" x=\"0\" y=\"0\" "
              "z=\"4\"/></shape><emitter type=\"constant\"/></scene>");
  }
  ExrFile image(const std::string& name) const { return readExr(file(name).string()); }
};

TEST_F(Film, SaysWhichItIs) {
  ASSERT_EQ(run("render gaussian.xml -q -o a.exr --stats-json a.json").code, 0);
  ASSERT_EQ(run("render gaussian.xml -q --film pixels -o b.exr").code, 0);
  ASSERT_EQ(run("render box.xml -q --film splat -o c.exr").code, 0);
  EXPECT_EQ(image("a.exr").metadata.at("odis:film"), "splat");
  EXPECT_EQ(image("b.exr").metadata.at("odis:film"), "pixels");
  EXPECT_EQ(image("c.exr").metadata.at("odis:film"), "pixels");  // the same thing
  EXPECT_NE(image("a.exr").channels.at("R"), image("b.exr").channels.at("R"));
  std::ifstream stats(file("a.json"));
  EXPECT_EQ(nlohmann::json::parse(stats).at("film"), "splat");
  expectFailure("render gaussian.xml --film box -o d.exr", 2, "--film");
}

TEST_F(Film, BoxesAreTheSameEitherWay) {
  for (const char* integrator : {"path", "odis"}) {
    const std::string options = std::string("render box.xml -q --spp 6 --aov all --integrator ") + integrator;
    ASSERT_EQ(run(options + " --film splat -o a.exr").code, 0);
    ASSERT_EQ(run(options + " --film pixels -o b.exr").code, 0);
    EXPECT_EQ(image("a.exr").channels, image("b.exr").channels) << integrator;
  }
}

TEST_F(Film, WideFiltersAreDrawnFrom) {
  write("wide.xml",
        "<scene version=\"3.0.0\"><sensor type=\"perspective\"><film type=\"hdrfilm\"><integer "
        "name=\"width\" value=\"40\"/><integer name=\"height\" value=\"30\"/><rfilter "
        "type=\"gaussian\"><float name=\"stddev\" value=\"5\"/></rfilter></film></sensor>"
        "<emitter type=\"constant\"/></scene>");
  const Outcome outcome = run("render wide.xml -o a.exr");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.text.find("note: --film splat: the filter reaches over 20 pixels, more than 16"),
            std::string::npos)
      << outcome.text;
  EXPECT_EQ(image("a.exr").metadata.at("odis:film"), "pixels");
}

TEST_F(Film, ReplayedPathsArePartsOfTheImage) {
  const Outcome splat = run("render gaussian.xml --spp 1 --set pilot-spp=1 --replay 20,15,0"),
                pixels = run("render gaussian.xml --spp 1 --set pilot-spp=1 --film pixels --replay 20,15,0");
  EXPECT_EQ(splat.code, 0) << splat.text;
  EXPECT_EQ(pixels.code, 0) << pixels.text;
  EXPECT_NE(splat.text, pixels.text);  // other places in the pixel
}

TEST_F(Film, ComparesWithBoth) {
  ASSERT_EQ(run("compare gaussian.xml -o out -q --spp 4 --seeds 1 --reference-spp 64 --methods "
                "'splat=--integrator path --film splat,pixels=--integrator path'")
                .code,
            0);
  std::ifstream stream(file("out/comparison.json"));
  const auto json = nlohmann::json::parse(stream);
  EXPECT_LT(json.at("rows").at(0).at("relMse"), json.at("rows").at(1).at("relMse"));
}

TEST_F(Film, IsRefusedWhereNoImageIsMade) {
  expectFailure("analyze gaussian.xml --methods 'a=--film splat'", 2, "--film splat: has no effect");
  expectFailure("inspect gaussian.xml --pixel 20,15 --film splat", 2, "--film: has no effect");
}

}  // namespace
