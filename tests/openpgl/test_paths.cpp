// What the library makes of the segments that a host records.
#include <gtest/gtest.h>
#include <openpgl/cpp/OpenPGL.h>

#include <cmath>
#include <vector>

namespace {

namespace pgl = openpgl::cpp;

// A vertex at height z of a path that goes straight up.
pgl::PathSegment* addVertex(pgl::PathSegmentStorage& path, float z) {
  pgl::PathSegment* segment = path.NextSegment();
  pgl::SetPosition(segment, {0, 0, z});
  pgl::SetDirectionOut(segment, {0, 0, -1});
  pgl::SetNormal(segment, {0, 0, -1});
  return segment;
}

void scatter(pgl::PathSegment* segment, float weight, float pdf) {
  pgl::SetDirectionIn(segment, {0, 0, 1});
  pgl::SetPDFDirectionIn(segment, pdf);
  pgl::SetScatteringWeight(segment, {weight, weight, weight});
}

std::vector<pgl::SampleData> samplesOf(pgl::PathSegmentStorage& path) {
  path.PrepareSamples();
  size_t count = 0;
  const pgl::SampleData* data = path.GetSamples(count);
  return {data, data + count};
}

TEST(PglPaths, RadianceComesFromFurtherAlong) {
  pgl::PathSegmentStorage path;
  pgl::PathSegment* first = addVertex(path, 0);
  scatter(first, 0.5f, 0.25f);
  pgl::SetRussianRouletteProbability(first, 0.5f);
  pgl::PathSegment* second = addVertex(path, 2);
  pgl::SetScatteredContribution(second, {1, 1, 1});
  pgl::AddScatteredContribution(second, {1, 1, 1});
  pgl::SetDirectContribution(second, {3, 3, 3});
  pgl::SetMiWeight(second, 0.5f);
  scatter(second, 0.25f, 2);
  pgl::PathSegment* third = addVertex(path, 3);
  pgl::SetDirectContribution(third, {8, 8, 8});
  pgl::SetMiWeight(third, 0.75f);

  const std::vector<pgl::SampleData> samples = samplesOf(path);
  ASSERT_EQ(samples.size(), 2u);
  // Emission as it is; what the second vertex scatters over the probability that the path came to it.
  EXPECT_NEAR(samples[0].weight * samples[0].pdf, 3 * 0.5f + (2 + 0.25f * 8 * 0.75f) / 0.5f, 1e-5);
  EXPECT_EQ(samples[0].pdf, 0.25f);
  EXPECT_EQ(samples[0].distance, 2);
  EXPECT_NEAR(samples[1].weight * samples[1].pdf, 8 * 0.75f, 1e-5);
  EXPECT_EQ(samples[1].position.z, 2);
  EXPECT_NEAR(path.CalculatePixelEstimate(false).x, 0.5f * (1.5f + (2 + 1.5f) / 0.5f), 1e-5);
  EXPECT_TRUE(path.Validate());
}

TEST(PglPaths, NothingIsLearnedAtMirrorsNorWithoutANormal) {
  for (const bool mirror : {false, true}) {
    pgl::PathSegmentStorage path;
    scatter(addVertex(path, 0), 1, 1);
    pgl::PathSegment* middle = addVertex(path, 1);
    scatter(middle, 0.5f, 1);
    if (mirror)
      pgl::SetIsDelta(middle, true);
    else
      pgl::SetNormal(middle, {0, 0, 0});
    pgl::SetDirectContribution(addVertex(path, 2), {4, 4, 4});
    const std::vector<pgl::SampleData> samples = samplesOf(path);
    ASSERT_EQ(samples.size(), 1u);
    EXPECT_EQ(samples[0].position.z, 0);
    EXPECT_NEAR(samples[0].weight, 2, 1e-6);
  }
}

// In volumes Cycles may have more segments than it asks room for, and it writes into earlier ones.
TEST(PglPaths, SegmentsStayWhereTheyAreBeyondTheRoomThatWasAskedFor) {
  pgl::PathSegmentStorage path;
  path.Reserve(3);
  std::vector<pgl::PathSegment*> segments;
  for (int i = 0; i < 100; ++i) segments.push_back(addVertex(path, 0));
  for (int i = 0; i < 100; ++i) {
    pgl::SetPosition(segments[i], {0, 0, float(i)});
    pgl::SetVolumeScatter(segments[i], true);
    if (i < 99) scatter(segments[i], 1, 1);
  }
  pgl::SetDirectContribution(segments[99], {1, 1, 1});
  pgl::SetMiWeight(segments[99], 1);
  const std::vector<pgl::SampleData> samples = samplesOf(path);
  ASSERT_EQ(samples.size(), 99u);
  for (int i = 0; i < 99; ++i) EXPECT_EQ(samples[i].position.z, float(i));
}

TEST(PglPaths, VolumesAreVerticesAndTransmittanceIsPartOfWhatArrives) {
  pgl::PathSegmentStorage path;
  pgl::PathSegment* first = addVertex(path, 0);
  scatter(first, 1, 1);
  pgl::SetTransmittanceWeight(first, {0.5f, 0.5f, 0.5f});
  pgl::PathSegment* fog = addVertex(path, 1);
  scatter(fog, 0.75f, 0.25f);
  pgl::SetVolumeScatter(fog, true);
  pgl::SetTransmittanceWeight(fog, {0.25f, 0.25f, 0.25f});
  pgl::SetDirectContribution(addVertex(path, 2), {4, 4, 4});
  const std::vector<pgl::SampleData> samples = samplesOf(path);
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_NEAR(samples[0].weight * samples[0].pdf, 0.5f * 0.75f * 0.25f * 4, 1e-6);
  EXPECT_EQ(samples[0].flags, 0u);
  EXPECT_NEAR(samples[1].weight * samples[1].pdf, 0.25f * 4, 1e-6);
  EXPECT_EQ(samples[1].flags, uint32_t(pgl::SampleData::EInsideVolume));
  EXPECT_NEAR(path.CalculatePixelEstimate(false).x, 0.5f * 0.75f * 0.25f * 4, 1e-6);
  pgl::SampleStorage storage;
  storage.AddSamples(samples.data(), samples.size());
  EXPECT_EQ(storage.GetSizeSurface(), 1u);
  EXPECT_EQ(storage.GetSizeVolume(), 1u);
  EXPECT_EQ(storage.GetSampleVolume(0).position.z, 1);
  EXPECT_EQ(storage.GetSampleSurface(0).position.z, 0);
}

TEST(PglPaths, BackgroundIsOneMoreSegment) {
  pgl::PathSegmentStorage path;
  scatter(addVertex(path, 0), 1, 0.5f);
  pgl::PathSegment background;
  pgl::SetPosition(&background, {0, 0, 1e6f});
  pgl::SetDirectionOut(&background, {0, 0, -1});
  pgl::SetDirectContribution(&background, {2, 2, 2});
  path.AddSegment(background);
  const std::vector<pgl::SampleData> samples = samplesOf(path);
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_EQ(samples[0].weight, 4);
  EXPECT_GE(samples[0].distance, 1e6f);
}

TEST(PglPaths, DarkPathsGiveZeroSamples) {
  pgl::PathSegmentStorage path;
  scatter(addVertex(path, 0), 1, 1);
  addVertex(path, 1);
  EXPECT_TRUE(samplesOf(path).empty());
  EXPECT_EQ(path.GetNumZeroValueSamples(), 1);
  EXPECT_EQ(path.GetNumSegments(), 2);
  path.Clear();
  EXPECT_EQ(path.GetNumSegments(), 0);
  EXPECT_TRUE(samplesOf(path).empty());
}

TEST(PglPaths, SegmentsStayWhereTheyAreWhileOthersFollow) {
  pgl::PathSegmentStorage path;
  pgl::PathSegment* first = addVertex(path, 0);
  for (int i = 1; i < 1000; ++i) addVertex(path, float(i));
  pgl::SetEta(first, 1.5f);
  EXPECT_EQ(first->position.z, 0);
  EXPECT_EQ(path.GetNumSegments(), 1000);
}

TEST(PglPaths, WhatIsNotFiniteIsNoSample) {
  for (const float wrong : {NAN, INFINITY}) {
    pgl::PathSegmentStorage path;
    scatter(addVertex(path, wrong), 1, 1);
    pgl::SetDirectContribution(addVertex(path, 1), {1, 1, 1});
    EXPECT_FALSE(path.ValidateSegments());
    EXPECT_TRUE(samplesOf(path).empty());
  }
}

}  // namespace
