// From the events of paths to path vertices.
#include <gtest/gtest.h>
#include "odis/record/recorder.h"

#include <cmath>
#include <cstring>
#include <functional>
#include <random>

#include "odis/events.h"

namespace odis::core {
namespace {

Float3 grey(float value) {
  return {value, value, value};
}

void expectVector(const Float3& a, const Float3& b) {
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.z, b.z);
}

void append(std::vector<PathVertex>& vertices, ArrayView<const PathVertex> more) {
  vertices.insert(vertices.end(), more.begin(), more.end());
}

// Begins a path of one vertex under a sky of radiance 1, up to its bounce.
uint32_t beginUnderSky(PathRecorder& recorder, const Float3& weight) {
  const uint32_t path = recorder.begin({});
  recorder.surface(path, odis::surfaceEvent({0, 0, 0}, {0, 0, 1}, {0, 0, 1}, 1));
  BounceEvent bounce;
  bounce.wi = {0, 0, 1};
  bounce.weight = weight;
  bounce.pdf = 1;
  recorder.bounce(path, bounce);
  return path;
}

// Three surfaces, then the sky. All numbers are such that floats hold them, and luminances of greys are the
// greys.
TEST(PathRecorder, ReportsAPathWithItsContributionsAndRays) {
  PathRecorder recorder;
  const uint32_t path = recorder.begin({7, 3, 0.25f});
  EXPECT_EQ(path, 0u);

  // The first surface glows, which is not the light of any vertex.
  SurfaceEvent surface = odis::surfaceEvent({1, 2, 3}, {0, 0, 1}, {0, 1, 0}, 9);
  surface.lightableGroups = 5;
  surface.time = 0.5f;
  recorder.surface(path, surface);
  recorder.emission(path, odis::emissionEvent(grey(100), 1, 0));
  recorder.light(path, odis::lightEvent(grey(2), grey(1), {0.6f, 0, 0.8f}, {0.5f, 0.25f, 0.125f, 3, 0.75f}));
  BounceEvent bounce;
  bounce.wi = {0.8f, 0, 0.6f};
  bounce.weight = grey(0.5f);
  bounce.pdf = 0.375f;
  bounce.guidablePdf = 0.1875f;
  bounce.guidableProbability = 0.625f;
  bounce.survival = 0.875f;
  bounce.cosine = 0.6f;
  bounce.roughness = 0.3f;
  bounce.scattersBothSides = true;
  recorder.bounce(path, bounce);

  // The second one glows, too; roulette is played, and the path goes on.
  recorder.surface(path, odis::surfaceEvent({4, 5, 6}, {1, 0, 0}, {0, 0, 1}, 2));
  recorder.emission(path, odis::emissionEvent(grey(4), 0.25f, 0.0625f));
  recorder.survived(path, 0.5f);
  recorder.light(path, odis::lightEvent(grey(8), grey(4), {1, 0, 0}, {0, 0, 0, 1, 0.5f}));
  BounceEvent second;
  second.wi = {1, 0, 0};
  second.weight = grey(0.25f);
  second.pdf = 2;
  second.discrete = true;
  recorder.bounce(path, second);

  // At the third one something hides the light, which is found out after the bounce.
  recorder.surface(path, odis::surfaceEvent({7, 8, 9}, {0, 1, 0}, {-1, 0, 0}, 3));
  recorder.light(path, odis::lightEvent(grey(5), grey(3), {0, 1, 0}, {0.5f, 0.5f, 0.5f, 2, 0.5f}));
  BounceEvent third;
  third.wi = {0, 1, 0};
  third.weight = grey(2);
  third.pdf = 1;
  recorder.bounce(path, third);
  recorder.lightHidden(path);

  // Two environments are met at once.
  recorder.escape(path);
  recorder.emission(path, odis::emissionEvent(grey(3), 1, 0.3f));
  recorder.emission(path, odis::emissionEvent(grey(1), 0.5f, 0.7f));

  std::vector<PathVertex> vertices;
  append(vertices, recorder.finish());
  ASSERT_EQ(vertices.size(), 3u);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(vertices[i].pixel, 7u);
    EXPECT_EQ(vertices[i].sample, 3u);
    EXPECT_EQ(vertices[i].sampleWeight, 0.25f);
    EXPECT_EQ(vertices[i].depth, i + 1);
  }

  const PathVertex& a = vertices[0];
  expectVector(a.position, {1, 2, 3});
  expectVector(a.normal, {0, 0, 1});
  expectVector(a.wo, {0, 1, 0});
  expectVector(a.wi, {0.8f, 0, 0.6f});
  expectVector(a.weight, grey(0.5f));
  expectVector(a.direct, grey(1));
  expectVector(a.lightDirection, {0.6f, 0, 0.8f});
  EXPECT_EQ(a.lightableGroups, 5u);
  EXPECT_EQ(a.time, 0.5f);
  EXPECT_EQ(a.pdf, 0.375f);
  EXPECT_EQ(a.survival, 0.875f);
  EXPECT_EQ(a.guidablePdf, 0.1875f);
  EXPECT_EQ(a.guidableProbability, 0.625f);
  EXPECT_EQ(a.cosine, 0.6f);
  EXPECT_EQ(a.roughness, 0.3f);
  EXPECT_TRUE(a.scattersBothSides);
  EXPECT_FALSE(a.discrete);
  EXPECT_EQ(a.distance, 2);
  EXPECT_EQ(a.lightPdf, 0.5f);
  EXPECT_EQ(a.lightBsdfPdf, 0.25f);
  EXPECT_EQ(a.lightGuidablePdf, 0.125f);
  EXPECT_EQ(a.lightGroup, 3u);
  EXPECT_EQ(a.lightGroupProbability, 0.75f);
  EXPECT_EQ(a.emissionLightPdf, 0.0625f);

  const PathVertex& b = vertices[1];
  EXPECT_TRUE(b.discrete);
  EXPECT_FALSE(b.scattersBothSides);
  EXPECT_EQ(b.distance, 3);
  EXPECT_TRUE(std::isnan(b.guidablePdf) && std::isnan(b.guidableProbability) && std::isnan(b.cosine));
  EXPECT_EQ(b.survival, 1);
  EXPECT_EQ(b.lightableGroups, ~0u);

  const PathVertex& c = vertices[2];
  EXPECT_EQ(c.distance, INFINITY);
  expectVector(c.direct, grey(0));
  EXPECT_EQ(c.light, 0);
  EXPECT_EQ(c.lightPdf, 0);
  EXPECT_EQ(c.lightGroup, 2u);          // that it gave nothing is known of this group
  EXPECT_EQ(c.emissionLightPdf, 0.3f);  // of the brighter environment

  // The third vertex sees 3 + 1/2 of the sky and scatters back twice that; the second one sees this, and
  // scatters back 4 + 7 / 4, doubled since every other path ended there; the first one sees 1 of the glow
  // beside that.
  const float seen[] = {1 + 2 * 5.75f, 7, 3.5f};
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_FLOAT_EQ(vertices[i].radiance.x, seen[i]);
    EXPECT_FLOAT_EQ(vertices[i].radiance.y, seen[i]);
    EXPECT_FLOAT_EQ(vertices[i].radiance.z, seen[i]);
  }
  // Throughputs up to the vertices: 1, 1/2 doubled by roulette, 1/4.
  EXPECT_FLOAT_EQ(a.indirect, 0.5f * 11.5f);
  EXPECT_FLOAT_EQ(b.indirect, 0.25f * 7);
  EXPECT_FLOAT_EQ(c.indirect, 0);
  EXPECT_FLOAT_EQ(a.emission, 0.5f * 4);
  EXPECT_FLOAT_EQ(b.emission, 0);
  EXPECT_FLOAT_EQ(c.emission, 0.25f * 2 * 4);
  EXPECT_FLOAT_EQ(a.light, 2);
  EXPECT_FLOAT_EQ(b.light, 8);
  // Seven rays: three surfaces, three lights, the sky.
  EXPECT_EQ(a.raysAfter, 5);
  EXPECT_EQ(b.raysAfter, 3);
  EXPECT_EQ(c.raysAfter, 1);
  EXPECT_EQ(checkVertex(a), VertexState::usable);
  EXPECT_EQ(checkVertex(b), VertexState::discrete);
  EXPECT_EQ(checkVertex(c), VertexState::usable);
}

TEST(PathRecorder, AVertexWithoutALightEventHasGotNothingFromLights) {
  PathRecorder recorder;
  recorder.escape(beginUnderSky(recorder, grey(0.5f)));
  std::vector<PathVertex> vertices;
  append(vertices, recorder.finish());
  ASSERT_EQ(vertices.size(), 1u);
  EXPECT_EQ(vertices[0].light, 0);
  EXPECT_EQ(vertices[0].lightPdf, 0);
  EXPECT_EQ(vertices[0].lightGroup, kNoLightGroup);
  expectVector(vertices[0].direct, grey(0));
  EXPECT_EQ(vertices[0].indirect, 0);
  EXPECT_EQ(vertices[0].emission, 0);
  EXPECT_EQ(vertices[0].raysAfter, 1);
}

TEST(PathRecorder, ALightThatIsHiddenBeforeTheBounceGivesNothingEither) {
  std::vector<PathVertex> vertices;
  PathRecorder recorder;
  for (const bool before : {true, false}) {
    const uint32_t path = recorder.begin({});
    recorder.surface(path, odis::surfaceEvent({0, 0, 0}, {0, 0, 1}, {0, 0, 1}, 1));
    recorder.light(path, odis::lightEvent(grey(5), grey(3), {0, 1, 0}, {0.5f, 0.5f, 0.5f, 2, 0.5f}));
    if (before) recorder.lightHidden(path);
    recorder.bounce(path, odis::bounceEvent({0, 0, 1}, grey(1), 1));
    if (!before) recorder.lightHidden(path);
    recorder.escape(path);
    recorder.emission(path, odis::emissionEvent(grey(1), 1, 0));
  }
  append(vertices, recorder.finish());
  ASSERT_EQ(vertices.size(), 2u);
  EXPECT_EQ(std::memcmp(&vertices[0], &vertices[1], sizeof(PathVertex)), 0);
  EXPECT_EQ(vertices[0].light, 0);
}

TEST(PathRecorder, BlackEmissionIsAsGoodAsNone) {
  PathRecorder recorder;
  for (int path = 0; path < 2; ++path) {
    recorder.escape(beginUnderSky(recorder, grey(0.5f)));
    if (path == 1) recorder.emission(1, odis::emissionEvent(grey(0), 0.5f, 0.25f));
    recorder.emission(uint32_t(path), odis::emissionEvent(grey(2), 0.5f, 0.125f));
  }
  recorder.escape(beginUnderSky(recorder, grey(0.5f)));
  recorder.emission(2, odis::emissionEvent(grey(0), 0.5f, 0.25f));
  std::vector<PathVertex> vertices;
  append(vertices, recorder.finish());
  ASSERT_EQ(vertices.size(), 3u);
  for (const PathVertex& v : vertices) EXPECT_EQ(checkVertex(v), VertexState::usable);
  EXPECT_EQ(vertices[1].radiance.x, vertices[0].radiance.x);
  EXPECT_EQ(vertices[1].emissionLightPdf, vertices[0].emissionLightPdf);
  EXPECT_EQ(vertices[2].radiance.x, 0);
  EXPECT_EQ(vertices[2].emission, 0);
}

TEST(PathRecorder, ASurfaceWithoutBounceLeavesNoVertex) {
  PathRecorder recorder;
  const uint32_t first = recorder.begin({1, 0});
  recorder.surface(first,
                   odis::surfaceEvent({0, 0, 0}, {0, 0, 1}, {0, 0, 1}, 1));  // the path ends by its depth
  const uint32_t second = recorder.begin({2, 0});
  recorder.escape(second);  // the camera ray meets nothing
  recorder.emission(second, odis::emissionEvent(grey(1), 1, 0));
  const uint32_t third = recorder.begin({3, 0});
  recorder.surface(third, odis::surfaceEvent({0, 0, 0}, {0, 0, 1}, {0, 0, 1}, 1));
  recorder.bounce(third, odis::bounceEvent({0, 0, 1}, grey(0.5f), 1));
  recorder.surface(
      third, odis::surfaceEvent({0, 0, 4}, {0, 0, -1}, {0, 0, -1}, 4));  // it ends by roulette on arrival
  std::vector<PathVertex> vertices;
  append(vertices, recorder.finish());
  ASSERT_EQ(vertices.size(), 1u);
  EXPECT_EQ(vertices[0].pixel, 3u);
  EXPECT_EQ(vertices[0].distance, 4);
  EXPECT_EQ(vertices[0].raysAfter, 1);
  EXPECT_EQ(vertices[0].radiance.x, 0);
}

TEST(PathRecorder, APathThatIsAbsorbedHasAVertexThatSeesNothing) {
  PathRecorder recorder;
  beginUnderSky(recorder, grey(0));
  std::vector<PathVertex> vertices;
  append(vertices, recorder.finish());
  ASSERT_EQ(vertices.size(), 1u);
  EXPECT_EQ(vertices[0].raysAfter, 0);
  EXPECT_EQ(vertices[0].indirect, 0);
  EXPECT_EQ(vertices[0].emission, 0);
  EXPECT_EQ(checkVertex(vertices[0]), VertexState::usable);
}

TEST(PathRecorder, FinishForgetsAndAppends) {
  PathRecorder recorder;
  std::vector<PathVertex> vertices;
  append(vertices, recorder.finish());
  EXPECT_TRUE(vertices.empty());
  recorder.emission(beginUnderSky(recorder, grey(1)), odis::emissionEvent(grey(3), 1, 0));
  append(vertices, recorder.finish());
  append(vertices, recorder.finish());
  EXPECT_EQ(vertices.size(), 1u);
  // Handles begin anew, and nothing of the first path is left in the next one.
  const uint32_t path = beginUnderSky(recorder, grey(0.5f));
  EXPECT_EQ(path, 0u);
  recorder.emission(path, odis::emissionEvent(grey(1), 1, 0));
  append(vertices, recorder.finish());
  ASSERT_EQ(vertices.size(), 2u);
  EXPECT_EQ(vertices[0].radiance.x, 3);
  EXPECT_EQ(vertices[1].radiance.x, 1);
  EXPECT_EQ(vertices[1].depth, 1);
  EXPECT_EQ(vertices[1].emission, 0.5f);
}

// The events of a random path, to be played one after the other.
using RecorderEvents = std::vector<std::function<void(PathRecorder&, uint32_t path)>>;

RecorderEvents randomPath(std::mt19937& engine) {
  std::uniform_real_distribution<float> uniform(0.1f, 1);
  const auto next = [&] { return uniform(engine); };
  const auto vector = [&] {
    const float x = next(), y = next();
    return Float3{x, y, next()};
  };
  RecorderEvents events;
  const auto play = [&](auto&& event) { events.emplace_back(event); };
  const int surfaces = int(engine() % 6);
  for (int i = 0; i < surfaces; ++i) {
    const SurfaceEvent surface{sizeof surface, vector(),           vector(), vector(),
                               next(),         uint32_t(engine()), next()};
    play([=](PathRecorder& r, uint32_t path) { r.surface(path, surface); });
    if (engine() % 4 == 0) {
      const EmissionEvent emission{sizeof emission, vector(), next(), next()};
      play([=](PathRecorder& r, uint32_t path) { r.emission(path, emission); });
    }
    if (engine() % 2 == 0) {
      const float probability = next();
      play([=](PathRecorder& r, uint32_t path) { r.survived(path, probability); });
    }
    const bool lit = engine() % 3 != 0, hidden = engine() % 3 == 0;
    if (lit) {
      const LightEvent light{sizeof light,           vector(), vector(), vector(), next(), next(), next(),
                             uint32_t(engine() % 8), next()};
      play([=](PathRecorder& r, uint32_t path) { r.light(path, light); });
    }
    if (i + 1 == surfaces && engine() % 2 == 0) return events;  // it ends there
    BounceEvent bounce{sizeof bounce, vector(), vector(), next()};
    bounce.survival = next();
    bounce.discrete = engine() % 5 == 0;
    play([=](PathRecorder& r, uint32_t path) { r.bounce(path, bounce); });
    if (lit && hidden) play([](PathRecorder& r, uint32_t path) { r.lightHidden(path); });
  }
  play([](PathRecorder& r, uint32_t path) { r.escape(path); });
  const EmissionEvent sky{sizeof sky, vector(), next(), next()};
  play([=](PathRecorder& r, uint32_t path) { r.emission(path, sky); });
  return events;
}

TEST(PathRecorder, InterleavedPathsGiveTheVerticesOfPathsOneAfterTheOther) {
  static_assert(sizeof(PathVertex) == 188);  // without gaps, so that bytes can be compared
  std::mt19937 engine(11);
  PathRecorder recorder;  // the same one all the time
  for (int round = 0; round < 50; ++round) {
    constexpr uint32_t kPaths = 20;
    std::vector<RecorderEvents> paths;
    for (uint32_t p = 0; p < kPaths; ++p) paths.push_back(randomPath(engine));
    std::vector<PathVertex> alone, together, apart;
    for (uint32_t p = 0; p < kPaths; ++p) {
      PathRecorder own;
      const uint32_t path = own.begin({p, 1, 0.5f});
      for (const auto& event : paths[p]) event(own, path);
      append(alone, own.finish());
    }
    for (uint32_t p = 0; p < kPaths; ++p) {
      const uint32_t path = recorder.begin({p, 1, 0.5f});
      for (const auto& event : paths[p]) event(recorder, path);
    }
    append(apart, recorder.finish());
    size_t begun = 0, left = 0;
    for (const RecorderEvents& events : paths) left += events.size();
    std::vector<size_t> played(kPaths);
    while (begun < kPaths || left > 0) {
      const auto p = uint32_t(engine() % kPaths);
      if (p > begun || (p == begun && begun == kPaths)) continue;
      if (p == begun) {
        EXPECT_EQ(recorder.begin({p, 1, 0.5f}), p);
        ++begun;
      }
      if (played[p] == paths[p].size()) continue;
      paths[p][played[p]++](recorder, p);
      --left;
    }
    append(together, recorder.finish());
    ASSERT_EQ(together.size(), alone.size());
    ASSERT_EQ(apart.size(), alone.size());
    if (alone.empty()) continue;
    EXPECT_EQ(std::memcmp(together.data(), alone.data(), alone.size() * sizeof(PathVertex)), 0);
    EXPECT_EQ(std::memcmp(apart.data(), alone.data(), alone.size() * sizeof(PathVertex)), 0);
  }
}

}  // namespace
}  // namespace odis::core
