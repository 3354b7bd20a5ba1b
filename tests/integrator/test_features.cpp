// Features of the guide: what an image says of the decisions at the vertices that it shows.
#include "render/path/features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>

#include "integrator/test_scenes.h"
#include "odis/maps/pack.h"

namespace odis::render {
namespace {

RenderOptions withFeatures() {
  RenderOptions options;
  options.spp = 4;
  options.features = options.guideFeatures = true;
  return options;
}

TEST(GuideFeatures, SayWhatWasDecided) {
  const auto scene = test::loadScene(test::indirectRoom(32));
  RenderOptions options = withFeatures();
  options.set("bsdf-fraction=0.4");
  options.set("map-floor=1");
  const RenderResult result = test::renderScene(*scene, options);
  const RenderedImage& frame = result.image;
  ASSERT_EQ(frame.guideCell.size(), 1024u);
  int known = 0, asTold = 0;
  std::set<float> cells;
  for (size_t i = 0; i < 1024; ++i) {
    if (frame.guideCell[i] < 0) {
      EXPECT_EQ(frame.guideBsdfFraction[i], 1);
      EXPECT_EQ(frame.guideSurvival[i], 1);
      continue;
    }
    ++known;
    cells.insert(frame.guideCell[i]);
    EXPECT_LT(frame.guideCell[i], float(result.stats.cells));
    // More than that only where the back of the lamp is seen, which scatters nothing.
    asTold += std::abs(frame.guideBsdfFraction[i] - 0.4f) < 1e-6f;
    EXPECT_GE(frame.guideBsdfFraction[i], 0.4f - 1e-6f);
    // A map that is all floor is the cosine alone: some 6.75 bits, more where normals differ in a cell.
    EXPECT_NEAR(frame.guideEntropy[i], 6.8, 0.25);
    EXPECT_GE(frame.guideSurvival[i], 0.3f);
    EXPECT_LE(frame.guideSurvival[i], 1);
    EXPECT_GE(frame.guideSamples[i], 2);
  }
  EXPECT_GT(known, 1000);
  EXPECT_GT(asTold, 980);
  EXPECT_GT(cells.size(), 50u);
}

TEST(Alpha, IsTheShareThatIsNeitherEmptyNorHidden) {
  const std::string hide =
      "<integrator type=\"path\"><boolean name=\"hide_emitters\" value=\"true\"/></integrator>";
  const std::string lamp =
      "<shape type=\"rectangle\"><emitter type=\"area\"><rgb name=\"radiance\" "
      "value=\"1\"/></emitter></shape>";
  const std::string veil =
      "<shape type=\"rectangle\"><bsdf type=\"mask\"><float name=\"opacity\" value=\"0.25\"/>"
      "<bsdf type=\"diffuse\"/></bsdf></shape>";
  const std::string sky = "<emitter type=\"constant\"/>", point = "<emitter type=\"point\"/>";
  const std::string black =
      "<shape type=\"rectangle\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" "
      "value=\"0\"/></bsdf></shape>";
  const struct {
    std::string scene;
    double expected;
    int maxDepth = -1;
  } cases[] = {{hide + veil + sky, 0.25}, {veil + sky, 1}, {veil + point, 0.25}, {hide + lamp, 0},
               {hide + lamp + sky, 0},    {lamp, 1, 1},    {hide + sky, 0},      {black + point, 1},
               {hide + black + sky, 1},   {point, 0},      {veil + sky, 1, 1},   {hide + black + sky, 1, 1}};
  for (const IntegratorKind integrator : {IntegratorKind::path, IntegratorKind::odis})
    for (const auto& [scene, expected, maxDepth] : cases) {
      RenderOptions options;
      options.integrator = integrator;
      options.spp = 64;
      options.maxDepth = maxDepth;
      const auto loaded =
          test::loadScene(scene + test::sensor("origin=\"0,0,1\" target=\"0,0,0\" up=\"0,1,0\"", 40, 16, 16));
      EXPECT_TRUE(test::renderScene(*loaded, options).image.alpha.empty());
      options.features = true;
      const RenderedImage image = test::renderScene(*loaded, options).image;
      ASSERT_EQ(image.alpha.size(), 256u);
      const double mean = std::accumulate(image.alpha.begin(), image.alpha.end(), 0.0) / 256;
      // Four standard deviations of 16384 independent samples, where chance decides.
      const double tolerance = expected > 0 && expected < 1 ? 4 * std::sqrt(0.25 * 0.75 / 16384) : 1e-6;
      EXPECT_NEAR(mean, expected, tolerance) << scene;
    }
}

TEST(GuideFeatures, DifferWhereLightDoes) {
  const auto scene = test::loadScene(test::indirectRoom(96));
  const RenderedImage frame = test::renderScene(*scene, withFeatures()).image;
  const auto [least, most] = std::minmax_element(frame.guideEntropy.begin(), frame.guideEntropy.end());
  EXPECT_GT(*least, 0);
  EXPECT_LT(*least, *most - 0.5f);
  EXPECT_LE(*most, 8);
  EXPECT_LT(*std::min_element(frame.guideBsdfFraction.begin(), frame.guideBsdfFraction.end()), 0.9f);
}

// A white ball before the sky: albedo and normal fade at its edge as colours do.
TEST(Features, FadeWhereSomeSamplesMeetNothing) {
  const auto scene =
      test::loadScene(R"(<sensor type="perspective"><film type="hdrfilm"><integer name="width" value="24"/>
      <integer name="height" value="24"/><rfilter type="box"/></film></sensor>
    <shape type="sphere"><point name="center" x="0" y="0" z="4"/>
      <bsdf type="diffuse"><rgb name="reflectance" value="0.8"/></bsdf></shape>
    <emitter type="constant"/>)");
  RenderOptions options;
  options.integrator = IntegratorKind::path;
  options.spp = 16;
  options.features = true;
  const RenderedImage image = test::renderScene(*scene, options).image;
  int edges = 0;
  for (size_t i = 0; i < image.albedo.size(); ++i) {
    const float covered = image.albedo[i].x / 0.8f;
    EXPECT_NEAR(covered * 16, std::round(covered * 16), 1e-3f);
    EXPECT_NEAR(length(image.normal[i]), covered, 1e-3f);
    EXPECT_EQ(image.depth[i] > 2.9f, covered > 0);  // a mean over those that met the ball
    edges += covered > 0 && covered < 0.99f;
  }
  EXPECT_GT(edges, 10);
  EXPECT_NEAR(image.albedo[12 * 24 + 12].x, 0.8f, 1e-5f);
  EXPECT_EQ(image.albedo[0].x, 0);
}

// What is made only when asked for changes nothing else.
TEST(GuideFeatures, AreMissingUnlessAskedFor) {
  const auto scene = test::loadScene(test::indirectRoom(16));
  RenderOptions options = withFeatures();
  const RenderedImage with = test::renderScene(*scene, options).image;
  options.guideFeatures = false;
  const RenderedImage without = test::renderScene(*scene, options).image;
  EXPECT_FALSE(with.guideBsdfFraction.empty());
  EXPECT_TRUE(without.guideBsdfFraction.empty() && without.guideEntropy.empty());
  EXPECT_TRUE(without.guideSurvival.empty() && without.guideCell.empty());
  EXPECT_EQ(with.color, without.color);
  EXPECT_EQ(with.depth, without.depth);
}

TEST(GuideFeatures, AreMissingWithoutAGuide) {
  const auto scene = test::loadScene(test::indirectRoom(8));
  RenderOptions options = withFeatures();
  options.integrator = IntegratorKind::path;
  const RenderedImage frame = test::renderScene(*scene, options).image;
  EXPECT_EQ(frame.depth.size(), 64u);
  EXPECT_TRUE(frame.guideBsdfFraction.empty() && frame.guideCell.empty());
}

TEST(GuideFeatures, EntropyCountsBits) {
  core::Histogram weights;
  const auto bits = [&] { return entropy(core::PackedMap(weights).view()); };
  weights.fill(7);
  EXPECT_NEAR(bits(), 8, 1e-5f);
  weights.fill(0);
  weights[3] = 1;
  EXPECT_NEAR(bits(), 0, 0.02f);  // no share is 0
  weights[200] = 1;
  EXPECT_NEAR(bits(), 1, 0.02f);
}

}  // namespace
}  // namespace odis::render
