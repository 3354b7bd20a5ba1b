// An image from its first sample to its last: what to trace next, guided by what, and what each sample
// weighs in the end. The host traces paths; the frame decides everything else and keeps the rules that
// leave the image unbiased.
//
//   odis::Frame frame(options);
//   while (const odis::FramePass* pass = frame.beginPass()) {
//     for each pixel, in any order, on any number of threads:
//       for each sample of frame.samples(pixel):
//         trace a path, guided by pass->guide (odis/guide_view.h);
//         record its vertices if pass->wantsVertices (odis/recorder.h)
//       frame.add(samples, vertices);  // of one path, of a tile, of everything
//     frame.endPass();
//   }
//   image[pixel] = frame.mean(pixel).color;
//
// What happens between the passes, in this order:
//   1. the pilot, unguided, tells of each pixel's value;
//   2. its vertices are gathered in cells; the model turns those into maps, BSDF sampling fractions, what
//      roulette needs and what the choice of lights needs;
//   3. guided samples follow; the guide is refined by the first of them, and after the first of all it is
//      settled how many samples each pixel has.
//
// Unbiasedness rests on these rules: a sample's guide was built before the sample was drawn, from other
// samples; what a sample weighs and whether it is drawn does not depend on its own value
// (docs/unbiasedness.md tells what is conditioned on what, and proves each decision).
#pragma once

#include <memory>

#include "odis/guide.h"
#include "odis/pixel_sums.h"

namespace odis {

struct FrameOptions {
  uint32_t width = 0, height = 0;  // of the rectangle of pixels that is rendered: an image, a crop or a tile
  uint32_t samplesPerPixel = 4;    // pilot included
  // Chooses the pilot's pixels; the host draws its random numbers from FramePass::seed.
  uint64_t seed = 0;
  bool guided = true;  // false: plain path tracing, without a pilot
  // Samples per pixel of the pilot; 0.25 is one sample in each 2 x 2 pixels. 0: 0.25 where that is enough
  // to learn from (the image is large) and a whole sample would be dear (there are few), else 1.
  double pilotSamplesPerPixel = 0;
  // Weight of a pilot sample relative to a guided one, from 0 on. A constant, because whatever the frame
  // learns, it learns from the pilot: weights by what was learned would bias the image.
  float pilotWeight = 0.6f;
  // Guided samples per pixel that the guide learns from as well: it is rebuilt after 1, 3, 7, ... if as
  // many are left.
  uint32_t refinementSamples = 3;
  // Whether pixels whose first samples differ more get more samples, for about as many rays. Needs at least
  // 4 samples per pixel.
  bool adaptive = true;
  // Further samples per pixel that the guide is made from instead of the pilot's, and that are no part of
  // the image: for experiments that ask what a better guide would gain. The guide is not refined then.
  uint32_t oracleSamples = 0;
  bool keepPilotVertices = false;  // whether pilotVertices() stay after the guide is built
  GuideOptions guide;
};

enum class PassKind : uint8_t { pilot, oracle, guided };

// What the host is to trace.
struct FramePass {
  PassKind kind = PassKind::guided;
  bool wantsVertices = false;
  bool partOfImage = true;
  // The seed of the random numbers. Passes that are no part of the image have another one, and in frames of
  // fewer than 1024 pixels each guide has one of its own (docs/unbiasedness.md#sobol-points).
  uint64_t seed = 0;
  // Number of samples of all passes of this kind and all pixels, for progress; about, where pixels have
  // different numbers.
  uint64_t stageSamples = 0;
  // Guides paths by what was learned; without cells where nothing was. Valid until endPass().
  GuideView guide;
};

// The samples [first, first + count) of a pixel.
struct SampleRange {
  uint32_t first = 0, count = 0;
};

// What a path brought to its pixel.
struct FrameSample {
  uint32_t pixel = 0, sample = 0;
  Float3 value;       // weighted by the reconstruction filter; what is not finite counts as black
  uint32_t rays = 0;  // traced for it, camera ray and shadow rays included
};

struct FrameStatistics {
  uint64_t samples = 0, pilotSamples = 0;
  uint64_t notFinite = 0;  // samples that counted as black
  uint64_t pilotVertices = 0;
  uint64_t cells = 0;
  uint64_t guideBytes = 0;
  uint64_t buildingBytes = 0;  // held at most while guides were built: vertices and what is made of them
  double pilotFraction = 0;    // of the pilot's samples in the mean of the image's weights
};

// Pixels are counted row by row. Memory: 112 bytes a pixel for sums, 12 for decisions; 188 bytes a pilot
// vertex until the guide is built; the guide's own. All functions throw std::logic_error when they are
// called out of order.
class Frame {
 public:
  // Throws std::invalid_argument where an option is out of its range.
  explicit Frame(const FrameOptions& options);
  ~Frame();
  Frame(Frame&&) noexcept;
  Frame& operator=(Frame&&) noexcept;

  // Begins the next pass; null when the image is complete, or a pass was interrupted.
  const FramePass* beginPass();
  // The samples of a pixel in the pass under way. They do not depend on what samples of that pixel brought.
  SampleRange samples(uint32_t pixel) const;
  // An estimate of each pixel's luminance, from the pilot; empty before the pilot has ended.
  ArrayView<const float> pixelValues() const;
  // Hands over samples of the pass, each with its vertices if the pass wants them. Thread-safe, in any
  // order and in portions of any size, with the same result: whole tiles of 16 x 16 pixels are handled on
  // the spot, whatever comes in parts is kept until its tile is complete or the pass ends. Throws
  // std::out_of_range for a sample that the pass did not ask for, and std::logic_error for one that comes
  // twice, where that can be told. Vertices of samples that are not due are left out
  // and counted (VertexCounts::outsideFrame), those of a pass that wants none are ignored.
  void add(ArrayView<const FrameSample> samples, std::vector<PathVertex> vertices = {});
  // Ends the pass: learns, builds the guide, settles what there is to settle. An interrupted pass may lack
  // samples; nothing is learned from it, and it is the last one.
  void endPass(bool interrupted = false);
  // Whether all further samples will be guided by the guide of today.
  bool guideIsFinal() const;

  // Weight of a sample in the mean of its pixel's samples, in units of a guided sample's. To be asked for
  // after the last pass. 1 for the pilot's, too, in a pixel that has no others.
  float sampleWeight(uint32_t pixel, uint32_t sample) const;
  // The weighted mean of the samples that a pixel has by now, and that mean's variance.
  PixelMean mean(uint32_t pixel) const;
  // The number of samples that a pixel has by now.
  uint32_t sampleCount(uint32_t pixel) const;

  FrameStatistics statistics() const;
  VertexCounts vertexCounts() const;
  const Guide& guide() const;
  // Sums over the pilot's samples of each pixel.
  ArrayView<const PixelSums> pilotImage() const;
  // The pilot's vertices, tile after tile, within a tile ordered by pixel, sample, depth. Empty once the
  // guide is built, unless they are kept.
  std::vector<PathVertex> pilotVertices() const;

 private:
  struct Data;
  std::unique_ptr<Data> m_data;
};

}  // namespace odis
