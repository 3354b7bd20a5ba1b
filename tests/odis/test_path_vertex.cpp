// Which vertices can be learned from, and what stands in for what a host does not know.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "odis/floor_under_patch.h"
#include "odis/frame.h"
#include "odis/models/second_moments.h"
#include "odis/record/vertex_check.h"
#include "odis/same_guide.h"

namespace odis::core {
namespace {

GuideOptions withFormulas() {
  GuideOptions options;
  options.model = Model();
  return options;
}

// A vertex with what is required, and nothing else.
PathVertex leastVertex() {
  PathVertex v;
  v.position = {0.5f, 0.5f, 0};
  v.normal = {0, 0, 1};
  v.wi = {0, 0.6f, 0.8f};
  v.radiance = {1, 1, 1};
  v.pdf = 0.25f;
  v.distance = INFINITY;
  v.depth = 1;
  return v;
}

// One thing that makes a vertex useless, and where it is counted.
struct Defect {
  std::function<void(PathVertex&)> spoil;
  VertexState state;
  uint64_t VertexCounts::*counted;
};

std::vector<Defect> defects() {
  const auto notFinite = [](std::function<void(PathVertex&)> spoil) {
    return Defect{std::move(spoil), VertexState::notFinite, &VertexCounts::notFinite};
  };
  const auto noDensity = [](std::function<void(PathVertex&)> spoil) {
    return Defect{std::move(spoil), VertexState::noDensity, &VertexCounts::noDensity};
  };
  const auto notUnit = [](std::function<void(PathVertex&)> spoil) {
    return Defect{std::move(spoil), VertexState::notUnit, &VertexCounts::notUnit};
  };
  return {{[](PathVertex& v) { v.discrete = true; }, VertexState::discrete, &VertexCounts::discrete},
          notFinite([](PathVertex& v) { v.position.y = NAN; }),
          notFinite([](PathVertex& v) { v.normal.z = INFINITY; }),
          notFinite([](PathVertex& v) { v.wi.x = NAN; }),
          notFinite([](PathVertex& v) { v.radiance.z = INFINITY; }),
          notFinite([](PathVertex& v) { v.pdf = NAN; }),
          notFinite([](PathVertex& v) { v.pdf = INFINITY; }),
          notFinite([](PathVertex& v) { v.cosine = INFINITY; }),
          noDensity([](PathVertex& v) { v.pdf = 0; }),
          noDensity([](PathVertex& v) { v.pdf = -1; }),
          noDensity([](PathVertex& v) { v.survival = 0; }),
          noDensity([](PathVertex& v) { v.survival = NAN; }),
          notUnit([](PathVertex& v) {
            v.normal = {0, 0, 1e-20f};
          }),
          notUnit([](PathVertex& v) {
            v.normal = {0, 0, 2};
          }),
          notUnit([](PathVertex& v) {
            v.wi = {0, 0, 0};
          }),
          notUnit([](PathVertex& v) {
            v.wi = {0, 6, 8};
          }),
          {[](PathVertex& v) { v.depth = 0; }, VertexState::noDepth, &VertexCounts::noDepth},
          {[](PathVertex& v) { v.wo = v.normal * -1.0f; }, VertexState::wrongSide, &VertexCounts::wrongSide},
          {[](PathVertex& v) { v.distance = -1; }, VertexState::outOfRange, &VertexCounts::outOfRange}};
}

TEST(PathVertex, IsUsableWithWhatIsRequired) {
  EXPECT_EQ(checkVertex(leastVertex()), VertexState::usable);
  EXPECT_TRUE(isUsable(leastVertex()));
  EXPECT_FALSE(isUsable(PathVertex()));
  // Interpolated normals are a little off.
  PathVertex v = leastVertex();
  v.normal = {0, 0, 0.97f};
  EXPECT_TRUE(isUsable(v));
}

TEST(PathVertex, EachDefectIsTold) {
  size_t i = 0;
  for (const Defect& defect : defects()) {
    PathVertex v = leastVertex();
    defect.spoil(v);
    EXPECT_EQ(checkVertex(v), defect.state) << "defect " << i++;
    EXPECT_FALSE(isUsable(v));
  }
}

TEST(VertexCounts, EachReasonIsCountedByBuilders) {
  size_t i = 0;
  for (const Defect& defect : defects()) {
    std::vector<PathVertex> vertices(10, leastVertex());
    for (const size_t spoiled : {2, 3, 7}) defect.spoil(vertices[spoiled]);
    GuideBuilder builder(withFormulas());
    builder.add(vertices);
    const VertexCounts counts = builder.vertexCounts();
    EXPECT_EQ(counts.accepted, 7u) << "defect " << i;
    EXPECT_EQ(refusedVertices(counts), 3u) << "defect " << i;
    EXPECT_EQ(counts.*defect.counted, 3u) << "defect " << i;
    // By both ways of adding.
    std::vector<VertexSamples> samples(2);
    samples[0] = builder.takeGuided(ArrayView<const PathVertex>(vertices).subview(0, 3));
    samples[1] = builder.takeGuided(ArrayView<const PathVertex>(vertices).subview(3, 7));
    builder.addToCells(samples);
    EXPECT_EQ(builder.vertexCounts().accepted, 14u) << "defect " << i;
    EXPECT_EQ(refusedVertices(builder.vertexCounts()), 6u) << "defect " << i;
    EXPECT_EQ(builder.vertexCounts().*defect.counted, 6u) << "defect " << i;
    ++i;
  }
}

TEST(VertexCounts, AddUp) {
  const VertexCounts one{sizeof one, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13};
  VertexCounts sum = one;
  addCounts(sum, one);
  EXPECT_EQ(refusedVertices(one), 77u);
  EXPECT_EQ(sum.accepted, 2u);
  EXPECT_EQ(sum.discrete, 4u);
  EXPECT_EQ(sum.notFinite, 6u);
  EXPECT_EQ(sum.noDensity, 8u);
  EXPECT_EQ(sum.notUnit, 10u);
  EXPECT_EQ(sum.noDepth, 12u);
  EXPECT_EQ(sum.outsideFrame, 14u);
  EXPECT_EQ(sum.wrongSide, 16u);
  EXPECT_EQ(sum.outOfRange, 18u);
  EXPECT_EQ(sum.guidableAbovePdf, 20u);
  EXPECT_EQ(sum.unknownLights, 22u);
  EXPECT_EQ(sum.twice, 24u);
  EXPECT_EQ(sum.inMedia, 26u);
}

TEST(VertexCounts, AreNothingBeforeAnythingIsAdded) {
  const VertexCounts counts = GuideBuilder().vertexCounts();
  EXPECT_EQ(counts.accepted, 0u);
  EXPECT_EQ(refusedVertices(counts), 0u);
}

TEST(VertexCounts, RefusedVerticesTeachNothing) {
  std::vector<PathVertex> vertices = floorUnderPatch(kBright, 5000, 1);
  GuideBuilder without, with;
  without.add(vertices);
  const Guide expected = without.build();
  // All have a place and a cell, so that nothing but their defects can keep them out.
  with.add(vertices);
  std::vector<PathVertex> refused;
  for (const Defect& defect : defects()) {
    refused.push_back(vertices[17]);
    defect.spoil(refused.back());
    // Vertices of surfaces with other lobes tell what returns, though they are refused
    // (HoldsWhatCoatsMirror).
    if (refused.back().discrete) refused.back().guidableProbability = 0;
  }
  with.addGuided(refused);
  EXPECT_EQ(refusedVertices(with.vertexCounts()), refused.size());
  EXPECT_TRUE(sameGuide(with.build(), expected));
}

TEST(VertexCounts, FramesCountWhatThePassDidNotAskFor) {
  FrameOptions options;
  options.width = options.height = 4;
  options.pilotSamplesPerPixel = 1;
  options.guide = withFormulas();
  Frame frame(options);
  const FramePass* pass = frame.beginPass();
  ASSERT_NE(pass, nullptr);
  ASSERT_TRUE(pass->wantsVertices);
  std::vector<FrameSample> samples;
  std::vector<PathVertex> vertices;
  for (uint32_t pixel = 0; pixel < 16; ++pixel) {
    samples.push_back({pixel, 0, {1, 1, 1}, 3});
    vertices.push_back(leastVertex());
    vertices.back().pixel = pixel;
  }
  vertices[3].pixel = 16;  // beyond the frame
  vertices[4].sample = 1;  // not yet
  vertices[5].wi = {};     // of no use
  frame.add(samples, vertices);
  frame.endPass();
  const VertexCounts counts = frame.vertexCounts();
  EXPECT_EQ(counts.accepted, 13u);
  EXPECT_EQ(counts.outsideFrame, 2u);
  EXPECT_EQ(counts.notUnit, 1u);
  EXPECT_EQ(refusedVertices(counts), 3u);
}

// A pilot of 1.3 M samples has more than 1.2 M: one pixel in two is enough, unless somebody asks for the
// vertices.
TEST(PathVertexTest, VeryLargeImagesAreLearnedFromInSomePixels) {
  FrameOptions options;
  options.width = 1300;
  options.height = 1000;
  options.samplesPerPixel = 2;
  options.pilotSamplesPerPixel = 1;
  options.guide = withFormulas();
  for (const bool keepsAll : {false, true}) {
    options.keepPilotVertices = keepsAll;
    Frame frame(options);
    ASSERT_NE(frame.beginPass(), nullptr);
    std::vector<FrameSample> samples;
    std::vector<PathVertex> vertices;
    for (uint32_t pixel = 0; pixel < options.width * options.height; ++pixel) {
      samples.push_back({pixel, 0, {1, 1, 1}, 3});
      if (pixel % 7 != 0) continue;
      vertices.push_back(leastVertex());
      vertices.back().pixel = pixel;
    }
    frame.add(samples, vertices);
    frame.endPass();
    const auto learned = [&](const PathVertex& v) { return keepsAll || v.pixel % options.width % 2 == 0; };
    EXPECT_EQ(frame.vertexCounts().accepted,
              size_t(std::count_if(vertices.begin(), vertices.end(), learned)));
  }
}

// Expects that a guide falls back on what is said where contributions are unknown, in all its cells.
void expectFallbacks(const Guide& guide, float fraction) {
  const GuideView view = guide.view();
  ASSERT_GT(view.cellCount, 100u);
  for (uint32_t cell = 0; cell < view.cellCount; ++cell) {
    const CellDecisions& decisions = view.decisions[cell];
    for (const float ofClass : decisions.bsdfFraction) ASSERT_EQ(ofClass, fraction);
    for (const float throughput : {0.0f, 1e-6f, 0.5f, 1e6f})
      ASSERT_EQ(survivalProbability(view.rules, decisions.survivalFactor, throughput), 1);
  }
  EXPECT_EQ(guide.predictedVarianceRatio(), 1);
}

TEST(Fallbacks, StandInForUnknownContributions) {
  using Field = float PathVertex::*;
  const std::vector<std::vector<Field>> unknown = {
      {&PathVertex::indirect},
      {&PathVertex::emission},
      {&PathVertex::light},
      {&PathVertex::raysAfter},
      {&PathVertex::indirect, &PathVertex::emission, &PathVertex::light, &PathVertex::raysAfter}};
  for (const GuideOptions& options : {withFormulas(), GuideOptions()})
    for (const std::vector<Field>& fields : unknown) {
      std::vector<PathVertex> vertices = floorUnderPatch(kBright, 5000, 1);
      for (PathVertex& v : vertices)
        for (const Field field : fields) v.*field = kUnknown;
      GuideBuilder builder(options);
      builder.add(vertices);
      EXPECT_EQ(builder.vertexCounts().accepted, vertices.size());
      expectFallbacks(builder.build(), kFallbackBsdfFraction);
      expectFallbacks(builder.build(std::vector<float>{1}), 0.5f);
    }
}

TEST(Fallbacks, AreThoseOfVerticesWithNothingButWhatIsRequired) {
  const std::vector<PathVertex> known = floorUnderPatch(kBright, 5000, 1);
  std::vector<PathVertex> vertices(known.size(), leastVertex());
  for (size_t i = 0; i < known.size(); ++i) {
    vertices[i].position = known[i].position;
    vertices[i].normal = known[i].normal;
    vertices[i].wi = known[i].wi;
    vertices[i].radiance = known[i].radiance;
    vertices[i].pdf = known[i].pdf;
  }
  GuideBuilder builder, all;
  builder.add(vertices);
  all.add(known);
  const Guide guide = builder.build(), expected = all.build();
  expectFallbacks(guide, 0.5f);
  // Nothing stands in for ended paths, nothing is known of lights; maps are what they are with all that is
  // optional.
  const GuideView view = guide.view();
  ASSERT_EQ(view.cellCount, expected.view().cellCount);
  for (uint32_t cell = 0; cell < view.cellCount; ++cell) {
    ASSERT_EQ(luminance(view.decisions[cell].outgoingRadiance), 0);
    ASSERT_EQ(learnedLights(view, cell).fraction, 0);
  }
  EXPECT_TRUE(sameBits(view.maps, expected.view().maps, size_t(view.cellCount) * kMapShares));
}

TEST(Fallbacks, GiveWayToAFixedFraction) {
  std::vector<PathVertex> vertices = floorUnderPatch(kBright, 5000, 1);
  for (PathVertex& v : vertices) v.indirect = kUnknown;
  GuideOptions options = withFormulas();
  options.fixedBsdfFraction = 0.3f;
  GuideBuilder builder(options);
  builder.add(vertices);
  expectFallbacks(builder.build(), 0.3f);
}

TEST(Fallbacks, AreNotAskedWhereSomeVerticesKnow) {
  std::vector<PathVertex> vertices = floorUnderPatch(kBright, 20000, 1);
  for (size_t i = 0; i < vertices.size(); i += 2) vertices[i].light = kUnknown;
  GuideBuilder builder(withFormulas());
  builder.add(vertices);
  const Guide guide = builder.build();
  const GuideView view = guide.view();
  const uint32_t cell = findCell(view, {{0.5f, 0.5f, 0}, {0, 0, 1}});
  ASSERT_NE(cell, kNoCell);
  EXPECT_LT(bsdfFraction(view, int32_t(cell), 1.0f), 0.5f);
  EXPECT_LT(view.decisions[cell].survivalFactor, INFINITY);
  EXPECT_LT(guide.predictedVarianceRatio(), 0.5f);
}

TEST(Fallbacks, StandInForUnknownDensitiesAndCosines) {
  // All of these BSDFs may be guided, and the cosine is that of the two directions: whoever leaves that out
  // gets the same guide.
  const std::vector<PathVertex> known = floorUnderPatch(kBright, 5000, 1);
  std::vector<PathVertex> unknown = known;
  for (PathVertex& v : unknown) v.guidablePdf = v.guidableProbability = v.cosine = kUnknown;
  GuideBuilder one, other;
  one.add(known);
  other.add(unknown);
  EXPECT_TRUE(sameGuide(one.build(), other.build()));
}

}  // namespace
}  // namespace odis::core
