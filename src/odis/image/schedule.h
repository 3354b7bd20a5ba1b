// Which sample of which pixel is taken when.
#pragma once

#include <cassert>
#include <utility>
#include <vector>

#include "odis/options/options.h"

namespace odis::core {

using SampleRange = OdisSampleRange;

// The most samples per pixel that a frame is extended to.
inline constexpr uint32_t kMostSamplesPerPixel = 1u << 28;

// A pixel's first samples are the pilot's, where there is one; what remains is guided. The guide learns
// from the first samples that remain, too, and after some of them it is settled how many each pixel has. A
// byte a pixel where not all are in the pilot, and 4 once counts are settled.
//
// Whatever is decided goes by `most` samples per pixel, of which fewer may be asked for at first
// (mostSamplesPerPixel): which samples a pixel has of n samples per pixel is then a function of n and of its
// share of those of `most`. So a frame that is extended has the samples of one that was asked for as many at
// once.
//
// A place in the order of what remains after the pilot is the number of samples that are taken by then, up to
// decided() in each pixel. Beyond, it is counted in the pixel that has the most, as long as all of `most` are
// asked for at once; otherwise in the mean over the pixels.
class Schedule {
 public:
  explicit Schedule(const FrameOptions& options);

  // How many samples of the pixel belong to the pilot.
  uint32_t pilotCount(uint32_t pixel) const {
    assert(m_isInPilot.empty() || pixel < m_isInPilot.size());
    return m_isInPilot.empty() ? m_pilotEverywhere : m_isInPilot[pixel];
  }
  // The number of those in the pixel that has the most.
  uint32_t mostPilotSamples() const { return m_isInPilot.empty() ? m_pilotEverywhere : 1; }
  // The number of samples of all pilots together.
  uint64_t pilotSamples() const;
  // How many samples remain after them in all pixels together, as far as that is settled.
  uint64_t remainingSamples() const;
  // How many samples per pixel are asked for, and how many decisions go by.
  uint32_t samplesPerPixel() const { return m_spp; }
  uint32_t most() const { return m_most; }
  // How many samples a pixel has in all.
  uint32_t sampleCount(uint32_t pixel) const { return pilotCount(pixel) + doneIn(pixel, m_end); }
  // How many samples of `most` remain after the pilot in the pixel that has the most.
  uint32_t mostRemaining() const { return m_mostRemaining; }
  // The place where all samples that are asked for are taken.
  uint32_t end() const { return m_end; }
  // How many of what remains after the pilot a pixel has had at a place. While something may be decided all
  // have as many, later the same share of theirs: weights of a pixel's samples then add up to about the same
  // in all pixels whenever the rendering ends.
  uint32_t doneIn(uint32_t pixel, uint32_t place) const;
  // The samples of a pixel between two places.
  SampleRange remaining(uint32_t pixel, uint32_t begin, uint32_t end) const;

  // Where a pass ends that begins at `done`. Passes that something is decided after have as few samples as
  // can be, others as many as were taken before, while there is progress to be seen.
  uint32_t passEnd(uint32_t done) const;
  // After how many of the samples that remain the guide is built for the last time: one less than a power
  // of two, and at least as many samples must be left. 0: after the pilot only.
  uint32_t lastRefinement() const { return m_lastRefinement; }
  // After how many of them it is settled how many samples each pixel has; 0: all have as many.
  uint32_t spreadAfter() const { return m_spreadAfter; }
  // Whether it is known before a pass that begins at `done` how many samples each pixel has: that is settled,
  // or does not matter for so few samples.
  bool countsAreKnown(uint32_t done) const { return done >= m_spreadAfter || m_end <= m_spreadAfter; }
  // Has the guide built no more.
  void endRefinement() { m_lastRefinement = 0; }
  // Settles how many samples each pixel has by two of each, which tell more than one and a pilot's. Only
  // where the guide won't be built in between: the first ones' weights are then known after one pass as well.
  void spreadLater();
  // After how many of the samples that remain guided ones are compared with the pilot's.
  uint32_t comparedAfter() const { return m_lastRefinement > 0 ? 1 : std::max(m_spreadAfter, 1u); }

  // Whether the frame can be extended at any place; otherwise only at end().
  bool isExtendedAnywhere() const { return m_inTheMean; }
  // Asks for more samples per pixel, passes having come to `done`. Returns what that place is called now. As
  // a round of its own, what is taken by now keeps its weights, and each pixel has at least one more sample,
  // at 4 bytes a pixel; then passes must have come to end().
  uint32_t extend(uint32_t samplesPerPixel, uint32_t done, bool asRound);
  // Samples before the last round: per pixel, and those of each pixel after its pilot; none before the first
  // extension that is a round.
  struct Round {
    uint32_t samplesPerPixel = 0;
    std::vector<uint32_t> done;
  };
  const Round& before() const { return m_before; }
  // The extensions of a saved frame, counts being restored. Returns whether that can be.
  bool restore(uint32_t samplesPerPixel, Round before);
  // The first sample of a pixel whose weight is that of the last round.
  uint32_t firstOfRound(uint32_t pixel) const {
    return m_before.done.empty() ? 0 : pilotCount(pixel) + m_before.done[pixel];
  }

  // Settles that, spreadAfter() being done: `counts` are of all of a pixel's samples.
  void spread(std::vector<uint32_t> counts);
  // How many samples each pixel has, if that is settled; and settles it as it was in a saved frame. Returns
  // whether that can be.
  const std::vector<uint32_t>& counts() const { return m_counts; }
  bool restore(std::vector<uint32_t> counts);
  // How many samples remain after the pilot in a pixel, as a ratio to how many would if all pixels had as
  // many.
  float remainingRatio(uint32_t pixel) const;
  // What each of a pixel's samples weighs, one of the pilot's `pilotWeight` times as much as another one
  // would if all pixels had as many: all of them together weigh as much as there are samples per pixel. After
  // an extension that is a round, what those of the round weigh: as much as there are more per pixel.
  float sampleWeight(uint32_t pixel, bool ofPilot, double pilotWeight) const;

  uint64_t bytes() const {
    return m_isInPilot.size() + (m_counts.size() + m_before.done.size()) * sizeof(uint32_t);
  }

 private:
  // How many samples would remain after the pilot if all pixels had as many.
  uint32_t evenRemaining(uint32_t pixel) const;
  // 1 where a pixel's pilot is one of the samples that places count.
  uint32_t lag(uint32_t pixel) const { return m_isInPilot.empty() ? 0 : m_isInPilot[pixel]; }
  // The same as doneIn(), rounds aside.
  uint32_t shareIn(uint32_t pixel, uint32_t place) const;
  // How many samples are left in all pixels together after a place. 0 before it is settled how many each
  // pixel has.
  uint64_t samplesAfter(uint32_t done) const;

  uint64_t m_pixels;
  uint32_t m_width, m_spp, m_most;
  bool m_inTheMean;                  // whether places are counted in the mean over the pixels
  std::vector<uint8_t> m_isInPilot;  // [pixel] 1 for a sample, else 0; empty: m_pilotEverywhere
  uint32_t m_pilotEverywhere = 0;
  std::vector<uint32_t> m_counts;  // [pixel] all samples of m_most; empty: as many everywhere
  Round m_before;
  uint32_t m_mostRemaining, m_end, m_lastRefinement = 0, m_spreadAfter = 0;
  uint32_t m_decided = 0;  // after how many that remain nothing is decided any more
};

}  // namespace odis::core
