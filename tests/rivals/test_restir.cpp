// Resampling has the expectation of path tracing, and repeats to the bit.
#include "render/rivals/restir.h"

#include "rivals/rival_test.h"

namespace odis::render {
namespace {

class RestirUnbiased : public RivalTest {};

constexpr int kRestirTests = 9;

// Neighbours from all over these small images, near ones, and none at all.
TEST_F(RestirUnbiased, AgreesWithPath) {
  for (const auto& [neighbours, radius] : {std::pair(4, 6.0f), std::pair(1, 2.0f), std::pair(0, 6.0f)}) {
    RenderOptions o = options(IntegratorKind::restir);
    o.restir.neighbours = neighbours;
    o.restir.radius = radius;
    expectAgreement(o, kRestirTests);
  }
}

// Plates that stand upright on a floor, glossy and matt by turns: neighbours often don't see what a pixel's
// sample lies on. A large lamp and the sky are found as often by directions as by next-event estimation.
TEST_F(RestirUnbiased, PlatesUnderALargeLamp) {
  std::string text = test::sensor("origin=\"0.6,2.4,2.2\" target=\"0,0.1,0\" up=\"0,1,0\"", 40, 16, 16);
  const auto rectangle = [](const std::string& transform, const std::string& inside) {
    return "<shape type=\"rectangle\"><transform name=\"to_world\">" + transform + "</transform>" + inside +
           "</shape>";
  };
  const std::string matt =
      "<bsdf type=\"twosided\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" "
      "value=\"0.8\"/></bsdf></bsdf>";
  const std::string glossy =
      "<bsdf type=\"twosided\"><bsdf type=\"roughconductor\"><string name=\"material\" value=\"Al\"/><float "
      "name=\"alpha\" value=\"0.3\"/></bsdf></bsdf>";
  text += rectangle("<scale value=\"1.5\"/><rotate x=\"1\" angle=\"-90\"/>", matt);
  for (int i = -3; i <= 3; ++i)
    text += rectangle(
        "<scale x=\"0.9\" y=\"0.25\"/><translate y=\"0.25\" z=\"" + std::to_string(0.22 * i) + "\"/>",
        i % 2 ? glossy : matt);
  text += rectangle(
      "<scale value=\"0.8\"/><rotate x=\"1\" angle=\"90\"/><translate x=\"-1\" y=\"1.5\"/>",
      "<bsdf type=\"diffuse\"/><emitter type=\"area\"><rgb name=\"radiance\" value=\"4\"/></emitter>");
  text += "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"0.3\"/></emitter>";
  const auto scene = test::loadScene(text);
  RenderOptions o = options(IntegratorKind::path);
  o.spp = 64;
  const test::PixelStatistics path = test::renderSeeds(*scene, o, 96, 1000);
  o.integrator = IntegratorKind::restir;
  o.restir.radius = 4;
  o.spp = 10;
  test::expectSameExpectation(path, test::renderSeeds(*scene, o, 256, 1), kRestirTests);
}

// Everything is first met in a mirror, and glossy.
TEST_F(RestirUnbiased, MirrorFirst) {
  const std::string mirror =
      "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"0.6\"/><rotate x=\"1\" "
      "angle=\"-20\"/><translate z=\"0.9\"/></transform><bsdf type=\"twosided\"><bsdf "
      "type=\"conductor\"><string "
      "name=\"material\" value=\"Al\"/></bsdf></bsdf></shape>";
  const auto scene = test::loadScene(test::indirectRoom(12) + mirror);
  for (const int depth : {4, -1}) {
    RenderOptions o = options(IntegratorKind::path);
    o.maxDepth = depth;
    o.rrDepth = 3;  // roulette plays on shared paths
    o.spp = 64;
    const test::PixelStatistics path = test::renderSeeds(*scene, o, 96, 1000);
    o.integrator = IntegratorKind::restir;
    o.restir.radius = 6;
    o.spp = 10;
    test::expectSameExpectation(path, test::renderSeeds(*scene, o, 256, 1), kRestirTests);
  }
}

TEST(Restir, SameBitsForAnyNumberOfThreads) {
  const auto scene = test::loadScene(test::indirectRoom(40));
  for (const SamplerKind sampler : {SamplerKind::sobol, SamplerKind::independent}) {
    RenderOptions o;
    o.integrator = IntegratorKind::restir;
    o.sampler = sampler;
    o.spp = 3;
    o.variance = true;
    o.threads = 1;
    const RenderResult one = test::renderScene(*scene, o);
    o.threads = 3;
    const RenderResult three = test::renderScene(*scene, o);
    EXPECT_TRUE(sameBits(one.image.color, three.image.color));
    EXPECT_TRUE(sameBits(one.image.variance, three.image.variance));
    EXPECT_EQ(one.stats.rays, three.stats.rays);
    EXPECT_EQ(one.stats.samples, 40u * 40u * 3u);
  }
}

// Sharing pays: neighbours' samples lower the variance of a frame.
TEST(Restir, NeighboursHelp) {
  const auto scene = test::loadScene(test::indirectRoom(32));
  const auto spread = [&](int neighbours) {
    RenderOptions o;
    o.integrator = IntegratorKind::restir;
    o.restir.neighbours = neighbours;
    o.restir.radius = 6;
    o.spp = 1;
    const test::PixelStatistics frames = test::renderSeeds(*scene, o, 48, 1);
    double sum = 0;
    for (size_t i = 0; i < frames.sum.size(); ++i) sum += frames.varianceOfMean(i, 1);
    return sum;
  };
  EXPECT_LT(spread(5), 0.8 * spread(0));
}

TEST(Restir, SaysWhatItDoesNot) {
  const auto scene = test::loadScene(test::indirectRoom(8));
  RenderOptions o;
  o.integrator = IntegratorKind::restir;
  EXPECT_THROW(replay(*scene, o, {1, 1}, 0), OptionError);
  o.features = true;
  EXPECT_THROW(test::renderScene(*scene, o), OptionError);
}

}  // namespace
}  // namespace odis::render
