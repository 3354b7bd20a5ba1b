#include "odis/image/schedule.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

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
  return pixels >= kManyPixels && options.samplesPerPixel < kManySamples ? 0.25 : 1.0;
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
      m_spp(options.samplesPerPixel),
      m_mostRemaining(options.samplesPerPixel) {
  double pilotSpp = 0;
  if (options.guided) {
    pilotSpp = pilotSamplesPerPixel(options);
    if (pilotSpp >= 1)
      m_pilotEverywhere = uint32_t(std::min(std::round(pilotSpp), double(options.samplesPerPixel)));
    else
      m_isInPilot = pixelsInPilot(options, pilotSpp);
    m_mostRemaining -= m_pilotEverywhere;
    if (options.oracleSamples() == 0)
      m_lastRefinement = std::bit_floor(std::min(options.refinementSamples, m_mostRemaining / 2) + 1) - 1;
  }
  // Two samples of a pixel tell how much they differ; a pilot's may be the first.
  if (options.adaptive() && m_spp >= kFewestToSpread && pilotSpp + 2 < m_spp)
    m_spreadAfter = options.guided ? 1 : 2;
  m_decided = std::max(m_lastRefinement, m_spreadAfter);
}

uint64_t Schedule::pilotSamples() const {
  return m_isInPilot.empty() ? m_pixels * m_pilotEverywhere
                             : std::accumulate(m_isInPilot.begin(), m_isInPilot.end(), uint64_t(0));
}

uint64_t Schedule::remainingSamples() const {
  const uint64_t all =
      m_counts.empty() ? m_pixels * m_spp : std::accumulate(m_counts.begin(), m_counts.end(), uint64_t(0));
  return all - pilotSamples();
}

SampleRange Schedule::remaining(uint32_t pixel, uint32_t begin, uint32_t end) const {
  if (m_counts.empty()) {
    const uint32_t pilot = pilotCount(pixel), first = std::min(pilot + begin, m_spp);
    return {first, std::min(m_spp - first, end - begin)};
  }
  const uint32_t first = doneIn(pixel, begin);
  return {pilotCount(pixel) + first, doneIn(pixel, end) - first};
}

uint32_t Schedule::doneIn(uint32_t pixel, uint32_t done) const {
  const uint32_t all = sampleCount(pixel) - pilotCount(pixel), alike = std::min(m_decided, all);
  if (done <= m_decided || done >= m_mostRemaining) return std::min(done, all);
  return alike + uint32_t(uint64_t(all - alike) * (done - m_decided) / (m_mostRemaining - m_decided));
}

uint32_t Schedule::passEnd(uint32_t done) const {
  if (done < m_lastRefinement) return done + 1;
  if (done < m_spreadAfter) return m_spreadAfter;
  const uint32_t few = std::clamp(done, 1u, kSamplesPerPass);
  if (m_counts.empty()) return std::min(m_mostRemaining, done + few);
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
  m_counts = std::move(counts);
  m_mostRemaining = 0;
  for (uint32_t pixel = 0; pixel < m_counts.size(); ++pixel) {
    const uint32_t pilot = pilotCount(pixel);
    m_counts[pixel] = std::max(m_counts[pixel], pilot + m_spreadAfter);
    m_mostRemaining = std::max(m_mostRemaining, m_counts[pixel] - pilot);
  }
}

bool Schedule::restore(std::vector<uint32_t> counts) {
  if (counts.empty()) return true;
  uint32_t most = 0;
  for (uint32_t pixel = 0; pixel < counts.size(); ++pixel) {
    if (counts[pixel] < pilotCount(pixel)) return false;
    most = std::max(most, counts[pixel] - pilotCount(pixel));
  }
  m_counts = std::move(counts);
  m_mostRemaining = most;
  return true;
}

float Schedule::remainingRatio(uint32_t pixel) const {
  const uint32_t pilot = pilotCount(pixel);
  return float(sampleCount(pixel) - pilot) / float(m_spp - pilot);
}

float Schedule::sampleWeight(uint32_t pixel, bool ofPilot, double pilotWeight) const {
  const uint32_t pilot = pilotCount(pixel), others = m_spp - pilot;
  if (others == 0 || (pilot == 0 && m_counts.empty())) return 1;
  const double all = pilotWeight * pilot + others;
  return float(m_spp / all * (ofPilot ? pilotWeight : double(others) / (sampleCount(pixel) - pilot)));
}

}  // namespace odis::core
