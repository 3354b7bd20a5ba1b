// Images on a film that splats, beside those on one whose pixels are independent of each other.
#include <gtest/gtest.h>

#include "integrator/same_expectation.h"

namespace odis::render {
namespace {

const char* const kSplatFilters[] = {"tent", "gaussian", "mitchell", "catmullrom", "lanczos"};

RenderOptions splatting(IntegratorKind integrator, int spp) {
  RenderOptions options;
  options.film = FilmKind::splat;
  options.integrator = integrator;
  options.spp = spp;
  return options;
}

// The sky has the same radiance in all directions.
TEST(Splat, ConstantImagesAreConstantUpToTheBorder) {
  const std::string sky = test::sensor("origin=\"0,0,0\" target=\"1,0,0\" up=\"0,1,0\"", 60, 37, 21) +
                          "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"0.7\"/></emitter>";
  for (const char* filter : kSplatFilters)
    for (const IntegratorKind integrator : {IntegratorKind::path, IntegratorKind::odis}) {
      const auto scene = test::loadScene(test::filtered(sky, filter));
      for (const Rgb& color : test::renderScene(*scene, splatting(integrator, 5)).image.color)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(color[c], 0.7f, 7e-7) << filter;
    }
}

class SplatRoom : public ::testing::TestWithParam<const char*> {};

// Both films have the same expectation, up to what dividing by random sums of weights makes of few samples:
// images have many.
TEST_P(SplatRoom, HasTheExpectationOfIndependentPixels) {
  const auto scene = test::loadScene(test::filtered(test::indirectRoom(16), GetParam()));
  RenderOptions pixels = splatting(IntegratorKind::path, 256);
  pixels.film = FilmKind::pixels;
  const test::PixelStatistics expected = test::renderSeeds(*scene, pixels, 32, 1000);
  for (const std::string samples : {"samples=even", "samples=adaptive"}) {
    RenderOptions odis = splatting(IntegratorKind::odis, 64), path = splatting(IntegratorKind::path, 64);
    odis.set(samples);
    path.set(samples);
    test::expectSameExpectation(expected, test::renderSeeds(*scene, path, 32, 1), 20);
    test::expectSameExpectation(expected, test::renderSeeds(*scene, odis, 32, 1), 20);
  }
}
INSTANTIATE_TEST_SUITE_P(Filters, SplatRoom, ::testing::Values("tent", "gaussian", "lanczos"));

TEST(Splat, RivalsSplatAsWell) {
  const auto scene = test::loadScene(test::filtered(test::indirectRoom(16), "tent"));
  const auto meanOf = [&](const RenderOptions& options) {
    double sum = 0;
    for (int seed = 0; seed < 4; ++seed) {
      RenderOptions one = options;
      one.seed = uint64_t(seed);
      for (const Rgb& color : test::renderScene(*scene, one).image.color) sum += double(color.y) / 4 / 256;
    }
    return sum;
  };
  const double expected = meanOf(splatting(IntegratorKind::path, 256));
  for (const IntegratorKind integrator : {IntegratorKind::ppg, IntegratorKind::restir})
    EXPECT_NEAR(meanOf(splatting(integrator, 64)), expected, 0.03 * expected) << int(integrator);
}

TEST(Splat, AnyNumberOfThreadsGivesTheSameBits) {
  const auto scene = test::loadScene(test::filtered(test::indirectRoom(50), "gaussian"));
  for (const IntegratorKind integrator : {IntegratorKind::path, IntegratorKind::odis}) {
    RenderOptions options = splatting(integrator, 8);
    options.variance = true;
    options.features = true;
    options.threads = 1;
    const RenderedImage one = test::renderScene(*scene, options).image;
    options.threads = 4;
    const RenderedImage four = test::renderScene(*scene, options).image;
    EXPECT_TRUE(test::sameBits(one.color, four.color));
    EXPECT_TRUE(test::sameBits(one.variance, four.variance));
    EXPECT_TRUE(test::sameBits(one.albedo, four.albedo));
    EXPECT_EQ(one.alpha, four.alpha);
    options.variance = options.features = false;
    EXPECT_TRUE(test::sameBits(one.color, test::renderScene(*scene, options).image.color))
        << "layers change the picture";
  }
}

TEST(Splat, CropsTogetherAreTheWhole) {
  const std::string text = test::filtered(test::indirectRoom(50), "gaussian");
  RenderOptions options = splatting(IntegratorKind::path, 4);
  options.features = true;
  const RenderedImage whole = test::renderScene(*test::loadScene(text), options).image;
  for (const Crop& crop : {Crop{0, 0, 21, 50}, Crop{21, 0, 29, 35}, Crop{21, 35, 29, 15}}) {
    const auto integer = [](const char* name, int value) {
      return "<integer name=\"crop_" + std::string(name) + "\" value=\"" + std::to_string(value) + "\"/>";
    };
    const auto scene =
        test::loadScene(test::filtered(test::indirectRoom(50), "gaussian",
                                       integer("offset_x", crop.x) + integer("offset_y", crop.y) +
                                           integer("width", crop.width) + integer("height", crop.height)));
    const RenderedImage part = test::renderScene(*scene, options).image;
    ASSERT_EQ(part.color.size(), crop.pixels());
    for (int y = 0; y < crop.height; ++y)
      for (int x = 0; x < crop.width; ++x) {
        const auto at = size_t(y * crop.width + x), inWhole = size_t((y + crop.y) * 50 + x + crop.x);
        ASSERT_EQ(part.color[at], whole.color[inWhole]) << x << ", " << y;
        ASSERT_EQ(part.normal[at], whole.normal[inWhole]) << x << ", " << y;
      }
  }
}

// Crops of a guided image have guides of their own, and show the same.
TEST(Splat, CropsOfGuidedImagesCountTheirOwnPixels) {
  const auto scene = test::loadScene(test::filtered(
      test::indirectRoom(40), "gaussian",
      "<integer name=\"crop_offset_x\" value=\"7\"/><integer name=\"crop_offset_y\" value=\"20\"/>"
      "<integer name=\"crop_width\" value=\"12\"/><integer name=\"crop_height\" value=\"9\"/>"));
  RenderOptions options = splatting(IntegratorKind::odis, 8);
  options.features = options.guideFeatures = options.records = true;
  const RenderResult result = test::renderScene(*scene, options);
  EXPECT_EQ(result.image.color.size(), 108u);
  EXPECT_EQ(result.image.guideSamples.size(), 108u);
  EXPECT_EQ(result.image.guideCell.size(), 108u);
  EXPECT_EQ(result.image.depth.size(), 108u);
  EXPECT_EQ(result.pilotEmitted.size(), 108u);
  ASSERT_FALSE(result.records.empty());
  for (const PathVertex& v : result.records) EXPECT_LT(v.pixel, 108u);
}

// Halves of the samples tell of the variance; the estimate's mean over pixels and images is that between
// images of other seeds. Independent numbers, as stratified ones are better than the estimate says.
TEST(Splat, VarianceIsThatBetweenImages) {
  const auto scene = test::loadScene(test::filtered(test::indirectRoom(24), "gaussian"));
  for (const IntegratorKind integrator : {IntegratorKind::path, IntegratorKind::odis}) {
    RenderOptions options = splatting(integrator, 16);
    options.sampler = SamplerKind::independent;
    options.set("samples=even");
    options.variance = true;
    test::PixelStatistics images;
    constexpr int seeds = 48;
    double estimated = 0, between = 0;
    for (int seed = 0; seed < seeds; ++seed) {
      options.seed = uint64_t(seed);
      const RenderedImage image = test::renderScene(*scene, options).image;
      images.add(image.color);
      ASSERT_EQ(image.variance.size(), image.color.size());
      for (const Rgb& v : image.variance) estimated += double(v.y) / seeds;
    }
    for (size_t i = 0; i < images.sum.size(); ++i) between += images.varianceOfMean(i, 1) * seeds;
    EXPECT_NEAR(estimated / between, 1, 0.1) << int(integrator);
  }
}

// With sample_border pixels at the border see beyond it, as far as the filter reaches.
TEST(Splat, BordersAreSampledWhereTheFileSaysSo) {
  const std::string sky = test::sensor("origin=\"0,0,0\" target=\"0,0,1\" up=\"0,1,0\"", 60, 20, 20) +
                          "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"0.57735\"/>"
                          "<rotate y=\"1\" angle=\"180\"/><translate z=\"1\"/></transform>"
                          "<emitter type=\"area\"><rgb name=\"radiance\" value=\"1\"/></emitter></shape>";
  const RenderOptions options = splatting(IntegratorKind::path, 64);
  const auto inside = test::renderScene(*test::loadScene(test::filtered(sky, "gaussian")), options).image;
  const auto beyond =
      test::renderScene(*test::loadScene(test::filtered(sky, "gaussian",
                                                        "<boolean name=\"sample_border\" value=\"true\"/>")),
                        options)
          .image;
  // The lamp fills the film: its border is dark only if there are samples beyond.
  EXPECT_NEAR(inside.color[10].y, 1, 1e-3);
  EXPECT_LT(beyond.color[10].y, 0.9f);
  EXPECT_NEAR(beyond.color[20 * 10 + 10].y, 1, 1e-3);
}

}  // namespace
}  // namespace odis::render
