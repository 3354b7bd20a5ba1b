// Choosing lights by groups that something was learned of: what is drawn is what probability() states.
#include <gtest/gtest.h>

#include <map>

#include "emitter/light_scenes.h"
#include "render/emitter/directional.h"
#include "render/emitter/point.h"
#include "render/math/distribution.h"
#include "support/chi2.h"

using namespace odis::render;
using namespace odis::test;

namespace {

constexpr double kSignificance = 0.01;
constexpr int kTests = 3 * 4 * 4 + 3 * 4;  // all calls of pValue below
const double kLeastP = 1 - std::pow(1 - kSignificance, 1.0 / kTests);

// The probability of counts at least as far from what is expected of them; cells that expect little are
// pooled.
double pValue(const std::vector<double>& counts, const std::vector<double>& expected) {
  double statistic = 0, pooledCount = 0, pooledExpected = 0;
  int cells = 0;
  const auto add = [&](double count, double mean) {
    statistic += (count - mean) * (count - mean) / mean;
    ++cells;
  };
  for (size_t i = 0; i < counts.size(); ++i) {
    if (expected[i] >= 5) {
      add(counts[i], expected[i]);
    } else {
      EXPECT_TRUE(expected[i] > 0 || counts[i] == 0) << "drawn, but impossible";
      pooledCount += counts[i];
      pooledExpected += expected[i];
    }
  }
  if (pooledExpected >= 5) add(pooledCount, pooledExpected);
  return cells > 1 ? chi2PValue(statistic, cells - 1) : 1;
}

TEST(LightGroups, FactorTheProbabilities) {
  Random random(3);
  const std::vector<LightBounds> lights = someLights(200, random);
  for (const uint32_t most : {1u, 7u, 32u, 256u}) {
    const LightTree tree(lights, most);
    EXPECT_EQ(tree.groupCount(), std::min(most, 182u));  // of 200, 18 are black
    for (int i = 0; i < 20; ++i) {
      const LightReference ref = someReference(i, random);
      std::vector<double> within(tree.groupCount(), 0.0);
      for (uint32_t light = 0; light < lights.size(); ++light) {
        const float probability = tree.probability(ref, light);
        if (lights[light].phi == 0) continue;
        const uint32_t group = tree.groupOf(light);
        ASSERT_LT(group, tree.groupCount());
        const float inGroup = tree.probabilityInGroup(ref, light);
        EXPECT_NEAR(tree.groupProbability(ref, group) * inGroup, probability, 1e-5f * probability + 1e-12f);
        within[group] += inGroup;
      }
      // Less where the bounds of several lights shine and those of one of them do not.
      for (const double sum : within) EXPECT_LT(sum, 1 + 1e-3);
    }
  }
}

TEST(LightGroups, DrawTheirOwnLights) {
  Random random(4);
  const std::vector<LightBounds> lights = someLights(100, random);
  constexpr int kDraws = 20000;
  for (const uint32_t most : {1u, 5u, 32u}) {
    const LightTree tree(lights, most);
    for (int i = 0; i < 4; ++i) {
      const LightReference ref = someReference(2 * i, random);
      for (uint32_t group = 0; group < std::min(tree.groupCount(), 4u); ++group) {
        std::vector<double> counts(lights.size() + 1, 0.0), expected(lights.size() + 1, 0.0);
        for (int d = 0; d < kDraws; ++d) {
          const LightTree::Choice choice = tree.sampleGroup(ref, group, random());
          ++counts[choice.light == LightTree::kNone ? lights.size() : choice.light];
        }
        expected.back() = kDraws;
        for (uint32_t light = 0; light < lights.size(); ++light) {
          if (lights[light].phi == 0 || tree.groupOf(light) != group) continue;
          expected[light] = kDraws * double(tree.probabilityInGroup(ref, light));
          expected.back() -= expected[light];
        }
        if (expected.back() < 1) expected.back() = 0;
        EXPECT_GT(pValue(counts, expected), kLeastP) << most << " groups, " << group;
      }
    }
  }
}

// Lights near and far, more of the latter than have groups of their own.
class LearnedLightsTest : public ::testing::Test {
 protected:
  LearnedLightsTest() {
    for (int i = 0; i < 150; ++i)
      m_points.push_back(
          std::make_unique<PointLight>(m_random.inCube(3), Rgb(1, 1, 1) * (0.1f + m_random())));
    for (int i = 0; i < 12; ++i)
      m_distant.push_back(
          std::make_unique<DirectionalLight>(m_random.direction(), Rgb(1, 1, 1) * (0.01f + m_random())));
    std::vector<Emitter*> all;
    for (const auto& light : m_distant) all.push_back(light.get());
    for (const auto& light : m_points) all.push_back(light.get());
    m_emitters = indexed(all);
    m_sampler = LightSampler(m_emitters);
  }
  // Random weights, some of them zero.
  std::vector<float> table() {
    std::vector<float> weights(m_sampler.groupCount()), cdf(weights.size() + 1);
    for (float& weight : weights) weight = m_random() < 0.3f ? 0 : m_random();
    buildCdf(weights, cdf);
    return cdf;
  }

  Random m_random{7};
  std::vector<std::unique_ptr<Emitter>> m_points, m_distant;
  std::vector<const Emitter*> m_emitters;
  LightSampler m_sampler;
};

TEST_F(LearnedLightsTest, AreDrawnAsStated) {
  constexpr int kDraws = 50000;
  EXPECT_EQ(m_sampler.groupCount(), odis::kMaxLightGroups);
  for (const float share : {0.3f, 0.9f, 0.0f})
    for (int i = 0; i < 4; ++i) {
      const std::vector<float> cdf = table();
      LightReference ref = someReference(i, m_random);
      ref.learned = {cdf.data(), share};
      std::vector<double> counts(m_emitters.size() + 1, 0.0), expected(m_emitters.size() + 1, 0.0);
      for (int d = 0; d < kDraws; ++d) {
        const LightSampler::Choice choice = m_sampler.sample(ref, m_random(), kMiddle);
        ++counts[choice.emitter ? choice.emitter->index() : m_emitters.size()];
        if (choice.emitter)
          ASSERT_NEAR(choice.probability, m_sampler.probability(ref, *choice.emitter, 0, {0.5f, 0.5f}),
                      1e-5f * choice.probability);
      }
      expected.back() = kDraws;
      for (const Emitter* emitter : m_emitters) {
        expected[emitter->index()] = kDraws * double(m_sampler.probability(ref, *emitter, 0, {0.5f, 0.5f}));
        expected.back() -= expected[emitter->index()];
      }
      if (expected.back() < 1) expected.back() = 0;
      EXPECT_GT(pValue(counts, expected), kLeastP) << share;
    }
}

// There are as many groups as emitters, or 32 if emitters are fewer and have enough parts, and never more
// than are asked for.
TEST_F(LearnedLightsTest, AreAsManyAsEmitters) {
  const auto groupsOf = [&](size_t distant, size_t points, uint32_t most = odis::kMaxLightGroups) {
    std::vector<Emitter*> some;
    for (size_t i = 0; i < distant; ++i) some.push_back(m_distant[i].get());
    for (size_t i = 0; i < points; ++i) some.push_back(m_points[i].get());
    return LightSampler(indexed(some), most).groupCount();
  };
  EXPECT_EQ(groupsOf(2, 20), 22u);
  EXPECT_EQ(groupsOf(2, 48), 50u);
  EXPECT_EQ(groupsOf(2, 150), odis::kMaxLightGroups);
  EXPECT_EQ(groupsOf(2, 150, 32), 32u);
}

TEST_F(LearnedLightsTest, PreparedReferencesSayTheSame) {
  constexpr size_t kCount = 13;  // leaves lanes unused
  const std::vector<float> cdf = table();
  std::array<LightReference, kCount> prepared, references;
  for (size_t i = 0; i < kCount; ++i) {
    references[i] = someReference(int(i), m_random);
    if (i % 2) references[i].learned = {cdf.data(), 0.4f};
    prepared[i] = references[i];
  }
  m_sampler.prepare(prepared);
  int drawn = 0;
  for (size_t i = 0; i < kCount; ++i) {
    EXPECT_GE(prepared[i].treeProbability, 0);
    for (const Emitter* emitter : m_emitters)
      EXPECT_EQ(m_sampler.probability(prepared[i], *emitter, 0, kMiddle),
                m_sampler.probability(references[i], *emitter, 0, kMiddle));
    for (int d = 0; d < 100; ++d) {
      const float u = m_random();
      const LightSampler::Choice expected = m_sampler.sample(references[i], u, kMiddle);
      const LightSampler::Choice found = m_sampler.sample(prepared[i], u, kMiddle);
      EXPECT_EQ(found.emitter, expected.emitter);
      EXPECT_EQ(found.probability, expected.probability);
      drawn += expected.emitter != nullptr;
    }
  }
  EXPECT_GT(drawn, 500);
}

TEST_F(LearnedLightsTest, GroupsAddUpToTheirLights) {
  for (int i = 0; i < 10; ++i) {
    const std::vector<float> cdf = table();
    LightReference ref = someReference(i, m_random);
    ref.learned = {cdf.data(), 0.8f};
    std::map<uint32_t, double> sums;
    std::map<uint32_t, float> stated;
    for (int d = 0; d < 2000; ++d) {
      const LightSampler::Choice choice = m_sampler.sample(ref, m_random(), kMiddle);
      if (!choice.emitter) continue;
      stated[choice.group] = m_sampler.groupProbability(ref, choice.group);
      EXPECT_NEAR(choice.groupProbability(), stated[choice.group], 1e-5f * stated[choice.group]);
    }
    // Each group's lights, found by drawing.
    std::map<const Emitter*, uint32_t> groupOf;
    for (int d = 0; d < 20000; ++d) {
      const LightSampler::Choice choice = m_sampler.sample(ref, m_random(), kMiddle);
      if (choice.emitter) groupOf[choice.emitter] = choice.group;
    }
    for (const auto& [emitter, group] : groupOf)
      sums[group] += m_sampler.probability(ref, *emitter, 0, {0.5f, 0.5f});
    for (const auto& [group, probability] : stated) EXPECT_NEAR(sums[group], probability, 0.002) << group;
  }
}

}  // namespace
