// Paths through media: places where they are scattered, and what the rays between are multiplied by.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "odis/events.h"
#include "odis/record/recorder.h"
#include "odis/record/vertex_check.h"

namespace odis::core {
namespace {

Float3 scaled(const Float3& color, float by) {
  return color * by;
}

void expectColor(const Float3& a, const Float3& b) {
  EXPECT_FLOAT_EQ(a.x, b.x);
  EXPECT_FLOAT_EQ(a.y, b.y);
  EXPECT_FLOAT_EQ(a.z, b.z);
}

constexpr Float3 kOne{1, 1, 1};

// The camera sees a place in fog, from there a surface behind a glowing boundary, from there the sky through
// another one. The host's own throughput and colour are kept beside it.
struct FogPath {
  const Float3 toFog{0.5f, 0.25f, 0.75f}, scattering{1.5f, 1, 0.5f}, phase{0.875f, 0.875f, 0.875f},
      toBoundary{0.5f, 0.75f, 0.25f}, glow{8, 4, 2}, boundary{0.5f, 1, 0.5f}, toWall{0.125f, 0.5f, 0.25f},
      wallGlow{3, 2, 1}, fogLight{4, 2, 1}, wallLight{1, 2, 3}, wall{0.5f, 0.25f, 0.125f},
      toSky{0.75f, 0.5f, 0.5f}, sky{16, 8, 4}, behind{0.25f, 0.5f, 1};
  static constexpr float kGlowWeight = 0.5f, kSkyWeight = 0.75f, kSurvival = 0.5f;
};

std::vector<PathVertex> recordFogPath(const FogPath& p, Float3& color) {
  PathRecorder recorder;
  const uint32_t path = recorder.begin({3, 1});
  Float3 throughput = kOne;
  const auto attenuate = [&](const Float3& factor) {
    recorder.attenuation(path, factor);
    throughput = throughput * factor;
  };
  const auto emit = [&](const Float3& radiance, float weight) {
    recorder.emission(path, odis::emissionEvent(radiance, weight, 0.5f));
    color = color + throughput * radiance * weight;
  };
  const auto light = [&](const Float3& radiance) {
    recorder.light(path, odis::lightEvent(scaled(radiance, 2), radiance, {0, 0, 1}, {0.25f, 0.125f, 0.125f}));
    color = color + throughput * radiance;
  };
  const auto bounce = [&](const Float3& wi, const Float3& weight) {
    recorder.bounce(path, odis::bounceEvent(wi, weight, 0.125f, 0.75f));
    throughput = throughput * weight;
  };
  attenuate(p.toFog);
  recorder.medium(path, odis::mediumEvent({1, 2, 3}, {0, 0, 1}, 4));
  attenuate(p.scattering);  // after the event is fine, too
  light(p.fogLight);
  bounce({0, 0.6f, 0.8f}, p.phase);

  attenuate(p.toBoundary);
  emit(p.glow, FogPath::kGlowWeight);
  attenuate(p.boundary);
  attenuate(p.toWall);
  recorder.surface(path, odis::surfaceEvent({4, 5, 6}, {0, 0, -1}, {0, -0.6f, -0.8f}, 7));
  emit(p.wallGlow, FogPath::kGlowWeight);
  recorder.survived(path, FogPath::kSurvival);
  throughput = throughput / FogPath::kSurvival;
  light(p.wallLight);
  bounce({0, 0, -1}, p.wall);

  attenuate(p.toSky);
  recorder.escape(path);
  attenuate(p.behind);
  emit(p.sky, FogPath::kSkyWeight);
  const ArrayView<const PathVertex> vertices = recorder.finish();
  return {vertices.begin(), vertices.end()};
}

TEST(RecordedMedia, AttenuationIsPartOfWhatArrivesAndOfTheThroughput) {
  const FogPath p;
  Float3 color;
  const std::vector<PathVertex> vertices = recordFogPath(p, color);
  ASSERT_EQ(vertices.size(), 2u);
  const PathVertex &fog = vertices[0], &wall = vertices[1];

  // From the end of the path to its beginning.
  const Float3 fromSky = p.toSky * p.behind * p.sky;
  expectColor(wall.radiance, fromSky * FogPath::kSkyWeight);
  const Float3 fromWall = (p.wallLight + p.wall * wall.radiance) / FogPath::kSurvival;
  const Float3 glow = p.toBoundary * p.glow, toWall = p.toBoundary * p.boundary * p.toWall,
               wallGlow = toWall * p.wallGlow;
  expectColor(fog.radiance, (glow + wallGlow) * FogPath::kGlowWeight + toWall * fromWall);

  // Contributions: throughputs up to the vertices.
  const Float3 toFog = p.toFog * p.scattering, atWall = toFog * p.phase * toWall / FogPath::kSurvival;
  EXPECT_FLOAT_EQ(fog.light, luminance(toFog * p.fogLight * 2.0f));
  EXPECT_FLOAT_EQ(fog.emission, luminance(toFog * p.phase * (glow + wallGlow)));
  EXPECT_FLOAT_EQ(fog.indirect, luminance(toFog * p.phase * toWall * fromWall));
  EXPECT_FLOAT_EQ(wall.light, luminance(atWall * p.wallLight * 2.0f));
  EXPECT_FLOAT_EQ(wall.emission, luminance(atWall * p.wall * fromSky));
  EXPECT_EQ(wall.indirect, 0);

  // All that the pixel sees is scattered back by the first vertex.
  expectColor(toFog * (fog.direct + fog.weight * fog.radiance), color);
  EXPECT_FLOAT_EQ(luminance(toFog * fog.direct) + FogPath::kGlowWeight * fog.emission + fog.indirect,
                  luminance(color));

  // As of a surface: depths, distances, rays.
  EXPECT_EQ(fog.depth, 1);
  EXPECT_EQ(wall.depth, 2);
  EXPECT_EQ(fog.distance, 7);
  EXPECT_EQ(wall.distance, INFINITY);
  EXPECT_EQ(fog.raysAfter, 3);
  EXPECT_EQ(wall.raysAfter, 1);
  EXPECT_EQ(fog.roughness, 0.75f);
}

TEST(RecordedMedia, AVertexOfAMediumHasNoNormalAndNoCosine) {
  Float3 color;
  PathVertex fog = recordFogPath(FogPath(), color)[0];
  EXPECT_TRUE(isInMedium(fog));
  expectColor(fog.normal, {0, 0, 0});
  EXPECT_EQ(fog.cosine, 1);
  EXPECT_TRUE(fog.scattersBothSides);
  EXPECT_EQ(checkVertex(fog), VertexState::usable);
  // Whatever a host says of the cosine.
  for (const float cosine : {0.0f, 0.5f, -1.0f, 2.0f, INFINITY, NAN}) {
    fog.cosine = cosine;
    EXPECT_EQ(checkVertex(fog), VertexState::usable) << cosine;
    EXPECT_EQ(cosineOf(fog), 1) << cosine;
  }
  fog.normal = {0, 0, 0.5f};
  EXPECT_EQ(checkVertex(fog), VertexState::notUnit);
}

TEST(RecordedMedia, AttenuationBelongsToARayUnderWay) {
  PathRecorder recorder;
  const auto refuses = [&](const std::function<void(uint32_t)>& before) {
    const uint32_t path = recorder.begin({});
    recorder.medium(path, odis::mediumEvent({}, {0, 0, 1}, 1));
    before(path);
    EXPECT_THROW(recorder.attenuation(path, kOne), std::logic_error);
    recorder.finish();
  };
  refuses([&](uint32_t path) { recorder.survived(path, 1); });
  refuses([&](uint32_t path) { recorder.light(path, {}); });
  refuses([&](uint32_t path) { recorder.cached(path, kOne); });
  const uint32_t path = recorder.begin({});
  for (const float wrong : {-1.0f, INFINITY, NAN})
    EXPECT_THROW(recorder.attenuation(path, {1, 1, wrong}), std::invalid_argument);
  recorder.attenuation(path, {0, 0, 0});
  EXPECT_THROW(recorder.medium(path, odis::mediumEvent({}, {0, 0, 1}, -1)), std::invalid_argument);
  EXPECT_THROW(recorder.attenuation(path + 1, kOne), std::out_of_range);
}

TEST(RecordedMedia, APathMayEndWithCachedRadianceInAMedium) {
  PathRecorder recorder;
  const uint32_t path = recorder.begin({});
  recorder.surface(path, odis::surfaceEvent({0, 0, 0}, {0, 0, 1}, {0, 0, 1}, 1));
  recorder.bounce(path, odis::bounceEvent({0, 0, 1}, kOne * 0.5f, 1));
  recorder.attenuation(path, {0.5f, 0.25f, 1});
  recorder.medium(path, odis::mediumEvent({0, 0, 1}, {0, 0, -1}, 1));
  recorder.cached(path, {4, 4, 4});
  const ArrayView<const PathVertex> vertices = recorder.finish();
  ASSERT_EQ(vertices.size(), 1u);
  expectColor(vertices[0].radiance, {2, 1, 4});
  EXPECT_FLOAT_EQ(vertices[0].indirect, 0.5f * luminance({2, 1, 4}));
}

}  // namespace
}  // namespace odis::core
