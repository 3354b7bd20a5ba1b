// The object of all that is known at a vertex: what it draws has the density that it tells, also for hosts in
// double precision, and it answers as the functions that it stands for.
#include <odis/guided_vertex.h>

#include <numbers>
#include <random>

#include "odis/floor_under_patch.h"
#include "odis/guide.h"
#include "support/average.h"
#include "support/chi2.h"

namespace odis::core {
namespace {

constexpr uint32_t kLights = 4;

// A guide of a floor under a bright patch, with four lights of which the last brings most.
Guide guideOfFloor() {
  GuideOptions options;
  options.lightGroups = kLights;
  std::vector<PathVertex> vertices = floorUnderPatch(kBright, 20000, 3);
  for (size_t i = 0; i < vertices.size(); ++i) {
    PathVertex& v = vertices[i];
    v.sample = uint32_t(i);
    v.roughness = i % 2 ? 1 : 0.3f;
    v.lightGroup = uint32_t(i) % kLights;
    v.lightGroupProbability = 1.0f / kLights;
    const float direct = v.lightGroup == 3 ? 2.0f : 0.1f;
    v.direct = {direct, direct, direct};
  }
  GuideBuilder builder(options);
  builder.add(vertices);
  return builder.build();
}

class GuidedVertexTest : public ::testing::Test {
 protected:
  // A floor brings nothing back, so what is learned about that is made up.
  GuidedVertexTest() : m_guide(guideOfFloor()), m_view(m_guide.view()) {
    m_decisions.assign(m_view.decisions, m_view.decisions + m_view.cellCount);
    for (CellDecisions& cell : m_decisions) {
      cell.survivalFactor = 2;
      cell.outgoingRadiance = {0.3f, 0.2f, 0.1f};
    }
    m_view.decisions = m_decisions.data();
    m_cached.assign(2 * size_t(m_view.cellCount), {{1, 2, 3}, 0.1f});
    m_view.cached = m_cached.data();
    m_view.rules.cachedError = 0.5f;
  }
  Place place(uint32_t depth = 2) const { return {{0.5f, 0.5f, 0}, {0, 0, 1}, 7, 3, false, depth}; }
  GuidedVertex vertex(float pixelValue = 1) const { return {m_view, place(), pixelValue}; }
  const CellDecisions& decisions() const { return m_decisions[vertex().cell()]; }

  Guide m_guide;
  GuideView m_view;
  std::vector<CellDecisions> m_decisions;
  std::vector<CachedRadiance> m_cached;
};

// A vector in double precision, as a host may have them.
struct Double3 {
  double x = 0, y = 0, z = 0;
};

Double3 unit(const Double3& v) {
  const double length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
  return {v.x / length, v.y / length, v.z / length};
}

// A host in double precision with a diffuse BSDF above +z: directions are converted where they cross the
// border.
Double3 drawDirection(const GuidedVertex& vertex, double u, double v) {
  float draw = std::min(float(u), test::kOneMinusEpsilon);
  if (vertex.drawsFromMap(draw)) {
    const Float3 wi = vertex.sampleMap(draw, std::min(float(v), test::kOneMinusEpsilon)).wi;
    return unit({wi.x, wi.y, wi.z});
  }
  const double radius = std::sqrt(double(draw)), phi = 2 * std::numbers::pi * v;
  return {radius * std::cos(phi), radius * std::sin(phi), std::sqrt(1 - double(draw))};
}
double densityOf(const GuidedVertex& vertex, const Double3& wi) {
  const double bsdf = std::max(wi.z, 0.0) / std::numbers::pi;
  return vertex.pdf({float(wi.x), float(wi.y), float(wi.z)}, float(bsdf), float(bsdf));
}

TEST_F(GuidedVertexTest, DirectionsOfAHostInDoublesHaveTheirDensity) {
  GuidedVertex vertex = this->vertex();
  vertex.prepare(1);
  ASSERT_TRUE(vertex.guides());
  ASSERT_LT(vertex.bsdfFraction(), 0.9f);
  test::Chi2Options options;
  options.quadrature = 48;
  EXPECT_TRUE(test::chi2Test(
      [&](float, float u, float v) -> std::optional<Double3> { return drawDirection(vertex, u, v); },
      [&](const auto& w) {
        return densityOf(vertex, {w.x, w.y, w.z});
      },
      options));
}

// The weights of a host's estimate of the BSDF's albedo average to it.
TEST_F(GuidedVertexTest, WeightsAverageToTheAlbedo) {
  GuidedVertex vertex = this->vertex();
  vertex.prepare(1);
  std::mt19937_64 engine(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  test::Average weight;
  for (int i = 0; i < 200000; ++i) {
    const Double3 wi = drawDirection(vertex, uniform(engine), uniform(engine));
    weight.add(std::max(wi.z, 0.0) / std::numbers::pi / densityOf(vertex, wi));
  }
  EXPECT_NEAR(weight.mean(), 1, 3 * weight.standardError());
}

// A drawn direction's density is that which is asked for afterwards, but on the very border of a texel.
TEST_F(GuidedVertexTest, DrawnDirectionsComeWithTheirDensity) {
  GuidedVertex vertex = this->vertex();
  vertex.prepare(1);
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> uniform(0, 1);
  constexpr int kSamples = 200000;
  int different = 0;
  for (int i = 0; i < kSamples; ++i) {
    const MapSample drawn = vertex.sampleMap(std::min(uniform(engine), test::kOneMinusEpsilon),
                                             std::min(uniform(engine), test::kOneMinusEpsilon));
    const float expected = vertex.pdf(drawn.wi, 0.1f, 0.1f);
    different += std::abs(vertex.pdfOf(drawn, 0.1f, 0.1f) - expected) > 1e-4f * expected;
  }
  EXPECT_LE(different, kSamples / 1000);
}

// How often each light is drawn, by both ways, is what is told of it.
TEST_F(GuidedVertexTest, LightsAreDrawnWithTheirProbability) {
  const GuidedVertex vertex = this->vertex();
  ASSERT_GT(decisions().learnedLightFraction, 0.1f);
  // Two lights of the last group, of which the host would choose one in three times of four.
  const double unguided[] = {0.1, 0.2, 0.3, 0.3, 0.1}, within[] = {1, 1, 1, 0.75, 0.25};
  const uint32_t groups[] = {0, 1, 2, 3, 3};
  constexpr int kChoices = 200000;
  int drawn[5] = {};
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (int i = 0; i < kChoices; ++i) {
    float u = std::min(uniform(engine), test::kOneMinusEpsilon);
    const uint32_t group = vertex.drawLightGroup(u);
    ASSERT_TRUE(u >= 0 && u < 1);
    int light = 0;
    if (group == kNoLightGroup)
      for (double left = u; light < 4 && left >= unguided[light]; ++light) left -= unguided[light];
    else
      light = group < 3 ? int(group) : u < 0.75f ? 3 : 4;
    ++drawn[light];
  }
  double statistic = 0, total = 0;
  for (int light = 0; light < 5; ++light) {
    const double probability =
        vertex.lightProbability(groups[light], float(unguided[light]), float(within[light]));
    total += probability;
    statistic += std::pow(drawn[light] - kChoices * probability, 2) / (kChoices * probability);
  }
  EXPECT_NEAR(total, 1, 1e-5);
  EXPECT_GT(test::chi2PValue(statistic, 4), 0.01);
  EXPECT_FLOAT_EQ(vertex.lightProbability(kNoLightGroup, 0.5f),
                  0.5f * (1 - decisions().learnedLightFraction));
}

// What stands in for a path that ends, and what makes up for it, cancel in the mean.
TEST_F(GuidedVertexTest, RouletteKeepsTheMean) {
  const GuidedVertex vertex = this->vertex(4);
  const float throughput = 0.8f, survival = vertex.survivalProbability(throughput, 0.9f);
  EXPECT_FLOAT_EQ(survival, 2 * throughput / 4);
  const Float3 ends = vertex.standIn(survival, false), goesOn = vertex.standIn(survival, true);
  EXPECT_EQ(ends.x, 0.3f);
  EXPECT_NEAR(survival * goesOn.x + (1 - survival) * ends.x, 0, 1e-6f * ends.x);
  EXPECT_EQ(vertex.standIn(1, true).x, 0);
  EXPECT_EQ(GuidedVertex(m_view, place(1), 4).survivalProbability(throughput, 0.9f), 1) << "the first vertex";
  EXPECT_LE(GuidedVertex(m_view, place(32), 1e-9f).survivalProbability(throughput, 1), 0.95f);
}

TEST_F(GuidedVertexTest, AnswersAsTheFunctionsThatItStandsFor) {
  GuidedVertex vertex = this->vertex(2);
  vertex.prepare(0.3f, 0.6f);
  ASSERT_TRUE(vertex.guides());
  EXPECT_EQ(vertex.cell(), findCell(m_view, place()));
  EXPECT_EQ(vertex.bsdfFraction(), bsdfFraction(m_view, int32_t(vertex.cell()), 0.3f));
  EXPECT_EQ(vertex.shadowRayProbability(0.02f), shadowRayProbability(m_view.rules, 0.01f));
  const SamplingMap<float> map(m_view.maps, int32_t(vertex.cell()));
  EXPECT_EQ(vertex.mapPdf(kBright), map.pdf(kBright));
  EXPECT_EQ(vertex.pdf(kBright, 0.3f, 0.2f),
            mixturePdf(0.3f, 0.2f, 0.6f, vertex.bsdfFraction(), map.pdf(kBright)));
  Float3 radiance, same;
  EXPECT_FALSE(vertex.cachedRadiance(11, 1e6f, radiance)) << "an error of .55 of the pixel's value";
  EXPECT_TRUE(vertex.cachedRadiance(9, 1e6f, radiance));
  EXPECT_TRUE(cachedRadiance(m_view, place(), vertex.cell(), 4.5f, 1e6f, same));
  EXPECT_EQ(radiance.x, 1);
  EXPECT_EQ(radiance.x, same.x);
}

TEST_F(GuidedVertexTest, DirectionsAreTheBsdfsUntilItIsPrepared) {
  GuidedVertex vertex = this->vertex();
  const auto expectUnguided = [&] {
    float u = 0.9f;
    EXPECT_FALSE(vertex.guides());
    EXPECT_FALSE(vertex.drawsFromMap(u));
    EXPECT_EQ(u, 0.9f);
    EXPECT_EQ(vertex.pdf(kBright, 0.3f, 0.2f), 0.3f);
    EXPECT_EQ(vertex.mapPdf(kBright), 0);
  };
  expectUnguided();
  vertex.prepare(1, 0);  // none of its lobes may be guided
  expectUnguided();
  vertex.prepare(0.04f);  // too sharp
  expectUnguided();
  vertex.prepare(1);
  EXPECT_TRUE(vertex.guides());
  Place mirror = place();
  mirror.discrete = true;
  vertex = GuidedVertex(m_view, mirror, 1);
  EXPECT_FALSE(vertex.isKnown());
  vertex.prepare(1);
  expectUnguided();
}

}  // namespace
}  // namespace odis::core
