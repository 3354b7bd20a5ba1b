// A host with a builder and no frame, as docs/own-film.md describes one.
#include "frame/run_frame.h"

namespace odis::test {

namespace {

constexpr uint32_t kBuilderSide = 48, kBuilderPixels = kBuilderSide * kBuilderSide, kBuilderSamples = 8;

// The samples [begin, end) of each pixel, in order, and their vertices.
TracedPass traceAll(const GuideView& guide, ArrayView<const float> values, uint64_t seed, uint32_t begin,
                    uint32_t end) {
  const ToyHost host({}, kBuilderSide, kBuilderSide);
  FramePass pass;
  pass.seed = seed;
  pass.guide = &guide;
  pass.pixelValues = values.data();
  PathRecorder recorder;
  TracedPass traced;
  for (uint32_t pixel = 0; pixel < kBuilderPixels; ++pixel)
    for (uint32_t i = begin; i < end; ++i) traced.samples.push_back(host.trace(pass, pixel, i, recorder));
  const ArrayView<const PathVertex> vertices = recorder.finish();
  traced.vertices.assign(vertices.begin(), vertices.end());
  return traced;
}

struct BuiltImage {
  std::vector<float> luminances = std::vector<float>(kBuilderPixels, 0.0f);
  int guides = 0;
  uint32_t cells = 0;  // of the last one

  void add(const TracedPass& traced, double weight) {
    for (const FrameSample& s : traced.samples)
      luminances[s.pixel] += float(weight * double(s.value.y) / kBuilderSamples);
  }
};

BuiltImage renderByBuilder(uint64_t seed) {
  // One pilot sample and seven guided ones.
  constexpr double kPilotWeight = 0.6, kAll = kPilotWeight + (kBuilderSamples - 1);
  GuideBuilder builder(toyOptions(1, 1, 1).guide);
  BuiltImage image;
  const TracedPass pilot = traceAll(GuideView(), {}, seed, 0, 1);
  image.add(pilot, kPilotWeight * kBuilderSamples / kAll);
  std::vector<PixelSums> sums(kBuilderPixels);
  for (const FrameSample& s : pilot.samples) addSample(sums[s.pixel], s.value, s.rays);
  const std::vector<float> values = estimatePixelValues(sums, kBuilderSide);
  builder.add(pilot.vertices);
  Guide guide = builder.build(values);
  image.guides = 1;
  for (uint32_t done = 1; done < kBuilderSamples;) {
    const uint32_t next = std::min(2 * done, kBuilderSamples);
    const TracedPass traced = traceAll(guide.view(), values, seed ^ uint64_t(image.guides) << 32, done, next);
    image.add(traced, kBuilderSamples / kAll);
    done = next;
    if (2 * done > kBuilderSamples) continue;
    builder.addGuided(traced.vertices);
    guide = builder.rebuild(guide);
    ++image.guides;
  }
  image.cells = guide.view().cellCount;
  return image;
}

TEST(BuilderHost, IsUnbiasedAndGuided) {
  std::vector<BuiltImage> images(static_cast<size_t>(imagesToCompare(64)));
  core::libraryTasks()->forEach(images.size(), [&](size_t i) { images[i] = renderByBuilder(1 + i); });
  Estimate guided;
  for (const BuiltImage& image : images) {
    EXPECT_EQ(image.guides, 3);
    EXPECT_GT(image.cells, 0u);
    guided.add(image.luminances, kBuilderSide);
  }
  FrameOptions options = toyOptions(kBuilderSide, kBuilderSide, kBuilderSamples);
  options.set("guided=off samples=even");
  const Estimate path = estimate(options, {}, 64, 1000);
  expectSameExpectation(guided, path);
  if (!kThreadSanitized) EXPECT_LT(guided.varianceOfMean(64), path.varianceOfMean(64));
}

}  // namespace

}  // namespace odis::test
