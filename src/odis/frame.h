// An image from its first sample to its last: what to trace next, guided by what, and what each sample
// weighs in the end. The host traces paths; the frame decides everything else and keeps the rules that
// leave the image unbiased.
//
//   Frame frame(options);
//   while (const FramePass* pass = frame.beginPass()) {
//     for each pixel, in any order, on any number of threads:
//       for each sample of frame.samples(pixel):
//         trace a path, guided by pass->guide (odis/guide_view.h);
//         record its vertices if frame.wantsVertices(pixel) (odis/record/recorder.h)
//       frame.add(samples, vertices);  // of one path, of a tile, of everything
//     frame.endPass();
//   }
//   image[pixel] = frame.mean(pixel).color;
//
// What happens between the passes, in this order:
//   1. the pilot, unguided, tells of each pixel's value;
//   2. its vertices are gathered in cells; the model turns those into maps, BSDF sampling fractions, what
//      roulette needs and what the choice of lights needs;
//   3. guided samples follow; the guide is refined by the first of them where that is worth its time, and
//      after the first of all it is settled how many samples each pixel has.
//
// Unbiasedness rests on these rules: a sample's guide was built before the sample was drawn, from other
// samples; what a sample weighs and whether it is drawn does not depend on its own value
// (docs/unbiasedness.md tells what is conditioned on what, and proves each decision).
#pragma once

#include <memory>

#include "odis/guide.h"
#include "odis/pixel_sums.h"

namespace odis::core {

class VertexSource;

using FramePass = OdisFramePass;
using SampleRange = OdisSampleRange;
using FrameSample = OdisFrameSample;
using FrameStatistics = OdisFrameStatistics;

// Pixels are counted row by row. Memory: 112 bytes a pixel for means and 9 for decisions, or 53 and later
// 9 in all without means (odisNewFrame has the details); 84 bytes a vertex that is learned from, until the
// guide is built anew, 120 more for some of the pilot's, 188 more where vertices are kept; the guide's own.
// All functions throw std::logic_error when they are called out of order.
class Frame {
 public:
  // Throws std::invalid_argument where an option is out of its range. `builder` is the one to learn into,
  // whose options hold then; null: the frame makes its own.
  explicit Frame(const FrameOptions& options, std::shared_ptr<const Tasks> tasks = libraryTasks(),
                 std::shared_ptr<GuideBuilder> builder = nullptr);
  ~Frame();
  Frame(Frame&&) noexcept;
  Frame& operator=(Frame&&) noexcept;

  // Begins the next pass; null when the image is complete, or a pass was interrupted.
  const FramePass* beginPass();
  // The samples of a pixel in the pass under way. They do not depend on what samples of that pixel brought.
  SampleRange samples(uint32_t pixel) const;
  // Whether vertices of a pixel's samples in the pass under way are learned from or kept; those of other
  // pixels need not be recorded.
  bool wantsVertices(uint32_t pixel) const;
  // An estimate of each pixel's luminance, from the pilot; empty before the pilot has ended.
  ArrayView<const float> pixelValues() const;
  // Hands over samples of the pass, each with its vertices if the pass wants them. Thread-safe, in any
  // order and in portions of any size, with the same result: whole tiles of 16 x 16 pixels are handled on
  // the spot, whatever comes in parts is kept until its tile is complete or the pass ends. Throws
  // std::out_of_range for a sample that the pass did not ask for, and std::logic_error for one that comes
  // twice. Vertices of samples that are not due and vertices that come twice are left out and counted
  // (VertexCounts::outsideFrame, twice), those of a pass that wants none are ignored.
  void add(ArrayView<const FrameSample> samples, const VertexSource& vertices);
  void add(ArrayView<const FrameSample> samples, ArrayView<const PathVertex> vertices = {});
  // Ends the pass: learns, builds the guide, settles what there is to settle. An interrupted pass may lack
  // samples; nothing is learned from it, and it is the last one. What another pass lacks is counted.
  void endPass(bool interrupted = false);
  // Whether there is no pass any more.
  bool isComplete() const;
  // Asks for more samples per pixel, `samplesPerPixel` in all. Up to mostSamplesPerPixel the frame is then,
  // to the bit, what it would be had it been asked for as many from the beginning; beyond, what was decided
  // stays. Without keepPixelMeans what is added is a round of its own: all of a pixel's new samples, of which
  // there is one at least, weigh the same, and as much together as samplesPerPixel grows by. Throws
  // std::invalid_argument where it doesn't grow, or beyond 2^28, and std::logic_error within a pass, after an
  // interrupted one, and before all passes are done where the frame keeps no means or was asked for
  // mostSamplesPerPixel.
  void extend(uint32_t samplesPerPixel);
  // Whether all further samples will be guided by the guide of today.
  bool guideIsFinal() const;

  // Weight of a sample in the image: those of a pixel add up to the samples per pixel that are asked for,
  // however many it has (docs/unbiasedness.md#films-that-splat). As it will be once the number of samples is
  // settled, so after passes with weightsLater. Here and below std::out_of_range is thrown for a pixel
  // outside of the frame, here for a sample that it never has, and for one before the last extension that was
  // a round, too.
  float sampleWeight(uint32_t pixel, uint32_t sample) const;
  // The weighted mean of the samples that a pixel has by now, and that mean's variance. Throws
  // std::logic_error without keepPixelMeans.
  PixelMean mean(uint32_t pixel) const;
  // The number of samples that a pixel has by now; without keepPixelMeans that passes asked for which have
  // ended.
  uint32_t sampleCount(uint32_t pixel) const;

  FrameStatistics statistics() const;
  // The part of it that is known without looking at each pixel.
  FrameStatistics summary() const;
  VertexCounts vertexCounts() const;
  const Guide& guide() const;
  // Sums over the pilot's samples of each pixel. Throws std::logic_error without keepPixelMeans.
  ArrayView<const PixelSums> pilotImage() const;
  // The pilot's vertices, tile after tile, within a tile ordered by pixel, sample, depth. Empty once the
  // guide is built, unless they are kept.
  std::vector<PathVertex> pilotVertices() const;
  size_t pilotVertexCount() const;
  // Writes all that the frame is, between passes or within one; no call of add() may be under way. Vertices
  // and samples of tiles that are not complete are left out: the host traces them again.
  void save(ArchiveWriter& file) const;
  // The frame that was saved, which goes on where it was: beginPass() begins the rest of the pass that was
  // under way, and samples() answers none where they are in. `model` must be the one that the frame had.
  // Throws FileError.
  static Frame load(const Archive& file, std::optional<Model> model,
                    std::shared_ptr<const Tasks> tasks = libraryTasks());
  // Bytes of the host's that are saved with the frame.
  void setHostData(ArrayView<const uint8_t> bytes);
  ArrayView<const uint8_t> hostData() const;
  // Tells of progress from now on.
  void setProgress(OdisProgressFunction function, void* user);

  // As those of GuideBuilder; nothing where there is no builder any more.
  void limitBytes(uint64_t most);
  int coarsening() const;
  uint64_t samplesLeftOut() const;
  // Held now, without a builder that was given. Thread-safe.
  uint64_t bytes() const;

 private:
  struct Data;
  std::unique_ptr<Data> m_data;
};

}  // namespace odis::core
