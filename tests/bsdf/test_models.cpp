// What every model must obey, whatever its parameters.
#include <gtest/gtest.h>

#include "bsdf/models.h"
#include "support/chi2.h"

namespace odis::render {
namespace {

class Models : public ::testing::TestWithParam<std::string> {
 protected:
  const Bsdf& bsdf() const { return *allModels().at(GetParam()); }
  bool has(const char* part) const { return GetParam().find(part) != std::string::npos; }
  bool isSharp() const { return has("sharp"); }
  bool isGlass() const { return has("glass") || has("dielectric"); }
  SurfacePoint m_at = flatPoint();
};

test::Chi2Options chi2Options(bool narrow) {
  test::Chi2Options options;
  options.thetaCells = 16;
  options.phiCells = 32;
  options.samples = 50000;
  options.quadrature = narrow ? 40 : 10;
  options.testCount = 300;
  return options;
}

TEST_P(Models, SamplesFollowTheDensity) {
  if (!bsdf().traits().evaluable) GTEST_SKIP() << "only discrete directions";
  for (const Vec3& wo : outgoing(GetParam())) {
    const auto sample = [&](float u0, float u1, float u2) -> std::optional<Vec3> {
      const BsdfSample s = bsdf().sample(m_at, wo, u0, {u1, u2});
      return s.lobe == Lobe::none || isDiscrete(s.lobe) ? std::nullopt : std::optional(s.wi);
    };
    const auto pdf = [&](const Vec3& wi) { return bsdf().evaluate(m_at, wo, wi).pdf; };
    EXPECT_TRUE(test::chi2Test(sample, pdf, chi2Options(isSharp() || isGlass()))) << "wo = " << wo;
  }
}

TEST_P(Models, SmoothSamplesFollowTheGuidableDensity) {
  if (!bsdf().traits().evaluable) GTEST_SKIP() << "only discrete directions";
  for (const Vec3& wo : outgoing(GetParam())) {
    const auto sample = [&](float u0, float u1, float u2) -> std::optional<Vec3> {
      const BsdfSample s = bsdf().sample(m_at, wo, u0, {u1, u2});
      return s.lobe == Lobe::smooth ? std::optional(s.wi) : std::nullopt;
    };
    const auto pdf = [&](const Vec3& wi) { return bsdf().evaluate(m_at, wo, wi).guidablePdf; };
    EXPECT_TRUE(test::chi2Test(sample, pdf, chi2Options(isGlass()))) << "wo = " << wo;
  }
}

TEST_P(Models, LobesAreChosenOnlyBySomeThatSaySo) {
  if (bsdf().traits().choosesLobes) GTEST_SKIP() << "chooses lobes";
  Uniform uniform(11);
  for (const Vec3& wo : outgoing(GetParam()))
    for (int i = 0; i < 200; ++i) {
      const Vec2 u = uniform.next2();
      const BsdfSample a = bsdf().sample(m_at, wo, 0, u), b = bsdf().sample(m_at, wo, uniform.next(), u);
      EXPECT_EQ(a.wi, b.wi);
      EXPECT_EQ(a.weight, b.weight);
      EXPECT_EQ(a.lobe, b.lobe);
    }
}

TEST_P(Models, NullTransmissionIsTheMeanOfWhatPassesStraight) {
  for (const Vec3& wo : outgoing(GetParam())) {
    const Rgb expected = bsdf().nullTransmission(m_at, wo);
    if (!bsdf().traits().passesStraight) {
      EXPECT_EQ(expected, Rgb(0.0f));
      continue;
    }
    Uniform uniform(13);
    constexpr int kCount = 20000;
    Rgbd sum(0, 0, 0);
    for (int i = 0; i < kCount; ++i) {
      const float u = uniform.next();
      const BsdfSample s = bsdf().sample(m_at, wo, u, uniform.next2());
      if (s.lobe == Lobe::null) sum += Rgbd(s.weight.x, s.weight.y, s.weight.z);
    }
    // Weights are at most 1, so that a mean has a standard error of .5 / sqrt(count) at most: five of these.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / kCount, expected[c], 2.5 / std::sqrt(kCount));
  }
}

TEST_P(Models, WeightIsValueOverDensity) {
  Uniform uniform(7);
  for (const Vec3& wo : outgoing(GetParam()))
    for (int i = 0; i < 2000; ++i) {
      const float u = uniform.next();
      const BsdfSample s = bsdf().sample(m_at, wo, u, uniform.next2());
      if (s.lobe == Lobe::none) {
        EXPECT_EQ(s.weight, Rgb(0.0f));
        continue;
      }
      EXPECT_NEAR(length(s.wi), 1, 1e-4f);
      ASSERT_GT(s.pdf, 0);
      if (isDiscrete(s.lobe)) {
        EXPECT_EQ(s.guidablePdf, 0);
        EXPECT_LE(s.pdf, 1);
        continue;
      }
      const BsdfValue v = bsdf().evaluate(m_at, wo, s.wi);
      // Rounding of a direction that was turned there and back moves it on sharp lobes.
      const float tolerance = isSharp() ? 2e-2f : 1e-3f;
      EXPECT_NEAR(s.pdf / v.pdf, 1, tolerance) << "wo = " << wo << ", wi = " << s.wi;
      EXPECT_NEAR(s.guidablePdf, v.guidablePdf, tolerance * v.pdf);
      EXPECT_LE(v.guidablePdf, v.pdf * (1 + 1e-5f));
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(s.weight[c] * s.pdf, v.value[c], tolerance * v.value[c] + 1e-6f);
      // What is thin, or crossed as a whole, has the same medium on both sides.
      if (has("thin") || has("hair"))
        EXPECT_EQ(s.eta, 1);
      else
        EXPECT_EQ(s.wi.z * wo.z < 0, s.eta != 1 && bsdf().traits().transmissive) << "eta = " << s.eta;
    }
}

// Monte Carlo with cosine-free uniform directions against the model's own sampling, so that a weight that is
// wrong by a constant shows; and energy is conserved.
TEST_P(Models, AlbedoAgreesWithUniformSamplingAndIsAtMostOne) {
  for (const Vec3& wo : outgoing(GetParam())) {
    Uniform uniform(11);
    const int count = isSharp() ? 400000 : 60000;
    double sampled = 0, sampled2 = 0, discrete = 0, uniformSum = 0, uniform2 = 0;
    for (int i = 0; i < count; ++i) {
      const float u = uniform.next();
      const BsdfSample s = bsdf().sample(m_at, wo, u, uniform.next2());
      // Transmission into the denser medium compresses radiance by eta^2, and expands it on the way out.
      const double weight = average(s.weight), energy = weight * s.eta * s.eta;
      if (isDiscrete(s.lobe))
        discrete += energy;
      else
        sampled += weight, sampled2 += weight * weight, discrete += energy - weight;
      const double value =
          average(bsdf().evaluate(m_at, wo, squareToSphere(uniform.next2())).value) * 4 * kPi;
      uniformSum += value;
      uniform2 += value * value;
    }
    const auto variance = [&](double sum, double squares) {
      return std::max(0.0, squares / count - sum / count * (sum / count)) / count;
    };
    const double sigma = std::sqrt(variance(sampled, sampled2) + variance(uniformSum, uniform2));
    EXPECT_NEAR(sampled / count, uniformSum / count, 4.5 * sigma + 1e-4) << "wo = " << wo;
    EXPECT_LE((sampled + discrete) / count, 1.005 + 4 * std::sqrt(variance(sampled, sampled2)))
        << "wo = " << wo;
  }
}

TEST_P(Models, GuidableProbabilityIsTheShareOfSmoothDraws) {
  Uniform uniform(13);
  const int count = 40000;
  for (const Vec3& wo : outgoing(GetParam())) {
    int smooth = 0, failed = 0;
    for (int i = 0; i < count; ++i) {
      const float u = uniform.next();
      const Lobe lobe = bsdf().sample(m_at, wo, u, uniform.next2()).lobe;
      smooth += lobe == Lobe::smooth;
      failed += lobe == Lobe::none;
    }
    // A failed draw does not tell its lobe.
    const float probability = bsdf().guidableProbability(m_at, wo);
    const float margin = 4.5f * std::sqrt(std::max(probability * (1 - probability), 1e-6f) / count) + 1e-5f;
    EXPECT_GE(probability, float(smooth) / count - margin) << "wo = " << wo;
    EXPECT_LE(probability, float(smooth + failed) / count + margin) << "wo = " << wo;
  }
}

TEST_P(Models, IsReciprocal) {
  if (has("normalmap")) GTEST_SKIP() << "perturbed frames are not reciprocal";
  if (has("measured_cloth") || has("measured_velvet")) GTEST_SKIP() << "measurements may be anything";
  if (has("hair")) GTEST_SKIP() << "the tilt of scales is not reciprocal";
  // Light on the back of an opaque surface meets another BSDF.
  if (GetParam() == "twosided_two") GTEST_SKIP() << "two BSDFs";
  Uniform uniform(17);
  const bool glass = isGlass();
  float eta2 = 1;  // square of the inside's index over the outside's, measured by a refracted sample
  for (int i = 0; glass && eta2 == 1 && i < 1000; ++i) {
    const float u = uniform.next();
    eta2 = sqr(bsdf().sample(m_at, direction(0.9f, 1), u, uniform.next2()).eta);
  }
  for (int i = 0; i < 2000; ++i) {
    Vec3 wo = squareToSphere(uniform.next2()), wi = squareToSphere(uniform.next2());
    if (!glass) wo.z = std::abs(wo.z), wi.z = std::abs(wi.z);
    if (std::abs(wo.z) < 0.05f || std::abs(wi.z) < 0.05f) continue;
    // Mitsuba leaves out some transmission through thin facets, by a rule that is not symmetric.
    if (GetParam() == "principledthin_glass" && wo.z * wi.z < 0) continue;
    const Rgb a = bsdf().evaluate(m_at, wo, wi).value / std::abs(wi.z);
    const Rgb b = bsdf().evaluate(m_at, wi, wo).value / std::abs(wo.z);
    const float indexO = wo.z > 0 ? 1 : eta2, indexI = wi.z > 0 ? 1 : eta2;
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(a[c] / indexO, b[c] / indexI, 2e-3f * std::max(a[c] / indexO, b[c] / indexI) + 1e-5f)
          << wo << " " << wi;
  }
}

TEST_P(Models, ScattersNothingBehindAnOpaqueSurface) {
  if (bsdf().traits().transmissive) GTEST_SKIP() << "transmits";
  if (has("normalmap"))
    GTEST_SKIP() << "the perturbed surface may show its front where the original shows its back";
  Uniform uniform(19);
  const bool twoSided = has("twosided");
  for (int i = 0; i < 1000; ++i) {
    const Vec3 wo = squareToSphere(uniform.next2()), wi = squareToSphere(uniform.next2());
    if (wo.z > 0 && wi.z > 0) continue;
    if (twoSided && wo.z < 0 && wi.z < 0) continue;
    const BsdfValue v = bsdf().evaluate(m_at, wo, wi);
    EXPECT_EQ(v.value, Rgb(0.0f));
    EXPECT_EQ(v.pdf, 0);
    if (wo.z > 0 || twoSided) continue;
    const float u = uniform.next();
    EXPECT_EQ(bsdf().sample(m_at, wo, u, uniform.next2()).lobe, Lobe::none);
    EXPECT_EQ(bsdf().guidableProbability(m_at, wo), 0);
  }
}

TEST_P(Models, StaysFiniteAtTheEdges) {
  for (const float cosine : {1.0f, 1e-3f, 1e-6f, 0.0f, -1e-6f, -1.0f})
    for (const float u : {0.0f, 1e-7f, 0.5f, kOneMinusEpsilon})
      for (const float v : {0.0f, 0.25f, kOneMinusEpsilon})
        for (const float lobe : {0.0f, 0.5f, kOneMinusEpsilon}) {
          const Vec3 wo = direction(cosine, 1);
          const BsdfSample s = bsdf().sample(m_at, wo, lobe, {u, v});
          EXPECT_TRUE(isFinite(s.weight) && isFinite(s.wi) && std::isfinite(s.pdf)) << "wo = " << wo;
          const BsdfValue value = bsdf().evaluate(m_at, wo, direction(v, 6 * u));
          EXPECT_TRUE(isFinite(value.value) && std::isfinite(value.pdf)) << "wo = " << wo;
          const BsdfFeatures features = bsdf().features(m_at, wo);
          EXPECT_TRUE(isFinite(features.albedo) && features.roughness >= 0 && features.roughness <= 1);
          EXPECT_TRUE(features.albedo == clampUnit(features.albedo));
          EXPECT_EQ(bsdf().roughness(m_at, wo), features.roughness);
        }
}

INSTANTIATE_TEST_SUITE_P(All, Models, ::testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const auto& entry : allModels()) names.push_back(entry.first);
                           return names;
                         }()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace odis::render
