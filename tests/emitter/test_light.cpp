// Point, spot, directional and area lights.
#include <gtest/gtest.h>

#include "render/emitter/area.h"
#include "render/emitter/directional.h"
#include "render/emitter/point.h"
#include "render/emitter/projector.h"
#include "render/emitter/spot.h"
#include "render/sensor/perspective.h"
#include "render/shape/shape.h"
#include "support/chi2.h"

using namespace odis::render;
using odis::test::Chi2Options;
using odis::test::chi2Test;

namespace {

// The square [-1, 1]^2 at height 1 that faces down, sampled by area; uv runs from 0 to 1 along x and y.
class CeilingLamp final : public Shape {
 public:
  RTCGeometryTy* makeGeometry(RTCDeviceTy*) const override { return nullptr; }
  SurfacePoint surfacePoint(const Ray&, const RawHit&) const override { return {}; }
  float area() const override { return 4; }
  PrimitiveExtent extent(uint32_t) const override {
    return {.min = {-1, -1, 1}, .max = {1, 1, 1}, .axis = {0, 0, -1}, .theta = 0, .area = 4};
  }
  ShapeSample sample(const Vec3& ref, const Vec2& u) const override {
    ShapeSample s;
    s.at = at(u);
    const Vec3 d = s.at.p - ref;
    s.distance = length(d);
    s.wi = d / s.distance;
    s.pdf = pdf(ref, s.at);
    return s;
  }
  float pdf(const Vec3& ref, const SurfacePoint& point) const override {
    const Vec3 d = point.p - ref;
    const float cosine = std::abs(d.z) / length(d);
    return cosine > 0 ? lengthSquared(d) / (cosine * area()) : 0;
  }
  static SurfacePoint at(const Vec2& uv) {
    SurfacePoint point;
    point.p = {2 * uv.x - 1, 2 * uv.y - 1, 1};
    point.ng = {0, 0, -1};
    point.shading = CoordinateFrame(point.ng);
    point.uv = uv;
    return point;
  }
  // The point of the lamp in direction w from ref, if there is one.
  static std::optional<SurfacePoint> hit(const Vec3& ref, const Vec3& w) {
    const float t = (1 - ref.z) / w.z;
    if (!(t > 0)) return std::nullopt;
    const Vec2 uv((ref.x + t * w.x + 1) / 2, (ref.y + t * w.y + 1) / 2);
    if (uv.x < 0 || uv.x > 1 || uv.y < 0 || uv.y > 1) return std::nullopt;
    return at(uv);
  }
};

class Plain final : public Texture {
 public:
  explicit Plain(const Rgb& value) : m_value(value) {}
  Rgb rgb(const Vec2&) const override { return m_value; }
  Rgb mean() const override { return m_value; }

 private:
  Rgb m_value;
};

// Red grows along u; a dark half in v.
class Pattern final : public Texture {
 public:
  Rgb rgb(const Vec2& uv) const override { return uv.y < 0.5f ? Rgb(4 * uv.x, 1, 0) : Rgb(0, 0, 0); }
  Rgb mean() const override { return {1, 0.5f, 0}; }
};

template <class F>
void forUniform(int samples, F&& f) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (int i = 0; i < samples; ++i) {
    const float x = uniform(engine), y = uniform(engine);
    f(Vec2(x, y));
  }
}

}  // namespace

TEST(AreaLight, SamplesItsDensity) {
  CeilingLamp lamp;
  const AreaLight light(lamp, std::make_shared<Plain>(Rgb(1, 1, 1)));
  const Vec3 ref(0.3f, -0.2f, 0.1f);
  Chi2Options options;
  options.quadrature = 24;
  EXPECT_TRUE(chi2Test(
      [&](float u, float v, float) {
        return light.sample(0, ref, {u, v}).wi;
      },
      [&](const Vec3& w) {
        const auto at = CeilingLamp::hit(ref, w);
        return at ? light.pdf(ref, *at) : 0.0f;
      },
      options));
}

// Irradiance upon a small horizontal surface, against the integral over the lamp of L cos^2 / d^2 dA.
TEST(AreaLight, TexturedIrradianceAgreesWithQuadrature) {
  CeilingLamp lamp;
  const Pattern pattern;
  const AreaLight light(lamp, std::make_shared<Pattern>());
  const Vec3 ref(0.4f, -0.5f, -0.3f);
  Rgb expected(0, 0, 0);
  constexpr int n = 400;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const Vec2 uv((float(i) + 0.5f) / n, (float(j) + 0.5f) / n);
      const Vec3 d = CeilingLamp::at(uv).p - ref;
      expected += pattern.rgb(uv) * (d.z * d.z / sqr(lengthSquared(d)) * 4 / (n * n));
    }
  double sum[2] = {}, squares[2] = {};
  constexpr int samples = 200000;
  forUniform(samples, [&](const Vec2& u) {
    const EmitterSample s = light.sample(0, ref, u);
    for (int c = 0; c < 2; ++c) {
      const double value = s.radiance[c] * s.wi.z / s.pdf;
      sum[c] += value;
      squares[c] += value * value;
    }
  });
  for (int c = 0; c < 2; ++c) {
    const double mean = sum[c] / samples,
                 deviation = std::sqrt((squares[c] / samples - mean * mean) / samples);
    EXPECT_NEAR(mean, expected[c], 4 * deviation + 1e-4);
  }
}

TEST(AreaLight, IsDarkBehind) {
  CeilingLamp lamp;
  const AreaLight light(lamp, std::make_shared<Plain>(Rgb(2, 3, 4)));
  EXPECT_EQ(light.radiance(CeilingLamp::at({0.5f, 0.5f}), {0, 0, -1}), Rgb(2, 3, 4));
  EXPECT_EQ(light.radiance(CeilingLamp::at({0.5f, 0.5f}), {0, 0, 1}), Rgb(0, 0, 0));
  EXPECT_TRUE(isBlack(light.sample(0, {0, 0, 5}, {0.5f, 0.5f}).radiance));
  EXPECT_FALSE(isBlack(light.sample(0, {0, 0, -5}, {0.5f, 0.5f}).radiance));
  EXPECT_FLOAT_EQ(light.bounds(0).phi, 4 * 3);  // area 4, average radiance 3
}

// Twice as far, a quarter of the irradiance.
TEST(PointLight, FollowsTheInverseSquare) {
  const PointLight light({1, 2, 3}, Rgb(8, 4, 2));
  const EmitterSample s = light.sample(0, {1, 2, 5}, {0, 0});
  EXPECT_EQ(s.wi, Vec3(0, 0, -1));
  EXPECT_EQ(s.distance, 2);
  EXPECT_EQ(s.radiance, Rgb(2, 1, 0.5f));
  EXPECT_EQ(s.pdf, 1);
  EXPECT_TRUE(s.delta);
  EXPECT_EQ(light.sample(0, {1, 2, 3}, {0, 0}).pdf, 0) << "at the light itself";
  EXPECT_NEAR(light.bounds(0).phi * axialIntensity(kPi), 14.0 / 3, 1e-4);
}

TEST(DirectionalLight, IsTheSameEverywhere) {
  DirectionalLight light({0, 0, 1}, Rgb(1, 2, 3));
  for (const Vec3& ref : {Vec3(0, 0, 0), Vec3(100, -5, 3)}) {
    const EmitterSample s = light.sample(0, ref, {0.2f, 0.8f});
    EXPECT_EQ(s.wi, Vec3(0, 0, -1));
    EXPECT_EQ(s.distance, kInfinity);
    EXPECT_EQ(s.radiance, Rgb(1, 2, 3));
    EXPECT_TRUE(s.delta);
  }
  EXPECT_NEAR(light.meanIrradiance(), 0.5, 1e-6);  // the mean of max(0, cos) over all directions is 1/4
}

// Full to 20 degrees, none from 30 on, half in the middle of the ring, at a distance of 2.
TEST(SpotLight, FallsOffLinearlyInAngle) {
  constexpr float kDegree = kPi / 180;
  const SpotLight light(Matrix4(), Rgb(4, 4, 4), {30 * kDegree, 20 * kDegree, nullptr});
  const auto irradiance = [&](float degrees) {
    const EmitterSample s =
        light.sample(0, {2 * std::sin(degrees * kDegree), 0, 2 * std::cos(degrees * kDegree)}, {0, 0});
    EXPECT_EQ(s.pdf > 0, degrees < 30);
    return s.radiance.x;
  };
  EXPECT_NEAR(irradiance(0), 1, 1e-5f);
  EXPECT_NEAR(irradiance(19.9f), 1, 1e-5f);
  EXPECT_NEAR(irradiance(25), 0.5f, 1e-4f);
  EXPECT_NEAR(irradiance(29), 0.1f, 1e-4f);
  EXPECT_EQ(irradiance(31), 0);
  EXPECT_EQ(irradiance(179), 0);
}

// The cone of 40 degrees touches the sides of the texture's unit square: what Mitsuba 3.9 looks up.
TEST(SpotLight, ShinesThroughItsTexture) {
  constexpr float kDegree = kPi / 180;
  Matrix4 toWorld;
  toWorld[3][0] = 7;
  const SpotLight light(toWorld, Rgb(2, 2, 2), {40 * kDegree, 40 * kDegree, std::make_shared<Pattern>()});
  for (const Vec2& p : {Vec2(0.1f, -0.2f), Vec2(-0.3f, -0.1f), Vec2(0.1f, 0.2f), Vec2(-0.5f, -0.4f)}) {
    const Vec3 place = Vec3(p.x, p.y, 1) * 3.0f;
    const Rgb found = light.sample(0, place + Vec3(7, 0, 0), {0, 0}).radiance * lengthSquared(place);
    const Vec2 uv(0.5f + p.x / (2 * std::tan(40 * kDegree)), 0.5f + p.y / (2 * std::tan(40 * kDegree)));
    const Rgb expected = Pattern().rgb(uv) * 2.0f;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 1e-4f) << p.x << ", " << p.y;
  }
}

// A camera in the projector's place would see the image as it is; a plane at distance one receives pi times
// its values (Mitsuba 3.9).
TEST(Projector, ThrowsWhatACameraWouldSee) {
  const Vec2i size(200, 100);
  Matrix4 toWorld;  // looks along +x, from (5, 0, 2)
  toWorld = Matrix4(0, -1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 5, 0, 2, 1);
  const double fov = 1;
  const float halfWidth = float(std::tan(fov / 2));
  const Projector light(toWorld, std::make_shared<Pattern>(), {halfWidth, halfWidth / 2, 3});
  const Perspective camera(toWorld, Projection(fov, size));
  for (const Vec2& uv : {Vec2(0.1f, 0.2f), Vec2(0.9f, 0.3f), Vec2(0.5f, 0.49f), Vec2(0.3f, 0.8f)}) {
    const Ray ray = camera.ray({uv.x * float(size.x), uv.y * float(size.y)}, {});
    const Vec3 place = ray.origin + ray.direction * 4.0f;
    const EmitterSample sample = light.sample(0, place, {0, 0});
    EXPECT_TRUE(sample.delta);
    EXPECT_NEAR(dot(sample.wi, ray.direction), -1, 1e-6f);
    const float cosine = ray.direction.x;
    const Rgb expected = Pattern().rgb(uv) * (3 * kPi / (16 * cosine * cosine * cosine));
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(sample.radiance[c], expected[c], 1e-4f * (1 + expected[c])) << uv.x << ", " << uv.y;
  }
  for (const Vec2& uv : {Vec2(-0.01f, 0.2f), Vec2(1.01f, 0.2f), Vec2(0.5f, -0.01f)}) {
    const Ray ray = camera.ray({uv.x * float(size.x), uv.y * float(size.y)}, {});
    EXPECT_EQ(light.sample(0, ray.origin + ray.direction, {0, 0}).pdf, 0);
    EXPECT_EQ(light.sample(0, ray.origin - ray.direction, {0, 0}).pdf, 0);
  }
}

// What the image brings to a plane of any distance is pi times its mean times its area at distance one.
TEST(Projector, GivesItsEnergyToAPlaneAtAnyDistance) {
  const Projector light(Matrix4(), std::make_shared<Pattern>(), {0.6f, 0.4f, 2});
  for (const float distance : {1.0f, 5.0f}) {
    Rgb sum(0, 0, 0);
    constexpr int kSteps = 200;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j) {
        const Vec3 place = Vec3((2 * (float(i) + 0.5f) / kSteps - 1) * 0.6f,
                                (2 * (float(j) + 0.5f) / kSteps - 1) * 0.4f, 1) *
                           distance;
        const EmitterSample sample = light.sample(0, place, {0, 0});
        sum += sample.radiance * -sample.wi.z;
      }
    const Rgb power = sum * (1.2f * 0.8f * sqr(distance) / (kSteps * kSteps));
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(power[c], 2 * kPi * Pattern().mean()[c] * 1.2f * 0.8f, 1e-3f) << distance;
  }
}

TEST(SpotLight, ABeamAsWideAsTheConeHasASharpRim) {
  const SpotLight light(Matrix4(), Rgb(1, 1, 1), {0.5f, 0.5f, nullptr});
  EXPECT_NEAR(light.sample(0, {std::sin(0.499f), 0, std::cos(0.499f)}, {0, 0}).radiance.x, 1, 1e-5f);
  EXPECT_EQ(light.sample(0, {std::sin(0.501f), 0, std::cos(0.501f)}, {0, 0}).pdf, 0);
}
