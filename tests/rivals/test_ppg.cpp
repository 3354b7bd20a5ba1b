// Practical path guiding: it has the expectation of path tracing with every option, repeats to the bit, and
// learns.
#include "render/rivals/ppg.h"

#include <gtest/gtest.h>
#include <odis/mixture.h>

#include <random>

#include "render/math/warp.h"
#include "render/path/path.h"
#include "rivals/rival_test.h"

namespace odis::render {
namespace {

struct Switch {
  std::string name;
  PpgOptions options;
};

void PrintTo(const Switch& s, std::ostream* out) {
  *out << s.name;
}

// Every option by itself beside the first version, and the improved one.
std::vector<Switch> switches() {
  const PpgOptions first = PpgOptions::firstPublished();
  std::vector<Switch> result(7, {"", first});
  result[0].name = "first";
  result[1].name = "jitter";
  result[1].options.spatial = PpgOptions::Spatial::jitter;
  result[2].name = "spatialBox";
  result[2].options.spatial = PpgOptions::Spatial::box;
  result[3].name = "directionalBox";
  result[3].options.directional = QuadtreeFilter::box;
  result[4].name = "inverseVariance";
  result[4].options.combine = PpgOptions::Combine::inverseVariance;
  result[5].name = "learnedShare";
  result[5].options.bsdfFraction = PpgOptions::BsdfFraction::learned;
  result[6] = {"improved", PpgOptions()};
  // Images are tiny: leaves are halved at some hundred samples.
  for (Switch& s : result) s.options.threshold = 300;
  return result;
}
constexpr int kPpgTests = 14;  // seven switches, two rooms

class PpgUnbiased : public RivalTest, public ::testing::WithParamInterface<Switch> {};

TEST_P(PpgUnbiased, AgreesWithPath) {
  RenderOptions o = options(IntegratorKind::ppg);
  o.ppg = GetParam().options;
  expectAgreement(o, kPpgTests);
}

INSTANTIATE_TEST_SUITE_P(Switches, PpgUnbiased, ::testing::ValuesIn(switches()),
                         [](const auto& info) { return info.param.name; });

TEST(Ppg, SameBitsForAnyNumberOfThreads) {
  const auto scene = test::loadScene(test::indirectRoom(40));
  for (const Switch& s : switches()) {
    RenderOptions options;
    options.integrator = IntegratorKind::ppg;
    options.ppg = s.options;
    options.spp = 10;
    options.variance = true;
    options.threads = 1;
    const RenderResult one = test::renderScene(*scene, options);
    options.threads = 3;
    const RenderResult three = test::renderScene(*scene, options);
    EXPECT_TRUE(sameBits(one.image.color, three.image.color)) << s.name;
    EXPECT_TRUE(sameBits(one.image.variance, three.image.variance)) << s.name;
    EXPECT_EQ(one.stats.rays, three.stats.rays);
    EXPECT_EQ(one.stats.samples, 40u * 40u * 10u);
  }
}

TEST(Ppg, OneAndTwoSamplesArePathTracing) {
  const auto scene = test::loadScene(test::indirectRoom());
  for (const int spp : {1, 2}) {
    RenderOptions options;
    options.spp = spp;
    options.integrator = IntegratorKind::path;
    const RenderResult path = test::renderScene(*scene, options);
    options.integrator = IntegratorKind::ppg;
    EXPECT_TRUE(sameBits(path.image.color, test::renderScene(*scene, options).image.color));
  }
}

TEST(Ppg, IterationsDoubleAndTheLastTakesWhatIsLeft) {
  const PracticalPathGuiding guide{PpgOptions()};
  const auto schedule = [&](uint32_t spp) {
    std::vector<uint32_t> ends;
    for (uint32_t done = 0; done < spp; ends.push_back(done)) done = guide.iterationEnd(done, spp);
    return ends;
  };
  EXPECT_EQ(schedule(1), (std::vector<uint32_t>{1}));
  EXPECT_EQ(schedule(2), (std::vector<uint32_t>{2}));
  EXPECT_EQ(schedule(3), (std::vector<uint32_t>{1, 3}));
  EXPECT_EQ(schedule(4), (std::vector<uint32_t>{1, 4}));
  EXPECT_EQ(schedule(16), (std::vector<uint32_t>{1, 3, 7, 16}));
  EXPECT_EQ(schedule(64), (std::vector<uint32_t>{1, 3, 7, 15, 31, 64}));
}

TEST(Ppg, ReplayIsThePixel) {
  const auto scene = test::loadScene(test::indirectRoom());
  RenderOptions options;
  options.integrator = IntegratorKind::ppg;
  options.spp = 3;
  options.ppg = PpgOptions::firstPublished();  // the last iteration alone: samples 1 and 2
  const Rgb c = test::renderScene(*scene, options).image.color[7 * 24 + 11];
  float sum = 0;
  for (const int sample : {1, 2}) {
    const std::string text = replay(*scene, options, {11, 7}, sample);
    float r = 0, g = 0, b = 0;
    ASSERT_EQ(std::sscanf(text.c_str() + text.find("radiance"), "radiance %f %f %f", &r, &g, &b), 3);
    sum += g;
  }
  EXPECT_NEAR(sum / 2, c.y, 1e-4f * std::max(1.0f, c.y));
}

// A diffuse vertex on the floor z = 0 of a world that sends this much light from a direction.
using Incident = float (*)(const Vec3& wi);

// Vertices drawn from the mixture of a diffuse BSDF and the guide, as the path tracer draws them.
std::vector<PathVertex> drawVertices(const PracticalPathGuiding& guide, Incident incident, int count,
                                     std::mt19937& engine) {
  std::uniform_real_distribution<float> uniform(0, kOneMinusEpsilon);
  std::vector<PathVertex> vertices;
  for (int i = 0; i < count; ++i) {
    PathVertex v;
    v.position = {uniform(engine), uniform(engine), 0};
    v.normal = {0, 0, 1};
    v.depth = 1;
    const DirectionSampler* sampler = guide.at(fromOdis(v.position), {0, 0, 1}, false);
    const Vec2 u(uniform(engine), uniform(engine));
    const float share = sampler ? sampler->bsdfFraction() : 1;
    const bool fromBsdf = uniform(engine) < share;
    const Vec3 wi = fromBsdf ? squareToCosineHemisphere(u) : fromOdis(sampler->sample(u).wi);
    v.wi = toOdis(wi);
    v.guidablePdf = cosineHemispherePdf(wi.z);
    v.guidableProbability = 1;
    v.pdf = mixturePdf(v.guidablePdf, v.guidablePdf, 1.0f, share, sampler ? sampler->pdf(wi) : 0.0f);
    const float weight = v.guidablePdf / v.pdf, radiance = incident(wi);
    v.weight = {weight, weight, weight};
    v.radiance = {radiance, radiance, radiance};
    vertices.push_back(v);
  }
  return vertices;
}

void learnFrom(PracticalPathGuiding& guide, Incident incident) {
  std::mt19937 engine(1);
  for (uint32_t done = 0; done < 63;) {
    for (const uint32_t end = guide.iterationEnd(done, 1000); done < end; ++done) {
      const std::vector<PathVertex> vertices = drawVertices(guide, incident, 500, engine);
      guide.learn(std::span(&vertices, 1), done);
    }
    guide.endIteration();
  }
}

TEST(Ppg, LearnsWhereLightComesFrom) {
  const Incident window = [](const Vec3& w) { return w.z > 0.3f && w.z < 0.5f && w.x > 0.8f ? 1.0f : 0.0f; };
  for (const Switch& s : switches()) {
    PracticalPathGuiding guide(s.options);
    learnFrom(guide, window);
    const DirectionSampler* sampler = guide.at({0.5f, 0.5f, 0}, {0, 0, 1}, false);
    ASSERT_TRUE(sampler);
    std::mt19937 engine(9);
    std::uniform_real_distribution<float> uniform(0, kOneMinusEpsilon);
    int lit = 0;
    for (int i = 0; i < 1000; ++i)
      lit += window(fromOdis(sampler->sample({uniform(engine), uniform(engine)}).wi)) > 0;
    EXPECT_GT(lit, 700) << s.name;  // 3 % of the BSDF's draws are
    // Most draws are best left to such a guide.
    if (s.options.bsdfFraction == PpgOptions::BsdfFraction::learned) {
      EXPECT_LT(sampler->bsdfFraction(), 0.4f);
    } else {
      EXPECT_EQ(sampler->bsdfFraction(), 0.5f);
    }
  }
}

TEST(Ppg, LearnsToLeaveEvenLightToTheBsdf) {
  PracticalPathGuiding guide(switches().back().options);
  learnFrom(guide, [](const Vec3&) { return 1.0f; });
  EXPECT_GT(guide.at({0.5f, 0.5f, 0}, {0, 0, 1}, false)->bsdfFraction(), 0.75f);
}

// A lamp of zero radiance is no scene to learn from, and nothing must break.
TEST(Ppg, Darkness) {
  const auto scene =
      test::loadScene(test::sensor("origin=\"0,0,4\" target=\"0,0,0\" up=\"0,1,0\"", 40, 8, 8) +
                      "<shape type=\"sphere\"><bsdf type=\"diffuse\"/></shape>");
  RenderOptions options;
  options.integrator = IntegratorKind::ppg;
  options.spp = 20;
  for (const Rgb& c : test::renderScene(*scene, options).image.color) EXPECT_EQ(c, Rgb(0, 0, 0));
}

}  // namespace
}  // namespace odis::render
