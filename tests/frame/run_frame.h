// Takes a frame through its passes with the toy host, and compares expectations.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "frame/toy_host.h"
#include "odis/work/tasks.h"
#include "support/sanitizers.h"

namespace odis::test {

// What a test may do to vertices before they are handed over.
using ChangeVertices = std::function<void(std::vector<PathVertex>& vertices)>;

struct TracedPass {
  std::vector<FrameSample> samples;
  std::vector<PathVertex> vertices;  // if the pass wants them
};

// Traces the samples of a pass that the first `pixels` pixels have, pixel by pixel, on one thread.
inline TracedPass tracePass(const Frame& frame, const FramePass& pass, const ToyHost& host, uint32_t pixels) {
  TracedPass traced;
  PathRecorder recorder;
  for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
    const SampleRange range = frame.samples(pixel);
    for (uint32_t i = 0; i < range.count; ++i)
      traced.samples.push_back(host.trace(pass, pixel, range.first + i, recorder));
    const ArrayView<const PathVertex> vertices = recorder.finish();
    traced.vertices.insert(traced.vertices.end(), vertices.begin(), vertices.end());
    if (!pass.wantsVertices) traced.vertices.clear();
  }
  return traced;
}

// Traces a pass and hands it over.
inline void runPass(Frame& frame, const FramePass& pass, const ToyHost& host, uint32_t pixels,
                    const ChangeVertices& change = {}) {
  TracedPass traced = tracePass(frame, pass, host, pixels);
  if (change) change(traced.vertices);
  frame.add(traced.samples, traced.vertices);
}

inline void runFrame(Frame& frame, const FrameOptions& options, const ToyRoom& room,
                     const ChangeVertices& change = {}) {
  const ToyHost host(room, options.width, options.height);
  while (const FramePass* pass = frame.beginPass()) {
    runPass(frame, *pass, host, options.width * options.height, change);
    frame.endPass();
  }
}

// Two frames that took the same samples and decided the same.
inline void expectSameDecisionsIn(const FrameStatistics& a, const FrameStatistics& b) {
  EXPECT_EQ(a.samples, b.samples);
  EXPECT_EQ(a.pilotSamples, b.pilotSamples);
  EXPECT_EQ(a.samplesPerPixel, b.samplesPerPixel);
  EXPECT_EQ(a.pilotFraction, b.pilotFraction);
  EXPECT_EQ(a.guidesBuilt, b.guidesBuilt);
  EXPECT_EQ(a.measuredCostRatio, b.measuredCostRatio);
  EXPECT_EQ(a.guidingGivenUp, b.guidingGivenUp);
}

inline FrameOptions toyOptions(uint32_t width, uint32_t height, uint32_t samplesPerPixel) {
  FrameOptions options;
  options.width = width;
  options.height = height;
  options.samplesPerPixel = samplesPerPixel;
  options.guide.lightGroups = 2;
  options.guide.set("cells=12");
  options.set("guided-cost=0");  // in so few pixels it would not pay to refine the guide
  return options;
}

inline std::vector<float> luminances(const Frame& frame, const FrameOptions& options) {
  std::vector<float> image;
  for (uint32_t pixel = 0; pixel < options.width * options.height; ++pixel)
    image.push_back(frame.mean(pixel).color.y);
  return image;
}

// Means over images of many seeds: of the whole image, and of each of 8 x 8 parts of it.
struct Estimate {
  static constexpr uint32_t kParts = 8;
  struct Value {
    double sum = 0, squares = 0;
  };
  std::vector<Value> values = std::vector<Value>(kParts * kParts + 1);  // the last one: the whole image
  int count = 0;

  void add(const std::vector<float>& image, uint32_t width) {
    const auto height = uint32_t(image.size()) / width;
    std::vector<double> sums(values.size()), pixels(values.size());
    for (uint32_t i = 0; i < image.size(); ++i) {
      const uint32_t part = i / width * kParts / height * kParts + i % width * kParts / width;
      for (const size_t v : {size_t(part), values.size() - 1}) {
        sums[v] += image[i];
        ++pixels[v];
      }
    }
    for (size_t v = 0; v < values.size(); ++v) {
      const double mean = sums[v] / pixels[v];
      values[v].sum += mean;
      values[v].squares += mean * mean;
    }
    ++count;
  }
  double mean(size_t v) const { return values[v].sum / count; }
  double varianceOfMean(size_t v) const {
    return std::max(values[v].squares / count - mean(v) * mean(v), 0.0) / (count - 1);
  }
};

// Renders with the seeds first, first + 1, ..., on all threads; `makeChange` gives each seed what changes
// its vertices.
inline Estimate estimate(const FrameOptions& options, const ToyRoom& room, int seeds, uint64_t first,
                         const std::function<ChangeVertices(uint64_t seed)>& makeChange = {}) {
  std::vector<std::vector<float>> images(static_cast<size_t>(imagesToCompare(seeds)));
  core::libraryTasks()->forEach(images.size(), [&](size_t i) {
    FrameOptions own = options;
    own.seed = first + i;
    Frame frame(own);
    runFrame(frame, own, room, makeChange ? makeChange(own.seed) : ChangeVertices());
    images[i] = luminances(frame, own);
  });
  Estimate result;
  for (const std::vector<float>& image : images) result.add(image, options.width);
  return result;
}

// Expects the same expectation of the image and of each of its parts, at a significance of 1 % over all of
// them (Šidák); means of 16 and more images are taken as normal.
inline void expectSameExpectation(const Estimate& a, const Estimate& b) {
  if (kThreadSanitized) return;
  const double significance = 1 - std::pow(0.99, 1.0 / double(a.values.size()));
  for (size_t v = 0; v < a.values.size(); ++v) {
    const double z = (a.mean(v) - b.mean(v)) / std::sqrt(a.varianceOfMean(v) + b.varianceOfMean(v));
    EXPECT_GT(std::erfc(std::abs(z) / std::sqrt(2.0)), significance)
        << (v + 1 == a.values.size() ? "image" : "part " + std::to_string(v)) << ": " << a.mean(v) << " and "
        << b.mean(v) << ", z = " << z;
  }
}

}  // namespace odis::test
