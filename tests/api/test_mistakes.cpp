// What hosts do wrong without noticing: each mistake is refused, or counted by its reason and told once.
#include <optional>
#include <thread>

#include "api/api_scene.h"
#include "api/listening.h"

namespace odis::test {
namespace {

constexpr uint32_t kSide = 40, kPixels = kSide * kSide;  // nine tiles, some of which are cut off

// A frame whose host hears what it is told, and the samples of its passes.
struct MistakenHost {
  explicit MistakenHost(OdisLogLevel level = ODIS_LOG_WARNING) {
    contextOptions.logLevel = level;
    options.width = options.height = kSide;
    options.samplesPerPixel = 3;
    options.set("pilot-spp=1");
    options.set("samples=even");
    options.set("guided-cost=0");
    options.guide.lightGroups = 2;
  }
  Frame makeFrame() { return Frame(options, Context(contextOptions)); }

  Heard heard;
  ContextOptions contextOptions = heardBy(heard);
  FrameOptions options;
};

std::vector<FrameSample> samplesOf(const Frame& frame, uint32_t begin = 0, uint32_t end = kPixels) {
  std::vector<FrameSample> samples;
  for (uint32_t pixel = begin; pixel < end; ++pixel)
    for (uint32_t i = 0; i < frame.samples(pixel).count; ++i)
      samples.push_back({pixel, frame.samples(pixel).first + i, {1, 1, 1}, 4});
  return samples;
}

// A vertex for each sample.
std::vector<PathVertex> verticesOf(const std::vector<FrameSample>& samples) {
  std::vector<PathVertex> vertices;
  for (const FrameSample& s : samples) {
    vertices.push_back(apiVertices()[(s.pixel * 7 + s.sample) % apiVertices().size()]);
    vertices.back().pixel = s.pixel;
    vertices.back().sample = s.sample;
  }
  return vertices;
}

using Spoil = void (*)(PathVertex& vertex);

// Takes a frame to its end; `spoil` changes one vertex of each pass that wants some.
void runSpoiled(Frame frame, Spoil spoil) {
  while (const FramePass* pass = frame.beginPass()) {
    const std::vector<FrameSample> samples = samplesOf(frame);
    std::vector<PathVertex> vertices = verticesOf(samples);
    spoil(vertices[33]);
    frame.add(samples, pass->wantsVertices ? vertices : std::vector<PathVertex>());
    frame.endPass();
  }
}

template <class Call>
void expectRefused(OdisError code, const Call& call) {
  try {
    call();
    ADD_FAILURE() << "expected: " << odisGetErrorName(code);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
  }
  EXPECT_EQ(takeError(), ODIS_ERROR_NONE);
}

TEST(ApiMistakes, VerticesAreCountedByReasonAndToldOnce) {
  struct Mistake {
    Spoil spoil;
    uint64_t VertexCounts::*count;
    const char* words;
    uint64_t passes = 2;  // the pilot, and the one that refines
  };
  constexpr uint64_t kPilot = 1;
  const Mistake mistakes[] = {
      {[](PathVertex& v) { v.normal = v.normal * -1.0f; }, &VertexCounts::wrongSide, "the other side"},
      {[](PathVertex& v) {
         v.wo = {0.9f, 0, -0.1f};
       },
       &VertexCounts::wrongSide, "the other side"},
      {[](PathVertex& v) { v.distance = -1; }, &VertexCounts::outOfRange, "out of its range"},
      {[](PathVertex& v) { v.distance = NAN; }, &VertexCounts::outOfRange, "out of its range"},
      {[](PathVertex& v) { v.survival = 1.5f; }, &VertexCounts::outOfRange, "out of its range"},
      {[](PathVertex& v) { v.cosine = -0.5f; }, &VertexCounts::outOfRange, "out of its range"},
      {[](PathVertex& v) { v.cosine = 1.5f; }, &VertexCounts::outOfRange, "out of its range"},
      {[](PathVertex& v) { v.roughness = -0.1f; }, &VertexCounts::outOfRange, "out of its range"},
      {[](PathVertex& v) { v.guidableProbability = 2; }, &VertexCounts::outOfRange, "out of its range"},
      {[](PathVertex& v) { v.guidablePdf = -1; }, &VertexCounts::outOfRange, "out of its range"},
      {[](PathVertex& v) { v.raysAfter = -3; }, &VertexCounts::outOfRange, "out of its range"},
      {[](PathVertex& v) { v.lightPdf = -1; }, &VertexCounts::outOfRange, "out of its range"},
      {[](PathVertex& v) { v.lightBsdfPdf = -1; }, &VertexCounts::outOfRange, "out of its range"},
      {[](PathVertex& v) { v.lightGuidablePdf = -1; }, &VertexCounts::outOfRange, "out of its range"},
      {[](PathVertex& v) { v.emissionLightPdf = -1; }, &VertexCounts::outOfRange, "out of its range"},
      {[](PathVertex& v) { v.lightGroupProbability = 7; }, &VertexCounts::outOfRange, "out of its range"},
      {[](PathVertex& v) { v.survival = 0; }, &VertexCounts::noDensity, "survival is not positive"},
      {[](PathVertex& v) { v.guidablePdf = 1.02f * v.pdf; }, &VertexCounts::guidableAbovePdf, "above",
       kPilot},
      {[](PathVertex& v) { v.lightGuidablePdf = 1; }, &VertexCounts::guidableAbovePdf, "above"},
      {[](PathVertex& v) { v.lightGroup = 2; }, &VertexCounts::unknownLights, "light group"},
      {[](PathVertex& v) { v.lightGroup = 99; }, &VertexCounts::unknownLights, "light group"},
      {[](PathVertex& v) { v.sample = 77; }, &VertexCounts::outsideFrame, "did not ask for"},
      {[](PathVertex& v) { v.pixel = 34; }, &VertexCounts::twice, "came before"}};
  for (const Mistake& mistake : mistakes) {
    SCOPED_TRACE(&mistake - mistakes);
    MistakenHost host;
    Frame frame = host.makeFrame();
    runSpoiled(frame, mistake.spoil);
    const VertexCounts counts = frame.vertexCounts();
    EXPECT_EQ(counts.*mistake.count, mistake.passes);
    EXPECT_EQ(refusedVertices(counts), mistake.passes);
    EXPECT_EQ(counts.accepted, 2 * kPixels - mistake.passes);
    EXPECT_EQ(host.heard.messages.size(), 1u);
    EXPECT_EQ(host.heard.count(mistake.words), 1);
  }
}

TEST(ApiMistakes, WhatIsNoMistakeIsTaken) {
  constexpr Spoil fine[] = {[](PathVertex& v) { v.wo = {}; },
                            [](PathVertex& v) {
                              v.wo = {1, 0, 0};
                            },
                            [](PathVertex& v) { v.guidablePdf = 1.005f * v.pdf; },
                            [](PathVertex& v) { v.roughness = 3; },
                            [](PathVertex& v) { v.distance = 0; },
                            [](PathVertex& v) { v.lightGroup = 1; },
                            [](PathVertex& v) { v.guidablePdf = v.guidableProbability = kUnknown; }};
  for (const Spoil spoil : fine) {
    MistakenHost host;
    Frame frame = host.makeFrame();
    runSpoiled(frame, spoil);
    EXPECT_EQ(refusedVertices(frame.vertexCounts()), 0u);
    EXPECT_TRUE(host.heard.messages.empty());
  }
  // A host that tells of lights that it learns nothing about.
  MistakenHost host;
  host.options.guide.lightGroups = 0;
  Frame frame = host.makeFrame();
  runSpoiled(frame, [](PathVertex& v) { v.lightGroup = 5; });
  EXPECT_EQ(refusedVertices(frame.vertexCounts()), 0u);
}

TEST(ApiMistakes, BuildersCountAndTellOnce) {
  Heard heard;
  GuideBuilder builder({}, Context(heardBy(heard)));
  std::vector<PathVertex> vertices = apiVertices();
  for (int i = 0; i < 5; ++i) vertices[size_t(i)].wo = {0, 0, -1};
  builder.add(vertices);
  builder.add(vertices);
  EXPECT_EQ(builder.vertexCounts().wrongSide, 10u);
  ASSERT_EQ(heard.messages.size(), 1u);
  EXPECT_EQ(heard.count("the other side than their wo: 5"), 1);
  EXPECT_EQ(odisBuildGuide(builder.get(), nullptr, 5), nullptr);
  EXPECT_EQ(takeError(), ODIS_ERROR_INVALID_ARGUMENT);
  // A vertex of a pixel that has no value.
  vertices[9].pixel = 1;
  builder.add(vertices);
  const float value = 1;
  EXPECT_EQ(odisBuildGuide(builder.get(), &value, 1), nullptr);
  EXPECT_EQ(takeError(), ODIS_ERROR_INVALID_ARGUMENT);
}

TEST(ApiMistakes, APassThatGetsNoVerticesIsTold) {
  // The rays of each sample, or 0 where the host does not count them: those of the camera alone have seen no
  // surface that scatters.
  for (const uint32_t rays : {0u, 1u, 4u}) {
    MistakenHost host;
    Frame frame = host.makeFrame();
    while (frame.beginPass()) {
      std::vector<FrameSample> samples = samplesOf(frame);
      for (FrameSample& s : samples) s.rays = rays;
      frame.add(samples);
      frame.endPass();
    }
    EXPECT_EQ(frame.statistics().passesWithoutVertices, rays == 1 ? 0u : 2u) << rays << " rays";
    EXPECT_EQ(host.heard.count("wants vertices"), rays == 1 ? 0 : 1);
  }
}

TEST(ApiMistakes, APassThatLacksSamplesIsTold) {
  MistakenHost host;
  Frame frame = host.makeFrame();
  uint64_t missing = 0;
  while (const FramePass* pass = frame.beginPass()) {
    const std::vector<FrameSample> samples = samplesOf(frame);
    const std::vector<PathVertex> vertices = verticesOf(samples);
    const size_t half = samples.size() / 2;
    frame.add({samples.data(), half}, {vertices.data(), pass->wantsVertices ? half : 0});
    frame.endPass();
    missing += samples.size() - half;
    EXPECT_EQ(frame.statistics().missingSamples, missing);
  }
  EXPECT_EQ(frame.statistics().samples, 3u * kPixels - missing);
  EXPECT_EQ(host.heard.messages.size(), 1u);
  EXPECT_EQ(host.heard.count("800 are missing"), 1);
}

TEST(ApiMistakes, AnInterruptedPassMayLackSamples) {
  MistakenHost host;
  Frame frame = host.makeFrame();
  frame.beginPass();
  frame.endPass(true);
  EXPECT_EQ(frame.statistics().missingSamples, 0u);
  EXPECT_TRUE(host.heard.messages.empty());
}

TEST(ApiMistakes, ASampleThatComesTwiceIsRefusedWithItsCall) {
  MistakenHost host;
  host.options.set("pilot-spp=2");
  Frame frame = host.makeFrame();
  frame.beginPass();
  const std::vector<FrameSample> samples = samplesOf(frame);
  const auto withTwice = [&](size_t begin, size_t end, size_t again) {
    std::vector<FrameSample> part(&samples[begin], samples.data() + end);
    part.push_back(samples[again]);
    return part;
  };
  const auto refuse = [&](const std::vector<FrameSample>& part) {
    expectRefused(ODIS_ERROR_INVALID_OPERATION, [&] { frame.add(part); });
  };
  refuse(withTwice(0, samples.size(), 0));
  refuse(withTwice(0, samples.size(), samples.size() - 1));
  refuse(withTwice(0, 1, 0));
  refuse(withTwice(10, 700, 500));
  // As many as are due, but one twice in the place of another.
  std::vector<FrameSample> replaced = samples;
  replaced[5] = replaced[4];
  refuse(replaced);
  // In two calls, of which the second one brings other samples, too, in the same tile and elsewhere.
  frame.add({samples.data() + 20, 30});
  refuse(withTwice(1000, 1100, 25));
  refuse(withTwice(50, 60, 20));
  refuse({samples[49]});
  // Nothing of what was refused is missed or doubled.
  frame.add({samples.data(), 20});
  frame.add({samples.data() + 50, samples.size() - 50});
  refuse({samples[3]});
  frame.endPass();
  for (uint32_t pixel = 0; pixel < kPixels; ++pixel) EXPECT_EQ(frame.sampleCount(pixel), 2u);
}

TEST(ApiMistakes, SamplesThatTwoThreadsBringAreTakenOnce) {
  MistakenHost host;
  Frame frame = host.makeFrame();
  frame.beginPass();
  const std::vector<FrameSample> samples = samplesOf(frame);
  std::atomic<uint64_t> refused{0};
  const auto bring = [&](size_t first) {
    for (size_t i = 0; i < samples.size(); ++i) {
      const FrameSample& sample = samples[(first + i) % samples.size()];
      if (odisAddSamples(frame.get(), &sample, 1, nullptr)) continue;
      ++refused;
      EXPECT_EQ(takeError(), ODIS_ERROR_INVALID_OPERATION);
    }
  };
  std::thread other([&] { bring(samples.size() / 3); });
  bring(0);
  other.join();
  frame.endPass();
  EXPECT_EQ(refused, samples.size());
  EXPECT_EQ(frame.statistics().samples, samples.size());
}

TEST(ApiMistakes, ABuilderHasOneFrameAtATime) {
  MistakenHost host;
  GuideBuilder builder(host.options.guide, Context(host.contextOptions));
  host.options.builder = builder;
  std::optional<Frame> first(host.makeFrame());
  Frame second = host.makeFrame();
  first->beginPass();
  const std::vector<PathVertex>& vertices = apiVertices();
  const auto refuses = [&](const auto& call) { expectRefused(ODIS_ERROR_INVALID_OPERATION, call); };
  refuses([&] { second.beginPass(); });
  refuses([&] { builder.add(vertices); });
  refuses([&] { builder.build(); });
  refuses([&] { builder.fade(0.5f); });
  refuses([&] { builder.forget(); });
  refuses([&] { builder.setBounds({}, {1, 1, 1}); });
  first->endPass(true);
  builder.fade(0.5f);
  EXPECT_TRUE(second.beginPass());
  first.reset();
  refuses([&] { builder.forget(); });
  second = host.makeFrame();
  runSpoiled(second, [](PathVertex&) {});
  builder.forget();
}

TEST(ApiMistakes, APixelOutsideOfTheFrameIsAnError) {
  MistakenHost host;
  Frame frame = host.makeFrame();
  for (const uint32_t pixel : {kPixels, kPixels + 1, 1u << 31, UINT32_MAX}) {
    expectRefused(ODIS_ERROR_INVALID_ARGUMENT, [&] { frame.mean(pixel); });
    expectRefused(ODIS_ERROR_INVALID_ARGUMENT, [&] { frame.sampleWeight(pixel, 0); });
    expectRefused(ODIS_ERROR_INVALID_ARGUMENT, [&] { frame.sampleCount(pixel); });
    OdisPixelMean mean;
    mean.color.x = 5;
    EXPECT_FALSE(odisGetPixelMean(frame.get(), pixel, &mean));
    EXPECT_EQ(mean.color.x, 5);
    EXPECT_EQ(takeError(), ODIS_ERROR_INVALID_ARGUMENT);
  }
  expectRefused(ODIS_ERROR_INVALID_ARGUMENT, [&] { frame.sampleWeight(0, 3); });
  EXPECT_FLOAT_EQ(frame.sampleWeight(0, 2), 3 / 2.6f);
  EXPECT_EQ(frame.sampleCount(kPixels - 1), 0u);
  expectRefused(ODIS_ERROR_INVALID_OPERATION, [&] { frame.wantsVertices(0); });
  frame.beginPass();
  EXPECT_TRUE(frame.wantsVertices(kPixels - 1));
  expectRefused(ODIS_ERROR_INVALID_ARGUMENT, [&] { frame.wantsVertices(kPixels); });
}

// What a function in C left that nobody asked about is not the error of a later one.
TEST(ApiMistakes, AnErrorThatNobodyAskedForIsNotThrownLater) {
  MistakenHost host;
  Frame frame = host.makeFrame();
  const auto fail = [&] { EXPECT_EQ(odisGetSampleCount(frame.get(), kPixels), 0u); };
  fail();
  EXPECT_EQ(frame.sampleCount(0), 0u);
  fail();
  EXPECT_TRUE(frame.pixelValues().empty());
  fail();
  EXPECT_FALSE(frame.guideIsFinal());
  fail();
  EXPECT_TRUE(frame.hostData().empty());
  fail();
  expectRefused(ODIS_ERROR_INVALID_OPERATION, [&] { frame.endPass(); });
  while (frame.beginPass()) {
    const std::vector<FrameSample> samples = samplesOf(frame);
    frame.add(samples, verticesOf(samples));
    frame.endPass();
    fail();
  }
  fail();
  EXPECT_EQ(frame.beginPass(), nullptr) << "the image is complete";
  PathRecorder recorder;
  fail();
  EXPECT_EQ(recorder.begin({}), 0u);
}

template <class Struct>
void expectSizesRefused(void (*initialize)(Struct*, size_t)) {
  Struct value;
  const size_t all = sizeof value;
  for (const size_t size : {size_t(0), size_t(1), size_t(8), size_t(12), all - 4, all + 8}) {
    std::memset(static_cast<void*>(&value), 7, sizeof value);
    initialize(&value, size);
    EXPECT_EQ(takeError(), ODIS_ERROR_INVALID_ARGUMENT) << size;
    EXPECT_EQ(*reinterpret_cast<const char*>(&value), 7) << "nothing is written";
  }
  initialize(&value, all);
  EXPECT_EQ(takeError(), ODIS_ERROR_NONE);
}

TEST(ApiMistakes, SizesThatNoStructHasAreRefused) {
  expectSizesRefused(odisInitFrameOptions);
  expectSizesRefused(odisInitGuideOptions);
  expectSizesRefused(odisInitContextOptions);
  expectSizesRefused(odisInitSurfaceEvent);
  expectSizesRefused(odisInitEmissionEvent);
  expectSizesRefused(odisInitLightEvent);
  expectSizesRefused(odisInitBounceEvent);
  expectSizesRefused(odisInitPathVertex);
  expectSizesRefused(odisInitPathVertices);
  OdisFrameOptions options;
  for (const size_t size : {size_t(0), size_t(8), size_t(12), sizeof options - 1, sizeof options + 8}) {
    options.size = size;
    EXPECT_EQ(odisNewFrame(Context::shared().get(), &options), nullptr);
    EXPECT_EQ(takeError(), ODIS_ERROR_INVALID_ARGUMENT) << size;
  }
}

}  // namespace
}  // namespace odis::test
