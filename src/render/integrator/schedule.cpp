#include "render/integrator/schedule.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "render/integrator/render.h"
#include "render/sampler/sampler.h"

namespace odis::render {

namespace {

// A pilot of a quarter of a sample per pixel is for images of at least so many pixels and fewer samples than that.
constexpr size_t kManyPixels = 200000;
constexpr int kManySamples = 8;
// Of fewer samples than this none are spread by what the first ones say.
constexpr int kFewestToSpread = 4;

double pilotSppOf(const RenderOptions& options, size_t pixels) {
  if (options.integrator != IntegratorKind::odis) return 0;
  if (options.pilotSpp > 0) return std::max(options.pilotSpp, 1e-3);
  return pixels >= kManyPixels && options.spp < kManySamples ? 0.25 : 1.0;
}

// For each pixel how many of its `spp` samples belong to the pilot: `pilotSpp` rounded, or, if that is below one, a sample
// in one pixel of each square of 1 / pilotSpp pixels (of the next whole side), which is chosen by a hash of the square
// and the seed.
std::vector<uint32_t> pilotCounts(size_t pixels, uint32_t width, double pilotSpp, uint32_t spp,
                                  uint64_t seed) {
  if (pilotSpp >= 1)
    return std::vector<uint32_t>(pixels, uint32_t(std::min(std::round(pilotSpp), double(spp))));
  std::vector<uint32_t> counts(pixels, 0);
  const uint32_t side = uint32_t(std::lround(1 / std::sqrt(pilotSpp)));
  const uint32_t height = uint32_t(pixels / width);
  for (uint32_t y = 0; y < height; y += side)
    for (uint32_t x = 0; x < width; x += side) {
      const uint64_t hash = mixBits(seed ^ (uint64_t(y / side) << 32 | (x / side)));
      const uint32_t chosenX = x + uint32_t(hash % side), chosenY = y + uint32_t((hash >> 32) % side);
      if (chosenX < width && chosenY < height) counts[size_t(chosenY) * width + chosenX] = 1;
    }
  return counts;
}

}  // namespace

Schedule::Schedule(const RenderOptions& options, size_t pixels, uint32_t width)
    : m_spp(uint32_t(options.spp)), m_pilotSpp(pilotSppOf(options, pixels)), m_mostRemaining(m_spp) {
  const bool guided = options.integrator == IntegratorKind::odis;
  if (guided) {
    m_pilotCounts = pilotCounts(pixels, width, m_pilotSpp, m_spp, options.seed);
    if (m_pilotSpp >= 1) m_mostRemaining -= pilotCount(0);
    if (options.guide != GuideKind::oracle)
      m_lastRefinement = std::bit_floor(std::min(uint32_t(options.refineSpp), m_mostRemaining / 2) + 1) - 1;
  }
  const bool adaptive =
      options.samples == SampleSpread::adaptive || (options.samples == SampleSpread::automatic && guided);
  // Two samples of a pixel tell how much they differ; a pilot's may be the first.
  if (adaptive && options.spp >= kFewestToSpread && m_pilotSpp + 2 < options.spp)
    m_spreadAfter = guided ? 1 : 2;
}

std::pair<uint32_t, uint32_t> Schedule::remaining(uint32_t pixel, uint32_t begin, uint32_t end) const {
  const uint32_t all = sampleCount(pixel), first = std::min(pilotCount(pixel) + begin, all);
  return {first, std::min(all - first, end - begin)};
}

uint32_t Schedule::passEnd(uint32_t done) const {
  const uint32_t count = done < m_lastRefinement ? 1 : done < m_spreadAfter ? m_spreadAfter : kSamplesPerPass;
  return std::min(m_mostRemaining, done + count);
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

float Schedule::remainingRatio(uint32_t pixel) const {
  const uint32_t pilot = pilotCount(pixel);
  return float(sampleCount(pixel) - pilot) / float(m_spp - pilot);
}

}  // namespace odis::render
