// A film of a host's own, as finished renderers have one: a filter that splats, AOVs and groups of lights.
#pragma once

#include <array>
#include <functional>

#include "frame/toy_host.h"

namespace odis::test {

// A reconstruction filter f(x) f(y), in pixels; 0 from the radius on.
struct SplatFilter {
  float radius;
  float (*value)(float x);
};
inline constexpr SplatFilter kBox{0.5f, [](float) { return 1.0f; }};
inline constexpr SplatFilter kGaussian{1.5f, [](float x) { return std::exp(-2 * x * x) - std::exp(-4.5f); }};

// The sums A (of each layer) and B over splatted samples (docs/unbiasedness.md#films-that-splat).
class SplatFilm {
 public:
  enum Layer { beauty, distance, upward, lamp0, lamp1, otherLight, kLayers };
  // A sample at a place in the image, in pixels.
  struct Splat {
    float x = 0, y = 0;
    std::array<float, kLayers> values{};
  };

  SplatFilm(uint32_t width, uint32_t height, const SplatFilter& filter)
      : m_width(int(width)), m_height(int(height)), m_filter(filter), m_pixels(size_t(width) * height) {}

  void add(const Splat& s, double weight) {
    const float r = m_filter.radius;
    const auto first = [&](float at) { return std::max(int(std::floor(at - r - 0.5f)) + 1, 0); };
    const auto end = [&](float at, int size) { return std::min(int(std::floor(at + r - 0.5f)) + 1, size); };
    for (int y = first(s.y); y < end(s.y, m_height); ++y)
      for (int x = first(s.x); x < end(s.x, m_width); ++x) {
        const double f = weight * double(m_filter.value(float(x) + 0.5f - s.x)) *
                         double(m_filter.value(float(y) + 0.5f - s.y));
        Pixel& pixel = m_pixels[size_t(y) * size_t(m_width) + size_t(x)];
        for (size_t i = 0; i < kLayers; ++i) pixel.sums[i] += f * double(s.values[i]);
        pixel.weights += f;
      }
  }

  double sum(size_t pixel, Layer layer) const { return m_pixels[pixel].sums[layer]; }
  double mean(size_t pixel, Layer layer) const { return sum(pixel, layer) / m_pixels[pixel].weights; }

 private:
  struct Pixel {
    std::array<double, kLayers> sums{};
    double weights = 0;
  };
  int m_width, m_height;
  SplatFilter m_filter;
  std::vector<Pixel> m_pixels;
};

// What a host makes of a sample: for the frame, and for its film.
struct FilmSample {
  FrameSample sample;
  SplatFilm::Splat splat;
};
using TraceForFilm =
    std::function<FilmSample(const FramePass& pass, uint32_t pixel, uint32_t sample, PathRecorder& recorder)>;

// Renders a frame into a film. Samples whose weights are settled by the end of their pass are kept until
// then. With `weightOne` each weighs 1, which is a mistake.
inline void renderInto(SplatFilm& film, Frame& frame, uint32_t pixels, const TraceForFilm& trace,
                       bool weightOne = false) {
  PathRecorder recorder;
  while (const FramePass* pass = frame.beginPass()) {
    const bool isInImage = pass->partOfImage, weightsLater = pass->weightsLater;
    std::vector<FilmSample> kept;
    for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
      const SampleRange range = frame.samples(pixel);
      std::vector<FrameSample> samples;
      for (uint32_t i = 0; i < range.count; ++i) {
        const FilmSample traced = trace(*pass, pixel, range.first + i, recorder);
        samples.push_back(traced.sample);
        if (isInImage && weightsLater)
          kept.push_back(traced);
        else if (isInImage)
          film.add(traced.splat, weightOne ? 1 : range.weight);
      }
      frame.add(samples, recorder.finish());
    }
    frame.endPass();
    for (const FilmSample& s : kept)
      film.add(s.splat, weightOne ? 1 : frame.sampleWeight(s.sample.pixel, s.sample.sample));
  }
}

// Renders a new frame into a film, in rounds: to each of these numbers of samples per pixel, and to that of
// the options, which is the most.
inline Frame renderRounds(SplatFilm& film, FrameOptions options, std::vector<uint32_t> rounds,
                          const TraceForFilm& trace, bool weightOne = false) {
  rounds.push_back(options.samplesPerPixel);
  options.mostSamplesPerPixel = rounds.back();
  options.samplesPerPixel = rounds.front();
  options.keepPixelMeans = false;
  Frame frame(options);
  for (const uint32_t samplesPerPixel : rounds) {
    if (samplesPerPixel > rounds.front()) frame.extend(samplesPerPixel);
    renderInto(film, frame, options.width * options.height, trace, weightOne);
  }
  return frame;
}

// What the toy host sees.
inline TraceForFilm toyTrace(const ToyHost& host) {
  return [&host](const FramePass& pass, uint32_t pixel, uint32_t sample, PathRecorder& recorder) {
    ToySight sight;
    FilmSample result;
    result.sample = host.trace(pass, pixel, sample, recorder, &sight);
    result.splat = {sight.x,
                    sight.y,
                    {result.sample.value.y, sight.distance, sight.normal.z, sight.byLamp[0], sight.byLamp[1],
                     sight.otherLight}};
    return result;
  };
}

}  // namespace odis::test
