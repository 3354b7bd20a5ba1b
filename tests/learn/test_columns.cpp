// Pilots and targets in a shard: as close to what they were as docs/dataset-format.md promises.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "learn/data/targets.h"
#include "support/temporary_folder.h"

namespace odis::learn {
namespace {

constexpr float kInf = INFINITY, kNaN = NAN;
// Half of the last place of a half, with the rounding of floats on the way there and back.
constexpr float kHalf = 1.0f / 2048 * 1.001f;
// Half of the distance between the smallest halves.
constexpr float kSmallest = 1.0f / (1 << 25) * 1.001f;
constexpr float kDirection = 7e-5f;

// Numbers that are awkward to keep in 16 bits.
constexpr float kAwkward[] = {0,     -0.0f, 1,      -1,      0.1f,   3e-5f,  6e-8f, 2.9e-8f, 1e-30f, 1e-42f,
                              65504, 65519, 65520,  1e30f,   -1e30f, 3e38f,  kInf,  -kInf,   kNaN,   2047.5f,
                              2049,  2051,  -7e-6f, 0.9997f, 31.4f,  -65504, 1e-4f, 12345,   0.333f, 6.1e-5f};

// What comes back of a number that is kept as a half of it times `scale`.
void expectHalf(float found, float expected, float scale, const char* what) {
  const float kept = expected * scale;
  if (std::isnan(kept)) {
    EXPECT_TRUE(std::isnan(found)) << what;
  } else if (std::isinf(kept)) {
    EXPECT_EQ(found, kept) << what;
  } else if (std::abs(kept) > 65504) {
    EXPECT_FLOAT_EQ(found, std::copysign(65504 / scale, expected)) << what;
  } else {
    EXPECT_LE(std::abs(found * scale - kept), std::max(kHalf * std::abs(kept), kSmallest))
        << what << ": " << found << " instead of " << expected;
    EXPECT_EQ(std::signbit(found), std::signbit(expected)) << what;
  }
}
void expectHalf3(const Float3& found, const Float3& expected, float scale, const char* what) {
  expectHalf(found.x, expected.x, scale, what);
  expectHalf(found.y, expected.y, scale, what);
  expectHalf(found.z, expected.z, scale, what);
}
void expectDirection(const Float3& found, const Float3& expected, const char* what) {
  EXPECT_NEAR(dot(found, found), 1, 1e-6f) << what;
  const Float3 wrong = found - expected;
  EXPECT_LE(std::sqrt(dot(wrong, wrong)), kDirection) << what;
}

class Draw {
 public:
  float unit() { return std::uniform_real_distribution<float>()(m_engine); }
  float awkward() {
    return kAwkward[std::min(size_t(unit() * float(std::size(kAwkward))), std::size(kAwkward) - 1)];
  }
  Float3 color() { return {awkward(), awkward(), awkward()}; }
  Float3 direction() {
    const float z = 2 * unit() - 1, phi = 2 * float(M_PI) * unit(), r = std::sqrt(std::max(0.0f, 1 - z * z));
    // Along the axes and in the planes between them too, where the map has its seams.
    const float kind = unit();
    if (kind < 0.1f) return {0, 0, z < 0 ? -1.0f : 1.0f};
    if (kind < 0.2f) return {z < 0 ? -1.0f : 1.0f, 0, 0};
    if (kind < 0.3f) return {std::cos(phi), std::sin(phi), 0};
    return {r * std::cos(phi), r * std::sin(phi), z};
  }

 private:
  std::mt19937 m_engine{5};
};

PathVertex awkwardVertex(Draw& draw, const ViewFrame& frame) {
  PathVertex v;
  const auto place = [&](float origin) { return origin + (draw.unit() * 400 - 200) * frame.edge; };
  v.position = {place(frame.origin.x), place(frame.origin.y), place(frame.origin.z)};
  v.normal = draw.direction();
  v.wi = draw.direction();
  v.lightDirection = draw.direction();
  v.radiance = draw.color();
  v.weight = draw.color();
  v.direct = draw.color();
  for (float PathVertex::*field :
       {&PathVertex::pdf, &PathVertex::survival, &PathVertex::guidablePdf, &PathVertex::guidableProbability,
        &PathVertex::distance, &PathVertex::roughness, &PathVertex::indirect, &PathVertex::emission,
        &PathVertex::emissionLightPdf, &PathVertex::light, &PathVertex::lightPdf, &PathVertex::lightBsdfPdf,
        &PathVertex::lightGuidablePdf, &PathVertex::lightGroupProbability})
    v.*field = draw.awkward();
  v.cosine = std::abs(dot(v.wi, v.normal));
  v.raysAfter = std::floor(draw.unit() * 70000);
  const uint32_t groups[] = {0, 7, kMaxLightGroups - 1, kMaxLightGroups, kNoLightGroup};
  v.lightGroup = groups[size_t(draw.unit() * 4.99f)];
  v.discrete = draw.unit() < 0.5f;
  v.scattersBothSides = draw.unit() < 0.5f;
  return v;
}

Pilot awkwardPilot(Draw& draw, const ViewFrame& frame, size_t pixels, int longest) {
  Pilot pilot;
  for (size_t pixel = 0; pixel < pixels; ++pixel) {
    const int length = int(draw.unit() * float(longest + 1));
    pilot.lengths.push_back(uint8_t(length));
    pilot.sampleWeight.push_back(draw.awkward());
    const Float3 color = draw.color();
    pilot.image.emplace_back(color.x, color.y, color.z);
    for (int depth = 1; depth <= length; ++depth) {
      PathVertex v = awkwardVertex(draw, frame);
      v.wo = depth == 1 ? draw.direction() : pilot.vertices.back().wi * -1.0f;
      v.sampleWeight = pilot.sampleWeight.back();
      v.pixel = uint32_t(pixel);
      v.depth = uint16_t(depth);
      pilot.vertices.push_back(v);
    }
  }
  return pilot;
}

template <class Add>
ShardReader written(const Add& add) {
  ShardWriter writer;
  add(writer);
  const odis::test::TemporaryFolder folder;
  writer.write(folder.path("a.shard"), nlohmann::json::object());
  return ShardReader(folder.path("a.shard"));
}

// Half a step along each axis, and the last place of a float.
void expectPosition(const Float3& found, const Float3& expected, const ViewFrame& frame) {
  for (const auto axis : {&Float3::x, &Float3::y, &Float3::z})
    EXPECT_LE(std::abs(found.*axis - expected.*axis),
              frame.edge / (2 * kStepsPerCell) * 1.001f + 1.2e-7f * std::abs(expected.*axis));
}

void expectAlike(const Pilot& found, const Pilot& expected, const ViewFrame& frame) {
  const float radiance = 1 / frame.unit;
  ASSERT_EQ(found.lengths, expected.lengths);
  ASSERT_EQ(found.vertices.size(), expected.vertices.size());
  for (size_t i = 0; i < expected.lengths.size(); ++i) {
    expectHalf(found.sampleWeight[i], expected.sampleWeight[i], 1, "sampleWeight");
    for (int c = 0; c < 3; ++c) expectHalf(found.image[i][c], expected.image[i][c], radiance, "image");
  }
  for (size_t i = 0; i < expected.vertices.size(); ++i) {
    const PathVertex &a = found.vertices[i], &b = expected.vertices[i];
    expectPosition(a.position, b.position, frame);
    expectDirection(a.normal, b.normal, "normal");
    expectDirection(a.wo, b.wo, "wo");
    expectDirection(a.wi, b.wi, "wi");
    EXPECT_NEAR(a.cosine, b.cosine, 2 * kDirection);
    expectHalf3(a.radiance, b.radiance, radiance, "radiance");
    expectHalf3(a.weight, b.weight, 1, "weight");
    expectHalf3(a.direct, b.direct, radiance, "direct");
    expectHalf(a.pdf, b.pdf, 1, "pdf");
    expectHalf(a.survival, b.survival, 1, "survival");
    expectHalf(a.guidablePdf, b.guidablePdf, 1, "guidablePdf");
    expectHalf(a.guidableProbability, b.guidableProbability, 1, "guidableProbability");
    expectHalf(a.distance, b.distance, 1 / frame.edge, "distance");
    expectHalf(a.roughness, b.roughness, 1, "roughness");
    expectHalf(a.indirect, b.indirect, radiance, "indirect");
    expectHalf(a.emission, b.emission, radiance, "emission");
    expectHalf(a.emissionLightPdf, b.emissionLightPdf, 1, "emissionLightPdf");
    expectHalf(a.light, b.light, radiance, "light");
    expectHalf(a.lightPdf, b.lightPdf, 1, "lightPdf");
    expectHalf(a.lightGroupProbability, b.lightGroupProbability, 1, "lightGroupProbability");
    // Of light that gave nothing there is no more.
    const bool lit = b.light > 0;
    expectDirection(a.lightDirection, lit ? b.lightDirection : Float3{0, 0, 1}, "lightDirection");
    expectHalf(a.lightBsdfPdf, lit ? b.lightBsdfPdf : 0, 1, "lightBsdfPdf");
    expectHalf(a.lightGuidablePdf, lit ? b.lightGuidablePdf : 0, 1, "lightGuidablePdf");
    EXPECT_EQ(a.raysAfter, std::min(b.raysAfter, 65535.0f));
    EXPECT_EQ(a.lightGroup, b.lightGroup < kMaxLightGroups ? b.lightGroup : kNoLightGroup);
    EXPECT_EQ(a.discrete, b.discrete);
    EXPECT_EQ(a.scattersBothSides, b.scattersBothSides);
    EXPECT_EQ(a.pixel, b.pixel);
    EXPECT_EQ(a.depth, b.depth);
    expectHalf(a.sampleWeight, b.sampleWeight, 1, "a vertex's sampleWeight");
  }
}

const ViewFrame kFrames[] = {
    {{0, 0, 0}, 1, 1}, {{-3, 700, 0.01f}, 0.037f, 13.7f}, {{1e4f, 0, -1}, 250, 2e-4f}};

TEST(Columns, AwkwardPilotsComeBackWithinTheirPrecision) {
  Draw draw;
  for (const ViewFrame& frame : kFrames)
    for (const int longest : {5, 0}) {
      const Pilot pilot = awkwardPilot(draw, frame, 400, longest);
      const ShardReader reader = written([&](ShardWriter& w) { addColumns(w, "p/", pilot, frame); });
      expectAlike(readColumns(reader, "p/", frame), pilot, frame);
    }
}

TEST(Columns, WhatWasReadIsWrittenTheSame) {
  Draw draw;
  const ViewFrame& frame = kFrames[1];
  const auto again = [&](const Pilot& pilot) {
    return readColumns(written([&](ShardWriter& w) { addColumns(w, "p/", pilot, frame); }), "p/", frame);
  };
  const Pilot once = again(awkwardPilot(draw, frame, 200, 6)), twice = again(once);
  for (size_t i = 0; i < once.vertices.size(); ++i) {
    EXPECT_EQ(stepsOf(once.vertices[i].position, frame), stepsOf(twice.vertices[i].position, frame));
    EXPECT_EQ(packed(once.vertices[i].wi).x, packed(twice.vertices[i].wi).x);
    EXPECT_EQ(packed(once.vertices[i].wi).y, packed(twice.vertices[i].wi).y);
  }
}

TEST(Columns, NoPixelsAtAll) {
  const ShardReader reader = written([&](ShardWriter& w) { addColumns(w, "p/", Pilot(), kFrames[1]); });
  EXPECT_TRUE(readColumns(reader, "p/", kFrames[1]).lengths.empty());
}

// A column that has not as many elements as there are vertices.
TEST(Columns, ColumnsMustFitTogether) {
  Draw draw;
  Pilot pilot = awkwardPilot(draw, kFrames[0], 10, 3);
  const ShardReader reader = written([&](ShardWriter& w) {
    addColumns(w, "p/", pilot, kFrames[0]);
    std::vector<uint8_t> more(pilot.lengths);
    ++more[4];
    w.add("p/lengths", {more.size()}, std::span<const uint8_t>(more));
  });
  EXPECT_THROW(readColumns(reader, "p/", kFrames[0]), ShardError);
  EXPECT_THROW(readColumns(reader, "q/", kFrames[0]), ShardError);
}

TEST(Columns, PositionsOutsideOfEverythingStayFinite) {
  const ViewFrame frame{{0, 0, 0}, 1e-3f, 1};
  const PositionSteps steps = stepsOf({1e30f, -kInf, kNaN}, frame);
  EXPECT_GT(steps[0], 2'000'000'000);
  EXPECT_LT(steps[1], -2'000'000'000);
  EXPECT_LT(steps[2], -2'000'000'000);
}

TEST(Columns, TargetsComeBack) {
  Draw draw;
  const ViewFrame& frame = kFrames[1];
  for (const size_t groups : {0, 1, 3})
    for (const size_t count : {0, 5}) {
      std::vector<Target> targets(count);
      for (Target& t : targets) {
        t.pixel = draw.unit() < 0.5f;
        t.vertex = uint32_t(draw.unit() * 4e9f);
        t.cellVertices = uint32_t(draw.unit() * 1e6f);
        t.starts = uint32_t(1 + draw.unit() * 31);
        t.position = frame.origin + draw.direction() * (7 * frame.edge);
        t.normal = draw.direction();
        t.outgoing = draw.color();
        t.outgoingRms = draw.awkward();
        t.outgoingRays = draw.awkward();
        for (std::vector<float> Target::*map : {&Target::indirect, &Target::indirectRms, &Target::emission,
                                                &Target::emissionRms, &Target::lightPdf, &Target::rays})
          for (int i = 0; i < kTargetTexels; ++i) (t.*map).push_back(draw.awkward());
        for (int i = 0; i < kTargetTexels; ++i) t.samples.push_back(uint8_t(draw.unit() * 9));
        for (size_t g = 0; g < groups; ++g)
          t.lights.push_back({draw.awkward(), draw.awkward(), draw.awkward(), draw.awkward(), draw.unit()});
      }
      const ShardReader reader =
          written([&](ShardWriter& w) { addColumns(w, "t/", targets, groups, frame); });
      const std::vector<Target> found = readTargets(reader, "t/", frame);
      ASSERT_EQ(found.size(), count);
      const float radiance = 1 / frame.unit;
      for (size_t i = 0; i < count; ++i) {
        const Target &a = found[i], &b = targets[i];
        EXPECT_EQ(a.pixel, b.pixel);
        EXPECT_EQ(a.vertex, b.vertex);
        EXPECT_EQ(a.cellVertices, b.cellVertices);
        EXPECT_EQ(a.starts, b.starts);
        EXPECT_EQ(a.samples, b.samples);
        expectPosition(a.position, b.position, frame);
        expectDirection(a.normal, b.normal, "normal");
        expectHalf3(a.outgoing, b.outgoing, radiance, "outgoing");
        expectHalf(a.outgoingRms, b.outgoingRms, radiance, "outgoingRms");
        expectHalf(a.outgoingRays, b.outgoingRays, 1, "outgoingRays");
        for (size_t t = 0; t < size_t(kTargetTexels); ++t) {
          expectHalf(a.indirect[t], b.indirect[t], radiance, "indirect");
          expectHalf(a.indirectRms[t], b.indirectRms[t], radiance, "indirectRms");
          expectHalf(a.emission[t], b.emission[t], radiance, "emission");
          expectHalf(a.emissionRms[t], b.emissionRms[t], radiance, "emissionRms");
          expectHalf(a.lightPdf[t], b.lightPdf[t], 1, "lightPdf");
          expectHalf(a.rays[t], b.rays[t], 1, "rays");
        }
        ASSERT_EQ(a.lights.size(), groups);
        for (size_t g = 0; g < groups; ++g) {
          expectHalf(a.lights[g].mean, b.lights[g].mean, radiance, "lightMean");
          expectHalf(a.lights[g].rms, b.lights[g].rms, radiance, "lightRms");
          expectHalf(a.lights[g].misMean, b.lights[g].misMean, radiance, "lightMisMean");
          expectHalf(a.lights[g].misRms, b.lights[g].misRms, radiance, "lightMisRms");
          expectHalf(a.lights[g].probability, b.lights[g].probability, 1, "lightProbability");
        }
      }
    }
}

}  // namespace
}  // namespace odis::learn
