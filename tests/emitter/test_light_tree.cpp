// The choice among lights: what is drawn is what probability() states, and no light that shines is left out.
#include <gtest/gtest.h>

#include "emitter/light_scenes.h"
#include "render/emitter/area.h"
#include "render/emitter/constant.h"
#include "render/emitter/directional.h"
#include "render/emitter/light_sampler.h"
#include "render/emitter/point.h"
#include "render/emitter/projector.h"
#include "render/emitter/spot.h"
#include "render/math/warp.h"
#include "render/shape/mesh.h"
#include "render/shape/sphere.h"
#include "render/texture/constant.h"
#include "support/chi2.h"

using namespace odis::render;
using namespace odis::test;

namespace {

std::shared_ptr<Mesh> soup(int triangles, float size, Random& random) {
  MeshData data;
  for (int i = 0; i < triangles; ++i) {
    const Vec3 center = random.inCube(10);
    for (int corner = 0; corner < 3; ++corner) {
      data.positions.push_back(center + random.inCube(size));
      data.normals.push_back({0, 0, 0});  // the triangle's own
    }
    const auto first = uint32_t(3 * i);
    data.triangles.push_back({first, first + 1, first + 2});
  }
  Warnings warnings;
  return Mesh::make(std::move(data), {}, {}, warnings);
}

TexturePtr uniform(float radiance) {
  return std::make_shared<ConstantTexture>(Rgb(radiance, radiance, radiance));
}

// The sum of the probabilities of all parts, and of those whose part lies wholly behind the reference or
// looks away.
double totalProbability(const LightSampler& sampler, const std::vector<const Emitter*>& emitters,
                        const LightReference& ref) {
  double sum = 0;
  for (const Emitter* emitter : emitters)
    for (uint32_t part = 0; part < std::max(emitter->partCount(), 1u); ++part)
      sum += sampler.probability(ref, *emitter, part, kMiddle);
  return sum;
}

}  // namespace

TEST(LightTree, ProbabilitiesSumToOneAndAreSampled) {
  constexpr int kReferences = 40, kDraws = 20000;
  Random random(1);
  for (const int count : {1, 2, 3, 17, 300}) {
    const std::vector<LightBounds> lights = someLights(count, random);
    const LightTree tree(lights);
    for (int r = 0; r < kReferences; ++r) {
      const LightReference ref = someReference(r, random);
      std::vector<double> expected(lights.size()), observed(lights.size());
      double total = 0;
      for (uint32_t i = 0; i < lights.size(); ++i) {
        expected[i] = tree.probability(ref, i);
        if (lights[i].phi == 0) EXPECT_EQ(expected[i], 0);
        total += expected[i];
      }
      double failed = 0;
      for (int i = 0; i < kDraws; ++i) {
        const LightTree::Choice choice = tree.sample(ref, random());
        if (choice.light == LightTree::kNone) {
          ++failed;
          continue;
        }
        ASSERT_LT(choice.light, lights.size());
        ASSERT_FLOAT_EQ(choice.probability, tree.probability(ref, choice.light));
        ++observed[choice.light];
      }
      // A light is missed only where the bounds of several shone and those of one do not.
      EXPECT_LT(total, 1 + 1e-5);
      EXPECT_NEAR(failed / kDraws, 1 - total, 5 * std::sqrt(std::max(total * (1 - total), 1e-9) / kDraws));
      double statistic = 0, restExpected = 0, restObserved = 0;
      int degrees = -1;
      for (size_t i = 0; i < lights.size(); ++i) {
        const double e = expected[i] * kDraws;
        if (e < 5) {
          restExpected += e;
          restObserved += observed[i];
          continue;
        }
        statistic += (observed[i] - e) * (observed[i] - e) / e;
        ++degrees;
      }
      if (restExpected > 5) {
        statistic += (restObserved - restExpected) * (restObserved - restExpected) / restExpected;
        ++degrees;
      }
      if (failed > 5) ++degrees;
      if (degrees < 1) continue;
      EXPECT_GT(odis::test::chi2PValue(statistic, degrees), 0.01 / (5 * kReferences)) << count << " lights";
    }
  }
}

// Whatever irradiance a light gives a surface, it can be drawn for it. Probabilities of zero are allowed to
// lights that give nothing.
TEST(LightTree, EveryLightThatShinesCanBeDrawn) {
  Random random(2);
  const auto mesh = soup(60, 0.5f, random);
  AreaLight area(*mesh, uniform(1));
  const Sphere ball({1, 2, 3}, 2, {Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)}, false);
  AreaLight round(ball, uniform(0.01f));
  PointLight point({0, -1, 2}, Rgb(1e-4f, 0, 0));
  SpotLight narrow(Matrix4(0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, -3, 0, 0, 1), Rgb(1, 1, 1),
                   {0.4f, 0.1f, nullptr}),
      wide(Matrix4(0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 3, 0, 0, 1), Rgb(1, 1, 1), {2.5f, 0, nullptr});
  Projector image(Matrix4(0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -2, 0, 1), uniform(1), {0.7f, 0.4f, 1});
  ConstantEnvironment sky(Rgb(1e-3f, 0, 0));
  const auto emitters = indexed({&area, &round, &point, &narrow, &wide, &image, &sky});
  const LightSampler sampler(emitters);
  int shining = 0, excluded = 0;
  for (int i = 0; i < 400; ++i) {
    LightReference ref = someReference(i, random);
    ref.p *= i % 4 == 0 ? 4.0f : 1.0f;
    EXPECT_LT(totalProbability(sampler, emitters, ref), 1 + 1e-5);
    for (const Emitter* emitter : emitters)
      for (uint32_t part = 0; part < std::max(emitter->partCount(), 1u); ++part) {
        const float probability = sampler.probability(ref, *emitter, part, kMiddle);
        excluded += probability == 0;
        for (int k = 0; k < 20; ++k) {
          const EmitterSample s = emitter->sample(part, ref.p, {random(), random()});
          if (!(s.pdf > 0) || isBlack(s.radiance) || !(dot(s.wi, ref.n) > 1e-5f || ref.both)) continue;
          ++shining;
          ASSERT_GT(probability, 0) << "reference " << i << ", part " << part;
        }
      }
  }
  EXPECT_GT(shining, 100000);
  EXPECT_GT(excluded, 2000) << "lights that look away are worth leaving out";
}

// What docs/figures.md says of memory: a leaf of a mesh, and a light that is an emitter of its own.
TEST(LightTree, TakesSoManyBytesALight) {
  constexpr int kLights = 4096, kLeafBytes = 77, kEmitterBytes = 98;
  Random random(3);
  const auto mesh = soup(kLights, 0.1f, random);
  AreaLight area(*mesh, uniform(1));
  EXPECT_NEAR(double(LightSampler(indexed({&area})).bytes()) / kLights, kLeafBytes, 1);

  std::vector<PointLight> points;
  for (int i = 0; i < kLights; ++i) points.emplace_back(random.inCube(10), Rgb(1, 1, 1));
  std::vector<Emitter*> all;
  for (PointLight& point : points) all.push_back(&point);
  EXPECT_NEAR(double(LightSampler(indexed(all)).bytes()) / kLights, kEmitterBytes, 1);
}

TEST(LightTree, LightsThatLookAwayOrLieBehindAreLeftOut) {
  std::vector<LightBounds> lights(3);
  // All face down: one above, one below; a third beyond the horizon.
  lights[0] = {.min = {-1, -1, 5}, .max = {1, 1, 5}, .axis = {0, 0, -1}, .phi = 1};
  lights[1] = {.min = {-1, -1, -5}, .max = {1, 1, -5}, .axis = {0, 0, -1}, .phi = 1000};
  lights[2] = {.min = {9, 9, -2}, .max = {9, 9, -2}, .axis = {0, 0, -1}, .thetaO = kPi, .phi = 1000};
  const LightTree tree(lights);
  const LightReference up{{0, 0, 0}, {0, 0, 1}, false}, down{{0, 0, 0}, {0, 0, -1}, false};
  EXPECT_EQ(tree.probability(up, 0), 1);
  EXPECT_GT(tree.probability(down, 2), 0);
  EXPECT_EQ(tree.probability(down, 0) + tree.probability(down, 1), 0);
  const LightReference through{{0, 0, 0}, {0, 0, 1}, true};
  EXPECT_GT(tree.probability(through, 0), 0);
  EXPECT_EQ(tree.probability(through, 1), 0);
  EXPECT_GT(tree.probability(through, 2), 0);
  // Nothing at all shines upwards from below.
  const std::vector<LightBounds> below = {lights[1], lights[1]};
  EXPECT_EQ(LightTree(below).sample(up, 0.5f).light, LightTree::kNone);
}

TEST(LightTree, PrefersTheNearAndTheBright) {
  std::vector<LightBounds> lights(4);
  for (int i = 0; i < 4; ++i) {
    lights[size_t(i)].min = lights[size_t(i)].max = Vec3(float(i) * 10, 0, 1);
    lights[size_t(i)].thetaO = kPi;
    lights[size_t(i)].phi = 1;
  }
  const LightTree tree(lights);
  const LightReference ref{{0, 0, 0}, {0, 0, 1}, false};
  EXPECT_GT(tree.probability(ref, 0), 0.9f);
  lights[1].phi = 1e5f;
  EXPECT_GT(LightTree(lights).probability(ref, 1), 0.9f);
}

// Two hundred thousand triangles: the tree is whole, of logarithmic depth in effect, and of the stated size.
TEST(LightTree, HoldsHundredsOfThousandsOfTriangles) {
  Random random(3);
  constexpr int kTriangles = 200000;
  const auto mesh = soup(kTriangles, 0.02f, random);
  AreaLight light(*mesh, uniform(1));
  const auto emitters = indexed({&light});
  const LightSampler sampler(emitters);
  EXPECT_LE(sampler.bytes(), 80u * kTriangles);
  for (int i = 0; i < 3; ++i) {
    const LightReference ref = someReference(0, random);
    // The rest goes to groups of which no triangle faces the reference.
    EXPECT_NEAR(totalProbability(sampler, emitters, ref), 1, 0.1);
    double away = 0;
    for (int k = 0; k < 1000; ++k) {
      const LightSampler::Choice choice = sampler.sample(ref, random(), kMiddle);
      if (!choice.emitter) {
        ++away;
        continue;
      }
      EXPECT_FLOAT_EQ(choice.probability, sampler.probability(ref, light, choice.part, kMiddle));
    }
    EXPECT_LT(away, 130);
  }
}

// Lights in one place, on a line, and of absurd powers.
TEST(LightTree, DegenerateLightsAreAllDrawn) {
  std::vector<LightBounds> lights;
  for (int i = 0; i < 2000; ++i) {
    LightBounds light;
    light.min = light.max = i % 2 == 0 ? Vec3(1, 1, 1) : Vec3(std::ldexp(1.0f, -i / 20), 0, 0);
    light.thetaO = kPi;
    light.phi = i % 100 == 1 ? 1e28f : i % 100 == 2 ? 1e-30f : 1.0f;
    lights.push_back(light);
  }
  const LightTree tree(lights);
  for (const Vec3& p : {Vec3(1, 1, 1), Vec3(0, 0, 0), Vec3(0, 0, -1e6f)}) {
    double total = 0;
    for (uint32_t i = 0; i < lights.size(); ++i) {
      const float probability = tree.probability({p, {0, 0, 1}, true}, i);
      EXPECT_TRUE(std::isfinite(probability));
      total += probability;
    }
    EXPECT_NEAR(total, 1, 1e-4);
  }
}

TEST(LightSampler, OneLightIsAlwaysChosen) {
  PointLight point({0, 0, -1}, Rgb(1, 1, 1));
  DirectionalLight sun({0, 0, 1}, Rgb(1, 1, 1));
  ConstantEnvironment sky(Rgb(1, 1, 1));
  for (Emitter* emitter : std::vector<Emitter*>{&point, &sun, &sky}) {
    const LightSampler sampler(indexed({emitter}));
    const LightReference ref{{0, 0, 0}, {0, 0, 1}, false};
    EXPECT_EQ(sampler.sample(ref, 0.999f, kMiddle).emitter, emitter);
    EXPECT_EQ(sampler.sample(ref, 0.999f, kMiddle).probability, 1);
    EXPECT_EQ(sampler.probability(ref, *emitter, 0, kMiddle), 1);
  }
}

TEST(LightSampler, NoLightIsNone) {
  const LightReference ref;
  EXPECT_EQ(LightSampler().sample(ref, 0.5f, kMiddle).emitter, nullptr);
  EXPECT_EQ(LightSampler(std::vector<const Emitter*>()).sample(ref, 0.5f, kMiddle).emitter, nullptr);
  PointLight dark({0, 0, 0}, Rgb(0, 0, 0));
  EXPECT_EQ(LightSampler(indexed({&dark})).sample(ref, 0.5f, kMiddle).emitter, nullptr);
}

// A tenth evenly, the rest by irradiance; an absurd one leaves the others their tenth.
TEST(LightSampler, DistantLightsAreChosenByIrradiance) {
  DirectionalLight weak({0, 0, -1}, Rgb(1, 1, 1)), strong({0, 0, -1}, Rgb(3, 3, 3)),
      endless({0, 0, -1}, Rgb(kInfinity, 1, 1));
  const LightReference ref{{0, 0, 0}, {0, 0, 1}, false};
  const LightSampler two(indexed({&weak, &strong}));
  EXPECT_NEAR(two.probability(ref, weak, 0, kMiddle), 0.05 + 0.9 * 0.25, 1e-6);
  EXPECT_NEAR(two.probability(ref, strong, 0, kMiddle), 0.05 + 0.9 * 0.75, 1e-6);
  const LightSampler absurd(indexed({&strong, &endless}));
  EXPECT_NEAR(absurd.probability(ref, strong, 0, kMiddle), 0.05, 1e-6);

  // Near a lamp the lamp is chosen, far away the sky, and one of them always.
  PointLight a({1, 0, 1}, Rgb(1, 1, 1)), b({-1, 0, 1}, Rgb(1, 1, 1));
  const auto emitters = indexed({&weak, &a, &b});
  const LightSampler mixed(emitters);
  const LightReference near{{1, 0, 0.99f}, {0, 0, 1}, false}, far{{0, 0, -100}, {0, 0, 1}, false};
  EXPECT_GT(mixed.probability(near, a, 0, kMiddle), 0.8f);
  EXPECT_GT(mixed.probability(far, weak, 0, kMiddle), 0.9f);
  EXPECT_EQ(mixed.probability({{0, 0, 5}, {0, 0, 1}, false}, weak, 0, kMiddle), 1);
  EXPECT_NEAR(totalProbability(mixed, emitters, ref), 1, 1e-6);
  EXPECT_NEAR(mixed.probability(ref, a, 0, kMiddle), mixed.probability(ref, b, 0, kMiddle), 1e-6);
  double counts[3] = {};
  Random random(4);
  for (int i = 0; i < 30000; ++i) ++counts[mixed.sample(ref, random(), kMiddle).emitter->index()];
  double statistic = 0;
  for (const Emitter* emitter : emitters) {
    const double e = 30000 * mixed.probability(ref, *emitter, 0, kMiddle);
    statistic += (counts[emitter->index()] - e) * (counts[emitter->index()] - e) / e;
  }
  EXPECT_GT(odis::test::chi2PValue(statistic, 2), 0.01);
}
