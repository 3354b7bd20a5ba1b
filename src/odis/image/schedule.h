// Which sample of which pixel is taken when.
#pragma once

#include <cassert>
#include <utility>
#include <vector>

#include "odis/options/options.h"

namespace odis::core {

using SampleRange = OdisSampleRange;

// A pixel's first samples are the pilot's, where there is one; what remains is guided. The guide learns
// from the first samples that remain, too, and after some of them it is settled how many each pixel has. A
// byte a pixel where not all are in the pilot, and 4 once counts are settled.
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
  // How many samples a pixel has in all.
  uint32_t sampleCount(uint32_t pixel) const {
    assert(m_counts.empty() || pixel < m_counts.size());
    return m_counts.empty() ? m_spp : m_counts[pixel];
  }
  // How many samples remain after the pilot in the pixel that has the most.
  uint32_t mostRemaining() const { return m_mostRemaining; }
  // The samples of a pixel among those between `begin` and `end` of what remains after the pilot, counted in
  // the pixel that has the most. While something may be decided pixels have as many as that one, later the
  // same share of theirs: weights of a pixel's samples then add up to about the same in all pixels whenever
  // the rendering ends.
  SampleRange remaining(uint32_t pixel, uint32_t begin, uint32_t end) const;

  // Where a pass ends that begins when `done` of the samples that remain are taken in the pixel that has the
  // most. Passes that something is decided after have as few samples as can be, others as many as were taken
  // before, while there is progress to be seen.
  uint32_t passEnd(uint32_t done) const;
  // After how many of the samples that remain the guide is built for the last time: one less than a power
  // of two, and at least as many samples must be left. 0: after the pilot only.
  uint32_t lastRefinement() const { return m_lastRefinement; }
  // After how many of them it is settled how many samples each pixel has; 0: all have as many.
  uint32_t spreadAfter() const { return m_spreadAfter; }
  // Has the guide built no more.
  void endRefinement() { m_lastRefinement = 0; }
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
  // would if all pixels had as many: all of them together weigh as much as there are samples per pixel.
  float sampleWeight(uint32_t pixel, bool ofPilot, double pilotWeight) const;

  uint64_t bytes() const { return m_isInPilot.size() + m_counts.size() * sizeof(uint32_t); }

 private:
  // How many of what remains after the pilot a pixel has had when the one with the most has had `done`.
  uint32_t doneIn(uint32_t pixel, uint32_t done) const;
  // How many samples are left in all pixels together when `done` of those that remain are taken in each. 0
  // before it is settled how many each pixel has.
  uint64_t samplesAfter(uint32_t done) const;

  uint64_t m_pixels;
  uint32_t m_spp;
  std::vector<uint8_t> m_isInPilot;  // [pixel] 1 for a sample, else 0; empty: m_pilotEverywhere
  uint32_t m_pilotEverywhere = 0;
  std::vector<uint32_t> m_counts;  // [pixel] all samples; empty: m_spp everywhere
  uint32_t m_mostRemaining, m_lastRefinement = 0, m_spreadAfter = 0;
  uint32_t m_decided = 0;  // after how many that remain nothing is decided any more
};

}  // namespace odis::core
