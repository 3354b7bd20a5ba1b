// What a frame keeps of the samples of each pixel.
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "odis/pixel_sums.h"

namespace odis::core {

// A sample of a pixel, in 16 bytes.
struct KeptSample {
  Float3 value{NAN, 0, 0};  // x is not a number where there is no sample
  uint32_t rays = 0;

  bool isThere() const { return !std::isnan(value.x); }
};

// Sums over the samples of each pixel, in 56 bytes a pixel; or the samples themselves where they are few,
// whose sums have the same bits; or nothing, which adds up to nothing.
class PixelSamples {
 public:
  PixelSamples() = default;
  static PixelSamples sums(size_t pixels) {
    PixelSamples result;
    result.m_sums.resize(pixels);
    return result;
  }
  // Room for `most` samples of each pixel, as they are or as sums: whatever takes less.
  static PixelSamples few(size_t pixels, uint32_t most) {
    if (most * sizeof(KeptSample) > sizeof(PixelSums)) return sums(pixels);
    PixelSamples result;
    result.m_perPixel = most;
    result.m_kept.resize(pixels * most);
    return result;
  }

  // Adds a sample whose value is finite, in the order of the pixel's samples. Beyond those that there is room
  // for none is kept.
  void add(uint32_t pixel, const Float3& value, uint32_t rays) {
    if (!m_sums.empty()) return addSample(m_sums[pixel], value, rays);
    if (m_kept.empty()) return;
    KeptSample* kept = &m_kept[size_t(pixel) * m_perPixel];
    for (uint32_t i = 0; i < m_perPixel; ++i)
      if (!kept[i].isThere()) {
        kept[i] = {value, rays};
        return;
      }
  }
  PixelSums operator[](size_t pixel) const {
    if (!m_sums.empty()) return m_sums[pixel];
    PixelSums sums;
    for (uint32_t i = 0; i < m_perPixel; ++i)
      if (const KeptSample& s = m_kept[pixel * m_perPixel + i]; s.isThere()) addSample(sums, s.value, s.rays);
    return sums;
  }
  // The number of pixels, 0 where nothing is kept.
  size_t size() const { return m_perPixel > 0 ? m_kept.size() / m_perPixel : m_sums.size(); }
  // What is kept: one of these at most has elements, [pixel] or [pixel][sample].
  const std::vector<PixelSums>& sums() const { return m_sums; }
  const std::vector<KeptSample>& kept() const { return m_kept; }
  // Replaces what is kept by that of a saved frame. Returns false, and changes nothing, if sizes differ.
  bool restore(std::vector<PixelSums> sums, std::vector<KeptSample> kept) {
    if (sums.size() != m_sums.size() || kept.size() != m_kept.size()) return false;
    m_sums = std::move(sums);
    m_kept = std::move(kept);
    return true;
  }

  uint64_t bytes() const {
    return m_sums.capacity() * sizeof(PixelSums) + m_kept.capacity() * sizeof(KeptSample);
  }

 private:
  std::vector<PixelSums> m_sums;   // [pixel]
  uint32_t m_perPixel = 0;         // of the kept samples
  std::vector<KeptSample> m_kept;  // [pixel][sample]
};

}  // namespace odis::core
