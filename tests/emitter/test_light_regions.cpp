// Environments divided into regions for choosing lights: the inverse of their sampling, and that directions
// are drawn with the density that is stated for them, whatever was learned.
#include <gtest/gtest.h>

#include "emitter/light_scenes.h"
#include "render/emitter/constant.h"
#include "render/emitter/environment_map.h"
#include "render/emitter/point.h"
#include "render/emitter/sky_dome.h"
#include "render/emitter/sun_disc.h"
#include "render/math/distribution.h"
#include "support/chi2.h"

using namespace odis::render;
using namespace odis::test;

namespace {

const Vec3 kSunDirection = normalize(Vec3(0.8f, 0.3f, 0.4f));

Matrix4 rotation() {
  Matrix4 m;
  m.rotate(Vec3(0.5f, 1.1f, -0.3f));
  return m;
}

std::unique_ptr<EnvironmentMap> roughMap(const Matrix4& toWorld, float horizon = 1) {
  std::vector<Rgb> pixels;
  for (int i = 0; i < 16 * 9; ++i)
    pixels.push_back(Rgb(float(i * 37 % 11), float(i * 17 % 5), i % 3 == 0 ? 4.0f : 0.0f));
  return std::make_unique<EnvironmentMap>(std::move(pixels), 16, 9, toWorld, horizon);
}

// Dim, but for a pixel that outshines it all.
std::unique_ptr<EnvironmentMap> sunnyMap() {
  std::vector<Rgb> pixels;
  for (int i = 0; i < 64 * 33; ++i) pixels.push_back(Rgb(1, 1, 1) * (0.1f + 0.02f * float(i % 7)));
  pixels[8 * 64 + 21] = Rgb(3000, 2500, 2000);
  return std::make_unique<EnvironmentMap>(std::move(pixels), 64, 33, rotation());
}

std::unique_ptr<SkyDome> dome(float stretch) {
  const Sky sky(3, std::acos(kSunDirection.y), Rgb(0.3f));
  return std::make_unique<SkyDome>(sky, kSunDirection, 1.0f, stretch, 16, rotation());
}

struct Named {
  const char* name;
  std::unique_ptr<EnvironmentEmitter> light;
};

std::vector<Named> environments() {
  const Matrix4 stretch(2, 0.5f, 0, 0, 0, 1, 0, 0, 0.3f, 0, -0.7f, 0, 5, 6, 7, 1);
  std::vector<Named> result;
  result.push_back({"map", roughMap(Matrix4())});
  result.push_back({"map, turned", roughMap(rotation())});
  result.push_back({"map, scaled", roughMap(stretch)});
  result.push_back({"map with a horizon", roughMap(Matrix4(), 0.4f)});
  result.push_back({"map with a sun", sunnyMap()});
  result.push_back({"sky", dome(1)});
  result.push_back({"stretched sky", dome(1.3f)});
  result.push_back({"constant", std::make_unique<ConstantEnvironment>(Rgb(1, 2, 3))});
  return result;
}

// Some groups are all that was learned of, others are forgotten.
std::vector<float> randomTable(uint32_t groups, Random& random) {
  std::vector<float> weights(groups), cdf(groups + 1);
  for (float& weight : weights) weight = random() < 0.5f ? 0 : random() * random();
  buildCdf(weights, cdf);
  return cdf;
}

LightReference learned(const std::vector<float>& cdf, float share) {
  LightReference ref{{0.1f, 0.2f, 0.3f}, {0, 0, 1}, true};
  ref.learned = {cdf.data(), share};
  return ref;
}

}  // namespace

TEST(LightRegions, InvertSampling) {
  Random random(5);
  for (const auto& [name, light] : environments()) {
    ASSERT_TRUE(light->invertible());
    int far = 0;
    for (int i = 0; i < 20000; ++i) {
      const Vec2 u(random(), random());
      const EmitterSample s = light->sample(0, {0, 0, 0}, u);
      if (!(s.pdf > 0)) continue;
      const Vec2 back = light->invert(s.wi);
      ASSERT_GE(std::min(back.x, back.y), 0) << name;
      ASSERT_LE(std::max(back.x, back.y), 1) << name;
      // What is drawn at one side of a seam or of a cell may be rounded to the other.
      if (std::abs(back.x - u.x) > 1e-3f || std::abs(back.y - u.y) > 1e-3f) ++far;
    }
    EXPECT_LE(far, 5) << name;
  }
}

TEST(LightRegions, HoldAllDirectionsThatAreNotNumbersOnSeams) {
  std::vector<Vec3> directions;
  for (const float x : {-1.0f, -0.0f, 0.0f, 1e-30f, 1.0f})
    for (const float y : {-1.0f, -0.0f, 0.0f, 1e-30f, 1.0f})
      for (const float z : {-1.0f, -0.0f, 0.0f, 1e-30f, 1.0f})
        if (std::abs(x) + std::abs(y) + std::abs(z) > 0.5f) directions.push_back(normalize(Vec3(x, y, z)));
  for (const auto& [name, light] : environments()) {
    const LightSampler sampler(indexed({light.get()}));
    std::vector<float> cdf(sampler.groupCount() + 1);
    for (size_t g = 0; g < cdf.size(); ++g) cdf[g] = float(g) / float(cdf.size() - 1);
    for (const Vec3& wi : directions)
      EXPECT_NEAR(sampler.probability(learned(cdf, 0.9f), *light, 0, light->invert(wi)), 1, 1e-5f)
          << name << wi;
  }
}

// As points of the unit square that the environment's own sampling is uniform in. A bin lies within one
// region.
TEST(LightRegions, AreDrawnWithTheirDensity) {
  constexpr int kBins = 8, kDraws = 100000;
  const std::vector<Named> all = environments();
  Random random(6);
  for (const auto& [name, light] : all) {
    const LightSampler sampler(indexed({light.get()}));
    ASSERT_EQ(sampler.groupCount(), 16u);
    for (const float share : {0.5f, 0.95f}) {
      const std::vector<float> cdf = randomTable(sampler.groupCount(), random);
      const LightReference ref = learned(cdf, share);
      std::vector<double> counts(size_t(kBins * kBins));
      for (int i = 0; i < kDraws; ++i) {
        const LightSampler::Choice drawn = sampler.sample(ref, random(), {random(), random()});
        const Vec2 u = light->invert(light->sample(drawn.part, ref.p, drawn.u).wi);
        ++counts[cellAt(u.y, kBins) * kBins + cellAt(u.x, kBins)];
      }
      double statistic = 0;
      for (size_t bin = 0; bin < counts.size(); ++bin) {
        const Vec2 center((float(bin % kBins) + 0.5f) / kBins, (float(bin / kBins) + 0.5f) / kBins);
        const Vec3 wi = light->sample(0, ref.p, center).wi;
        const double expected =
            double(kDraws) / (kBins * kBins) * sampler.probability(ref, *light, 0, light->invert(wi));
        ASSERT_GT(expected, 5);
        statistic += (counts[bin] - expected) * (counts[bin] - expected) / expected;
      }
      EXPECT_GT(chi2PValue(statistic, kBins * kBins - 1), 1 - std::pow(0.99, 0.5 / double(all.size())))
          << name << ", " << share;
    }
  }
}

// The same over directions, where regions end at borders of the test's cells.
TEST(LightRegions, DirectionsAreDrawnWithTheirDensity) {
  ConstantEnvironment light(Rgb(1, 2, 3));
  const LightSampler sampler(indexed({&light}));
  Random random(6);
  const std::vector<float> cdf = randomTable(sampler.groupCount(), random);
  const LightReference ref = learned(cdf, 0.9f);
  EXPECT_TRUE(chi2Test(
      [&](float u, float v, float choice) -> std::optional<Vec3> {
        const LightSampler::Choice drawn = sampler.sample(ref, choice, {u, v});
        return light.sample(drawn.part, ref.p, drawn.u).wi;
      },
      [&](const Vec3& w) { return light.pdf(w) * sampler.probability(ref, light, 0, light.invert(w)); }));
}

// Of each draw, sample() and probability() say the same; rounding at borders of regions aside.
TEST(LightRegions, StateTheSameAtBothEnds) {
  Random random(7);
  for (const auto& [name, light] : environments()) {
    SunDisc sun(kSunDirection, 0.01f, Rgb(10, 10, 10));
    PointLight lamp({1, 2, 3}, Rgb(2, 1, 1));
    const LightSampler sampler(indexed({&lamp, light.get(), &sun}));
    int far = 0;
    for (int table = 0; table < 8; ++table) {
      const std::vector<float> cdf = randomTable(sampler.groupCount(), random);
      const LightReference ref = learned(cdf, 0.9f);
      for (int i = 0; i < 5000; ++i) {
        const LightSampler::Choice drawn = sampler.sample(ref, random(), {random(), random()});
        const EmitterSample s = drawn.emitter->sample(drawn.part, ref.p, drawn.u);
        if (!(s.pdf > 0)) continue;
        ASSERT_GT(drawn.probability, 0);
        const float stated =
            sampler.probability(ref, *drawn.emitter, drawn.part, drawn.emitter->invert(s.wi));
        if (drawn.emitter == light.get())
          far += std::abs(stated / drawn.probability - 1) > 1e-4f;
        else
          ASSERT_NEAR(stated, drawn.probability, 1e-4f * stated);
      }
    }
    EXPECT_LE(far, 20) << "of 40000: more than rounding explains; " << name;
  }
}

// Groups are drawn as often as groupProbability() says, and these probabilities are those of one choice.
TEST(LightRegions, GroupsAreDrawnAsStated) {
  Random random(8);
  constexpr int kDraws = 100000;
  const std::vector<Named> all = environments();
  for (const auto& [name, light] : all) {
    SunDisc sun(kSunDirection, 0.01f, Rgb(10, 10, 10));
    PointLight lamp({1, 2, 3}, Rgb(2, 1, 1)), other({-2, 1, -1}, Rgb(3, 1, 1));
    const LightSampler sampler(indexed({&lamp, light.get(), &other, &sun}));
    const std::vector<float> cdf = randomTable(sampler.groupCount(), random);
    for (const float share : {0.0f, 0.8f}) {
      const LightReference ref = learned(cdf, share);
      std::vector<double> counts(sampler.groupCount());
      for (int i = 0; i < kDraws; ++i) {
        const LightSampler::Choice choice = sampler.sample(ref, random(), {random(), random()});
        ++counts[choice.group];
        const float stated = sampler.groupProbability(ref, choice.group);
        ASSERT_NEAR(choice.groupProbability(), stated, 1e-5f * stated);
      }
      double sum = 0, statistic = 0;
      for (uint32_t g = 0; g < counts.size(); ++g) {
        const double expected = kDraws * double(sampler.groupProbability(ref, g));
        sum += expected;
        ASSERT_GT(expected, 5);
        statistic += (counts[g] - expected) * (counts[g] - expected) / expected;
      }
      EXPECT_NEAR(sum, kDraws, 1e-4 * kDraws);
      EXPECT_GT(chi2PValue(statistic, int(counts.size()) - 1), 1 - std::pow(0.99, 0.5 / double(all.size())))
          << name << ", " << share;
    }
  }
}

TEST(LightRegions, LeaveSamplingAloneWhereNothingWasLearned) {
  ConstantEnvironment light(Rgb(1, 1, 1));
  const LightSampler sampler(indexed({&light}));
  Random random(9);
  for (int i = 0; i < 1000; ++i) {
    const Vec2 u(random(), random());
    const LightSampler::Choice drawn = sampler.sample(learned({}, 0), random(), u);
    EXPECT_EQ(drawn.u, u);
    EXPECT_EQ(drawn.probability, 1);
  }
}

TEST(LightRegions, LeaveGroupsToTheOthers) {
  Random random(10);
  for (const int skies : {1, 2, 3, 8, 20})
    for (const int lamps : {0, 1, 5, 100}) {
      std::vector<std::unique_ptr<Emitter>> all;
      for (int i = 0; i < skies; ++i) all.push_back(std::make_unique<ConstantEnvironment>(Rgb(1, 1, 1)));
      for (int i = 0; i < lamps; ++i)
        all.push_back(std::make_unique<PointLight>(random.inCube(3), Rgb(1, 1, 1)));
      std::vector<Emitter*> pointers;
      for (const auto& emitter : all) pointers.push_back(emitter.get());
      const LightSampler sampler(indexed(pointers));
      EXPECT_LE(sampler.groupCount(), odis::kMaxLightGroups);
      EXPECT_GE(sampler.groupCount(), uint32_t(std::min(skies, 8) + std::min(lamps, 8)));
      double sum = 0;
      const LightReference ref{{5, 5, 5}, {0, 0, 1}, true};
      for (uint32_t g = 0; g < sampler.groupCount(); ++g) sum += sampler.groupProbability(ref, g);
      EXPECT_NEAR(sum, 1, 1e-4) << skies << " skies and " << lamps << " lamps";
    }
}
