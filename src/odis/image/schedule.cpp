#include "odis/image/schedule.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "odis/image/sample_counts.h"

namespace odis::core {

namespace {

// A pilot of a quarter of a sample per pixel is for images of at least this many pixels and fewer samples
// than that.
constexpr size_t kManyPixels = 50000;
constexpr uint32_t kManySamples = 32;
// The least number of samples per pixel that are spread by what the first ones say.
constexpr uint32_t kFewestToSpread = 4;
// The greatest number of samples per pixel in a pass, so that there is progress and an end in sight; the
// first ones have fewer, so that there is soon a picture. The last pass may have more in some pixels, but not
// on average.
constexpr uint32_t kSamplesPerPass = 8;

uint64_t mixBits(uint64_t x) {
  x = (x ^ (x >> 31)) * 0x7fb5d329728ea185ull;
  x = (x ^ (x >> 27)) * 0x81dadef4bc2dd44dull;
  return x ^ (x >> 33);
}

double pilotSamplesPerPixel(const FrameOptions& options) {
  if (options.pilotSamplesPerPixel > 0) return std::max(options.pilotSamplesPerPixel, 1e-3);
  const size_t pixels = size_t(options.width) * options.height;
  return pixels >= kManyPixels && options.most() < kManySamples ? 0.25 : 1.0;
}

// A fraction of 2^32 for each pixel, which differs much between those that are close: its numbers of samples
// are rounded up where what is cut off is at least 1 minus that.
uint32_t roundingOf(uint32_t x, uint32_t y) {
  return x * 3242174889u + y * 2447445414u;  // Roberts' R2: powers of the plastic number's inverse
}

// The pixels of a pilot of less than a sample per pixel: one of each square of 1 / pilotSpp pixels (of the
// next whole side), which is chosen by a hash of the square and the seed.
std::vector<uint8_t> pixelsInPilot(const FrameOptions& options, double pilotSpp) {
  std::vector<uint8_t> isInPilot(size_t(options.width) * options.height, 0);
  const uint32_t side = uint32_t(std::lround(1 / std::sqrt(pilotSpp)));
  for (uint32_t y = 0; y < options.height; y += side)
    for (uint32_t x = 0; x < options.width; x += side) {
      const uint64_t hash = mixBits(options.seed ^ (uint64_t(y / side) << 32 | (x / side)));
      const uint32_t chosenX = x + uint32_t(hash % side), chosenY = y + uint32_t((hash >> 32) % side);
      if (chosenX < options.width && chosenY < options.height)
        isInPilot[size_t(chosenY) * options.width + chosenX] = 1;
    }
  return isInPilot;
}

}  // namespace

Schedule::Schedule(const FrameOptions& options)
    : m_pixels(uint64_t(options.width) * options.height),
      m_width(options.width),
      m_spp(options.samplesPerPixel),
      m_most(options.most()),
      m_inTheMean(m_spp < m_most),
      m_mostRemaining(m_most) {
  double pilotSpp = 0;
  if (options.guided) {
    pilotSpp = pilotSamplesPerPixel(options);
    if (pilotSpp >= 1)
      m_pilotEverywhere = uint32_t(std::min(std::round(pilotSpp), double(m_most)));
    else
      m_isInPilot = pixelsInPilot(options, pilotSpp);
    m_mostRemaining -= m_pilotEverywhere;
    if (options.oracleSamples() == 0)
      m_lastRefinement = std::bit_floor(std::min(options.refinementSamples, m_mostRemaining / 2) + 1) - 1;
  }
  // Two samples of a pixel tell how much they differ; a pilot's may be the first.
  if (options.adaptive() && m_most >= kFewestToSpread && pilotSpp + 2 < m_most)
    m_spreadAfter = options.guided ? 1 : 2;
  m_decided = std::max(m_lastRefinement, m_spreadAfter);
  m_end = m_spp - m_pilotEverywhere;
}

void Schedule::spreadLater() {
  assert(m_lastRefinement == 0);
  if (m_spreadAfter == 0) return;
  m_spreadAfter = 2;
  m_decided = std::max(m_decided, m_spreadAfter);
}

uint64_t Schedule::pilotSamples() const {
  return m_isInPilot.empty() ? m_pixels * m_pilotEverywhere
                             : std::accumulate(m_isInPilot.begin(), m_isInPilot.end(), uint64_t(0));
}

uint64_t Schedule::remainingSamples() const {
  if (m_counts.empty() && !m_inTheMean) return m_pixels * m_spp - pilotSamples();
  uint64_t samples = 0;
  for (uint32_t pixel = 0; pixel < m_pixels; ++pixel) samples += doneIn(pixel, m_end);
  return samples;
}

SampleRange Schedule::remaining(uint32_t pixel, uint32_t begin, uint32_t end) const {
  const uint32_t first = doneIn(pixel, begin);
  return {pilotCount(pixel) + first, doneIn(pixel, end) - first};
}

uint32_t Schedule::doneIn(uint32_t pixel, uint32_t place) const {
  const uint32_t done = shareIn(pixel, place);
  if (m_before.done.empty()) return done;
  return std::max(done, m_before.done[pixel] + (place >= m_end ? 1 : 0));
}

uint32_t Schedule::shareIn(uint32_t pixel, uint32_t place) const {
  assert(m_counts.empty() || pixel < m_counts.size());
  const uint32_t all = (m_counts.empty() ? m_most : m_counts[pixel]) - pilotCount(pixel);
  if (place <= m_decided) return std::min(place, all);
  const uint32_t alike = std::min(m_decided, all);
  if (!m_inTheMean) {
    if (m_counts.empty() || place >= m_mostRemaining) return std::min(place, all);
    return alike + uint32_t(uint64_t(all - alike) * (place - m_decided) / (m_mostRemaining - m_decided));
  }
  const uint64_t decided = m_decided + lag(pixel);
  if (place <= decided) return alike;
  if (m_counts.empty()) return alike + uint32_t(place - decided);
  const uint64_t whole = m_most - m_pilotEverywhere - decided;
  const uint64_t rounding = whole * roundingOf(pixel % m_width, pixel / m_width) >> 32;
  return alike + uint32_t(((all - alike) * (place - decided) + rounding) / whole);
}

uint32_t Schedule::evenRemaining(uint32_t pixel) const {
  const uint32_t place = m_spp - m_pilotEverywhere;
  return place <= m_decided ? place : std::max(m_decided, place - lag(pixel));
}

uint32_t Schedule::passEnd(uint32_t done) const {
  if (done < m_lastRefinement) return std::min(m_end, done + 1);
  if (done < m_spreadAfter) return std::min(m_end, m_spreadAfter);
  const uint32_t few = std::clamp(done, 1u, kSamplesPerPass);
  if (m_counts.empty() || m_inTheMean) return std::min(m_end, done + few);
  // So many in the mean over the pixels.
  const double left = double(samplesAfter(done)) / double(m_counts.size());
  if (left <= kSamplesPerPass) return m_mostRemaining;
  return std::min(m_mostRemaining, done + uint32_t(std::ceil((m_mostRemaining - done) * few / left)));
}

uint64_t Schedule::samplesAfter(uint32_t done) const {
  uint64_t samples = 0;
  for (uint32_t pixel = 0; pixel < m_counts.size(); ++pixel)
    samples += remaining(pixel, done, m_mostRemaining).count;
  return samples;
}

void Schedule::spread(std::vector<uint32_t> counts) {
  for (uint32_t pixel = 0; pixel < counts.size(); ++pixel)
    counts[pixel] = std::max(counts[pixel], pilotCount(pixel) + m_spreadAfter);
  restore(std::move(counts));
}

bool Schedule::restore(std::vector<uint32_t> counts) {
  if (counts.empty()) return true;
  if (m_spreadAfter == 0) return false;
  uint32_t most = 0;
  for (uint32_t pixel = 0; pixel < counts.size(); ++pixel) {
    if (counts[pixel] < pilotCount(pixel) || double(counts[pixel]) > kGreatestShare * m_most) return false;
    most = std::max(most, counts[pixel] - pilotCount(pixel));
  }
  m_counts = std::move(counts);
  m_mostRemaining = most;
  if (!m_inTheMean) m_end = most;
  return true;
}

uint32_t Schedule::extend(uint32_t samplesPerPixel, uint32_t done, bool asRound) {
  if (asRound) {
    std::vector<uint32_t> taken(m_pixels);
    for (uint32_t pixel = 0; pixel < m_pixels; ++pixel) taken[pixel] = doneIn(pixel, done);
    m_before = {m_spp, std::move(taken)};
  }
  if (!m_inTheMean) done = m_most - m_pilotEverywhere;
  m_inTheMean = true;
  m_spp = samplesPerPixel;
  m_end = m_spp - m_pilotEverywhere;
  return done;
}

bool Schedule::restore(uint32_t samplesPerPixel, Round before) {
  if (samplesPerPixel == m_spp) return before.done.empty();
  if (samplesPerPixel < m_spp || samplesPerPixel > kMostSamplesPerPixel) return false;
  if (before.samplesPerPixel >= samplesPerPixel ||
      std::any_of(before.done.begin(), before.done.end(), [](uint32_t done) { return done > INT32_MAX; }))
    return false;
  extend(samplesPerPixel, 0, false);
  m_before = std::move(before);
  return true;
}

float Schedule::remainingRatio(uint32_t pixel) const {
  return float(doneIn(pixel, m_end)) / float(evenRemaining(pixel));
}

float Schedule::sampleWeight(uint32_t pixel, bool ofPilot, double pilotWeight) const {
  if (!m_before.done.empty())
    return float(double(m_spp - m_before.samplesPerPixel) / (doneIn(pixel, m_end) - m_before.done[pixel]));
  const uint32_t pilot = pilotCount(pixel), others = evenRemaining(pixel);
  if (others == 0 || (pilot == 0 && m_counts.empty())) return 1;
  const double all = pilotWeight * pilot + others;
  return float(m_spp / all * (ofPilot ? pilotWeight : double(others) / doneIn(pixel, m_end)));
}

}  // namespace odis::core
