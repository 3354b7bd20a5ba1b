// What the pilot records, and that images repeat to the bit.
#include <gtest/gtest.h>

#include <algorithm>

#include "integrator/test_scenes.h"

namespace odis::render {
namespace {

TEST(Records, FirstVerticesAddUpToTheImage) {
  const auto scene = test::loadScene(test::indirectRoom());
  RenderOptions options;
  options.spp = 2;
  options.set("pilot-spp=2");
  options.records = true;
  const RenderResult result = test::renderScene(*scene, options);
  std::vector<Rgb> sum = result.pilotEmitted;
  ASSERT_EQ(sum.size(), result.image.color.size());
  for (const PathVertex& v : result.records)
    if (v.depth == 1)
      sum[v.pixel] +=
          (Rgb(v.direct.x, v.direct.y, v.direct.z) +
           Rgb(v.weight.x, v.weight.y, v.weight.z) * Rgb(v.radiance.x, v.radiance.y, v.radiance.z)) *
          v.sampleWeight;
  for (size_t i = 0; i < sum.size(); ++i)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(sum[i][c] / 2, result.image.color[i][c], 1e-4f * std::max(1.0f, result.image.color[i][c]));
}

TEST(Records, EachVertexHoldsTheNextOne) {
  // radiance(k) = emission met + direct(k + 1) + weight(k + 1) radiance(k + 1)
  const auto scene = test::loadScene(test::indirectRoom());
  RenderOptions options;
  options.spp = 1;
  options.records = true;
  const RenderResult result = test::renderScene(*scene, options);
  int pairs = 0;
  for (size_t i = 0; i + 1 < result.records.size(); ++i) {
    const PathVertex &a = result.records[i], &b = result.records[i + 1];
    if (b.depth != a.depth + 1) continue;
    const float beyond = b.direct.y + b.weight.y * b.radiance.y;
    ASSERT_GE(a.radiance.y, beyond * 0.9999f);
    ASSERT_NEAR(a.distance, std::sqrt(dot(b.position - a.position, b.position - a.position)), 1e-3f);
    ++pairs;
  }
  EXPECT_GT(pairs, 500);
}

TEST(Repeatable, SameBitsForAnyNumberOfThreads) {
  const auto scene = test::loadScene(test::indirectRoom(40));
  for (const IntegratorKind kind : {IntegratorKind::path, IntegratorKind::odis})
    for (const SamplerKind sampler : {SamplerKind::sobol, SamplerKind::independent}) {
      RenderOptions options;
      options.integrator = kind;
      options.sampler = sampler;
      options.features = options.variance = true;
      options.threads = 1;
      const RenderResult one = test::renderScene(*scene, options);
      options.threads = 3;
      const RenderResult three = test::renderScene(*scene, options);
      EXPECT_TRUE(test::sameBits(one.image.color, three.image.color));
      EXPECT_TRUE(test::sameBits(one.image.variance, three.image.variance));
      EXPECT_TRUE(test::sameBits(one.image.albedo, three.image.albedo));
      EXPECT_EQ(one.stats.rays, three.stats.rays);
      options.seed = 1;
      EXPECT_FALSE(test::sameBits(one.image.color, test::renderScene(*scene, options).image.color));
    }
}

TEST(Repeatable, ReplayIsThePixel) {
  const auto scene = test::loadScene(test::indirectRoom());
  RenderOptions options;
  options.integrator = IntegratorKind::path;
  options.spp = 1;
  const RenderResult result = test::renderScene(*scene, options);
  const Rgb& c = result.image.color[7 * 24 + 11];
  char expected[100];
  std::snprintf(expected, sizeof(expected), "pixel 11,7 sample 0: radiance %.6g %.6g %.6g\n", c.x, c.y, c.z);
  const std::string text = replay(*scene, options, {11, 7}, 0);
  EXPECT_EQ(text.substr(0, std::strlen(expected)), expected);
  EXPECT_NE(text.find("vertex 1"), std::string::npos);
  options.integrator = IntegratorKind::odis;
  EXPECT_NE(replay(*scene, options, {11, 7}, 2).find("vertex 1"), std::string::npos);
}

// Guided paths depend on the passes before them, which learn from the ones before those; vertices of paths
// that survived roulette add up to the path nevertheless, if nothing stands in for what it ends.
TEST(Repeatable, ReplaysOfGuidedPathsAreTheirPixel) {
  const auto scene = test::loadScene(test::indirectRoom());
  RenderOptions options;
  options.spp = 5;
  options.set("pilot-weight=0");
  options.set("ended-paths=nothing");
  options.features = options.guideFeatures = true;  // they tell how many samples a pixel has
  const RenderResult result = test::renderScene(*scene, options);
  int kept = 0;  // vertices that roulette might have ended
  for (int x = 2; x < 22; ++x) {
    float mean = 0;
    const int samples = int(result.image.guideSamples[3 * 24 + x]);
    for (int sample = 1; sample < samples; ++sample) {
      const std::string text = replay(*scene, options, {x, 3}, sample);
      float radiance = 0;
      ASSERT_EQ(std::sscanf(text.c_str(), "pixel %*d,3 sample %*d: radiance %*f %f", &radiance), 1) << text;
      mean += radiance / float(samples - 1);
      float expected = radiance;  // what the next vertex scatters
      for (size_t at = text.find("  vertex"); at != std::string::npos; at = text.find("  vertex", at + 1)) {
        float weight = 0, direct = 0, arriving = 0;
        ASSERT_EQ(std::sscanf(text.c_str() + text.find("weight", at), "weight (%*f %f", &weight), 1);
        ASSERT_EQ(std::sscanf(text.c_str() + text.find("direct", at), "direct (%*f %f", &direct), 1);
        ASSERT_EQ(std::sscanf(text.c_str() + text.find("arriving", at), "arriving (%*f %f", &arriving), 1);
        const float scattered = direct + weight * arriving;
        if (at == text.find("  vertex"))
          EXPECT_NEAR(scattered, expected, 1e-3f * expected + 1e-6f) << text;
        else if (scattered < 0.99f * expected)
          ++kept;
        expected = arriving;
      }
    }
    EXPECT_NEAR(mean, result.image.color[3 * 24 + x].y, 1e-4f * mean + 1e-6f);
  }
  EXPECT_GT(kept, 10);
}

TEST(Samples, EveryPixelGetsWhatWasAskedFor) {
  const auto scene = test::loadScene(test::indirectRoom());
  for (const double pilot : {0.25, 1.0, 2.0})
    for (const int spp : {1, 4, 11}) {
      RenderOptions options;
      options.spp = spp;
      options.set("samples=even pilot-spp=" + std::to_string(pilot));
      const RenderResult result = test::renderScene(*scene, options);
      EXPECT_EQ(result.stats.samples, uint64_t(24 * 24 * spp));
    }
}

TEST(Samples, AreSpreadForAboutAsManyRays) {
  const auto scene = test::loadScene(test::indirectRoom(48));
  for (const IntegratorKind kind : {IntegratorKind::path, IntegratorKind::odis}) {
    RenderOptions options;
    options.integrator = kind;
    options.spp = 16;
    options.set("samples=even");
    const RenderResult even = test::renderScene(*scene, options);
    options.set("samples=adaptive");
    options.features = options.guideFeatures = true;
    const RenderResult adaptive = test::renderScene(*scene, options);
    EXPECT_NEAR(double(adaptive.stats.rays) / double(even.stats.rays), 1, 0.05);
    if (kind == IntegratorKind::path) continue;
    const auto [least, most] =
        std::minmax_element(adaptive.image.guideSamples.begin(), adaptive.image.guideSamples.end());
    EXPECT_GE(*least, 8);
    EXPECT_LT(*least, 16);
    EXPECT_GT(*most, 16);
    EXPECT_LE(*most, 48);
  }
}

TEST(Samples, OfThePilotDependOnTheImage) {
  const auto pilotSamples = [](int size, int spp) {
    const auto scene = test::loadScene(test::indirectRoom(size));
    RenderOptions options;
    options.spp = spp;
    options.maxDepth = 2;
    return double(test::renderScene(*scene, options).stats.pilotSamples) / (size * size);
  };
  EXPECT_EQ(pilotSamples(40, 4), 1);
  EXPECT_EQ(pilotSamples(450, 4), 0.25);
  EXPECT_EQ(pilotSamples(450, 31), 0.25);
  EXPECT_EQ(pilotSamples(450, 32), 1);
}

TEST(Variance, EstimatesTheSpreadOverSeeds) {
  const auto scene = test::loadScene(test::indirectRoom(12));
  for (const IntegratorKind kind : {IntegratorKind::path, IntegratorKind::odis}) {
    double predicted = 0, sum = 0, squares = 0;
    const int seeds = 200;
    for (int s = 0; s < seeds; ++s) {
      RenderOptions options;
      options.integrator = kind;
      options.sampler = SamplerKind::independent;  // stratified samples vary less than the estimate says
      options.spp = 8;
      options.seed = uint64_t(s);
      options.variance = true;
      const RenderedImage frame = test::renderScene(*scene, options).image;
      const size_t pixel = 6 * 12 + 3;
      predicted += frame.variance[pixel].y / seeds;
      sum += frame.color[pixel].y;
      squares += double(frame.color[pixel].y) * frame.color[pixel].y;
    }
    const double spread = (squares - sum * sum / seeds) / (seeds - 1);
    EXPECT_NEAR(predicted / spread, 1, 0.5);
  }
}

class CancelAtOnce : public Progress {
 public:
  bool cancelled() const override { return true; }
};

TEST(Cancel, GivesWhatIsThere) {
  const auto scene = test::loadScene(test::indirectRoom());
  CancelAtOnce cancel;
  const RenderResult result = render(*scene, {}, cancel);
  EXPECT_TRUE(result.stats.interrupted);
  EXPECT_EQ(result.image.color.size(), 24u * 24u);
  EXPECT_EQ(result.stats.samples, 0u);
}

}  // namespace
}  // namespace odis::render
