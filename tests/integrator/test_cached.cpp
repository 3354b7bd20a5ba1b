// Paths that end with cached radiance: how far the image may be off, and where it may not be at all.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>

#include "integrator/test_scenes.h"
#include "support/average.h"
#include "support/sanitizers.h"

namespace odis::render {
namespace {

double meanOf(const RenderedImage& image) {
  double sum = 0;
  for (const Rgb& color : image.color) sum += average(color);
  return sum / double(image.color.size());
}

RenderOptions cachedOptions(int spp, uint64_t seed = 0) {
  RenderOptions options;
  options.set("cached=on");
  options.spp = spp;
  options.seed = seed;
  return options;
}

// Paths of an image end with the same few numbers, so that only many images tell of their mean.
TEST(Cached, FurnaceIsAsBright) {
  const auto scene = test::loadScene(
      test::furnace("<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.5\"/></bsdf>", 32));
  const int images = test::imagesToCompare(25);
  test::Average brightness;
  for (int seed = 0; seed < images; ++seed)
    brightness.add(meanOf(test::renderScene(*scene, cachedOptions(8, uint64_t(seed))).image));
  if (images < 10) return;
  EXPECT_LT(brightness.standardError(), 0.005);
  EXPECT_NEAR(brightness.mean(), 2, 4 * brightness.standardError());
}

// Many images of few samples, whose guides know little: light that estimates lost would be missing here.
TEST(Cached, KeepsTheEnergyOfARoom) {
  const auto scene = test::loadScene(test::indirectRoom(64));
  constexpr double kTolerance = 0.01;
  const int images = test::imagesToCompare(30);
  test::Average difference;
  uint64_t cachedRays = 0, rays = 0;
  for (int seed = 0; seed < images; ++seed) {
    const RenderResult cached = test::renderScene(*scene, cachedOptions(4, uint64_t(seed)));
    RenderOptions options = cachedOptions(16, uint64_t(seed));
    options.integrator = IntegratorKind::path;
    const double path = meanOf(test::renderScene(*scene, options).image);
    difference.add(meanOf(cached.image) / path - 1);
    cachedRays += cached.stats.rays + cached.stats.shadowRays;
    options.integrator = IntegratorKind::odis;
    options.set("cached=off");
    options.spp = 4;
    const RenderResult unbiased = test::renderScene(*scene, options);
    rays += unbiased.stats.rays + unbiased.stats.shadowRays;
  }
  if (images < 10) return;
  EXPECT_LT(difference.standardError(), kTolerance / 4) << "too few images to tell";
  EXPECT_LT(std::abs(difference.mean()), kTolerance + 4 * difference.standardError());
  EXPECT_LT(double(cachedRays), 0.97 * double(rays));  // otherwise hardly a path ended
}

// Inside a white sphere that shines with 1: (1 - 0.9^d) / 0.1, whether roulette ends paths early or late.
TEST(Cached, KeepsTheEnergyOfAFiniteDepth) {
  const auto scene = test::loadScene(
      test::furnace("<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.9\"/></bsdf>", 32));
  const int images = test::imagesToCompare(12);
  for (const int rrDepth : {5, 1000}) {
    RenderOptions options = cachedOptions(32);
    options.maxDepth = 32;
    options.rrDepth = rrDepth;
    options.set("guided-cost=0");
    test::Average brightness;
    for (int seed = 0; seed < images; ++seed) {
      options.seed = uint64_t(seed);
      brightness.add(meanOf(test::renderScene(*scene, options).image));
    }
    if (images < 10) return;
    const double expected = (1 - std::pow(0.9, 32)) / 0.1;
    EXPECT_LT(brightness.standardError(), 0.005 * expected);
    EXPECT_NEAR(brightness.mean(), expected, 0.01 * expected + 3 * brightness.standardError()) << rrDepth;
  }
}

TEST(Cached, SameBitsForAnyNumberOfThreads) {
  const auto scene = test::loadScene(test::indirectRoom());
  RenderOptions options = cachedOptions(8);
  options.threads = 1;
  const RenderResult one = test::renderScene(*scene, options);
  options.threads = 4;
  EXPECT_TRUE(test::sameBits(one.image.color, test::renderScene(*scene, options).image.color));
}

// Where few bounces are asked for, nothing is cached.
TEST(Cached, LeavesShallowPathsAsTheyAre) {
  const auto scene = test::loadScene(test::indirectRoom());
  RenderOptions options = cachedOptions(8);
  options.maxDepth = 3;
  const RenderResult cached = test::renderScene(*scene, options);
  options.set("cached=off");
  EXPECT_TRUE(test::sameBits(cached.image.color, test::renderScene(*scene, options).image.color));
}

std::string withRoughness(const std::string& type, const std::string& alpha) {
  const std::string metal =
      "<string name=\"material\" value=\"none\"/>"
      "<rgb name=\"specular_reflectance\" value=\"0.5\"/>";
  return "<bsdf type=\"" + type + "\">" + (type == "roughconductor" ? metal : "") +
         "<float name=\"alpha\" value=\"" + alpha + "\"/></bsdf>";
}

// What a glossy metal or frosted glass scatters depends on the direction, so that the mean of a cell is not
// what a path finds.
TEST(Cached, OnlyRoughMetalEndsPaths) {
  for (const auto& [type, alpha, ends] :
       {std::tuple("roughconductor", "0.25", false), std::tuple("roughconductor", "0.4", true),
        std::tuple("roughdielectric", "0.4", false)}) {
    const auto scene = test::loadScene(test::furnace(withRoughness(type, alpha), 32));
    RenderOptions options = cachedOptions(16);
    options.set("guided-cost=0");  // guiding does not pay in a furnace
    const RenderResult cached = test::renderScene(*scene, options);
    options.set("cached=off");
    EXPECT_EQ(test::sameBits(cached.image.color, test::renderScene(*scene, options).image.color), !ends)
        << type << " " << alpha;
  }
}

}  // namespace
}  // namespace odis::render
