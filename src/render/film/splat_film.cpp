#include "render/film/splat_film.h"

#include <odis/instruction_sets.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace odis::render {

namespace {

constexpr int kMostTaps = 2 * kMostSplatReach + 1;

constexpr int kColorChannels = 4;

using Taps = std::array<float, kMostTaps>;

// The filter along both axes at the pixels around a sample.
struct FilterAround {
  Taps x, y;
  int taps;
};

// Adds a sample of four channels to the pixels around it, rows of which lie `stride` numbers apart.
inline __attribute__((always_inline)) void addColorsTo(const FilterAround& filter, int taps,
                                                       const float* value, float weight, size_t stride,
                                                       double* to) {
  const float scaled[kColorChannels] = {weight * value[0], weight * value[1], weight * value[2],
                                        weight * value[3]};
  alignas(32) double row[kColorChannels * kMostTaps];
  for (int k = 0; k < taps; ++k)
    for (int c = 0; c < kColorChannels; ++c)
      row[kColorChannels * k + c] = double(filter.x[size_t(k)]) * double(scaled[c]);
  for (int j = 0; j < taps; ++j, to += stride) {
    const double scale = filter.y[size_t(j)];
    for (int i = 0; i < kColorChannels * taps; ++i) to[i] += scale * row[i];
  }
}
// Loops of known length become straight code: those of a tent and of the default gaussian.
ODIS_WIDE void addColors(const FilterAround& filter, const float* value, float weight, size_t stride,
                         double* to) {
  if (filter.taps == 3) return addColorsTo(filter, 3, value, weight, stride, to);
  if (filter.taps == 5) return addColorsTo(filter, 5, value, weight, stride, to);
  addColorsTo(filter, filter.taps, value, weight, stride, to);
}

// The same of any channels, the first of which are multiplied by the filter, others by its absolute value.
void addChannels(const FilterAround& filter, const float* value, float weight, const SplatChannels& channels,
                 size_t stride, double* to) {
  for (int j = 0; j < filter.taps; ++j, to += stride) {
    double* at = to;
    for (int k = 0; k < filter.taps; ++k) {
      const double x = filter.x[size_t(k)], y = filter.y[size_t(j)];
      for (int c = 0; c < channels.count; ++c) {
        const double scaled = weight * value[c];
        *at++ += c < channels.filtered ? y * (x * scaled) : std::abs(y) * (std::abs(x) * scaled);
      }
    }
  }
}

// Appends an array with its length, and reads it again.
template <class T>
void append(std::vector<uint8_t>& bytes, const std::vector<T>& array) {
  const uint64_t size = array.size();
  const size_t at = bytes.size();
  bytes.resize(at + sizeof size + size * sizeof(T));
  std::memcpy(bytes.data() + at, &size, sizeof size);
  if (size > 0) std::memcpy(bytes.data() + at + sizeof size, array.data(), size * sizeof(T));
}
template <class T>
bool readArray(std::span<const uint8_t>& bytes, std::vector<T>& array) {
  uint64_t size = 0;
  if (bytes.size() < sizeof size) return false;
  std::memcpy(&size, bytes.data(), sizeof size);
  bytes = bytes.subspan(sizeof size);
  if (size > bytes.size() / sizeof(T)) return false;
  array.resize(size);
  if (size > 0) std::memcpy(static_cast<void*>(array.data()), bytes.data(), size * sizeof(T));
  bytes = bytes.subspan(size * sizeof(T));
  return true;
}

}  // namespace

SplatFilm::SplatFilm(const FilmSettings& film, const SampledTiles& tiles, const SplatChannels& channels)
    : m_filter(film.filter),
      m_crop(film.crop),
      m_tiles(tiles),
      m_channels(channels),
      m_reach(m_filter->reach()),
      m_side(int(kTileSize) + 2 * m_reach),
      m_blocks(tiles.count()),
      m_kept(tiles.count()) {
  assert(m_reach <= kMostSplatReach);
}

void SplatFilm::add(uint32_t tile, std::span<const SplatPlace> places, std::span<const float> values) {
  assert(tile < m_blocks.size());
  const auto channels = size_t(m_channels.count);
  assert(values.size() == places.size() * channels);
  const bool areColors = m_channels.count == kColorChannels && m_channels.filtered == kColorChannels;
  const size_t stride = size_t(m_side) * channels;
  // Sums of the few samples of a call, which are added to those of all before: so little is rounded away that
  // constants stay constant, and long renderings exact, in single precision.
  thread_local std::vector<double> block;
  block.assign(blockSize(), 0.0);
  FilterAround filter;
  filter.taps = 2 * m_reach + 1;
  for (size_t i = 0; i < places.size(); ++i) {
    const SplatPlace& place = places[i];
    assert(place.x < kTileSize && place.y < kTileSize);
    m_filter->taps(place.offset.x, filter.x.data());
    m_filter->taps(place.offset.y, filter.y.data());
    double* to = &block[size_t(place.y) * stride + size_t(place.x) * channels];
    if (areColors)
      addColors(filter, &values[i * channels], place.weight, stride, to);
    else
      addChannels(filter, &values[i * channels], place.weight, m_channels, stride, to);
  }
  std::vector<float>& sums = m_blocks[tile];
  if (sums.empty()) sums.assign(blockSize(), 0.0f);
  for (size_t i = 0; i < sums.size(); ++i) sums[i] += float(block[i]);
}

void SplatFilm::keep(uint32_t tile, std::span<const SplatPlace> places, std::span<const float> values) {
  Kept& kept = m_kept[tile];
  kept.places.insert(kept.places.end(), places.begin(), places.end());
  kept.values.insert(kept.values.end(), values.begin(), values.end());
}

void SplatFilm::addKept(const std::function<float(uint32_t pixel)>& weight) {
  tbb::parallel_for(uint32_t(0), m_tiles.count(), [&](uint32_t tile) {
    Kept& kept = m_kept[tile];
    if (kept.places.empty()) return;
    const Vec2i corner = m_tiles.corner(tile);
    for (SplatPlace& place : kept.places)
      place.weight = weight(m_tiles.pixelIndex(corner + Vec2i(place.x, place.y)));
    add(tile, kept.places, kept.values);
    kept = {};
  });
}

std::vector<float> SplatFilm::sums() const {
  const auto channels = size_t(m_channels.count);
  std::vector<float> result(m_crop.pixels() * channels, 0.0f);
  for (uint32_t tile = 0; tile < m_tiles.count(); ++tile) {
    if (m_blocks[tile].empty()) continue;
    // Where the block begins, in pixels of the crop.
    const int left = m_tiles.corner(tile).x - m_reach - m_crop.x,
              top = m_tiles.corner(tile).y - m_reach - m_crop.y;
    const int x0 = std::max(left, 0), x1 = std::min(left + m_side, m_crop.width);
    if (x0 >= x1) continue;
    for (int y = std::max(top, 0); y < std::min(top + m_side, m_crop.height); ++y) {
      const float* from = &m_blocks[tile][size_t((y - top) * m_side + x0 - left) * channels];
      float* to = &result[(size_t(y) * size_t(m_crop.width) + size_t(x0)) * channels];
      for (size_t i = 0; i < size_t(x1 - x0) * channels; ++i) to[i] += from[i];
    }
  }
  return result;
}

void SplatFilm::save(std::vector<uint8_t>& bytes) const {
  for (uint32_t tile = 0; tile < m_tiles.count(); ++tile) {
    append(bytes, m_blocks[tile]);
    append(bytes, m_kept[tile].places);
    append(bytes, m_kept[tile].values);
  }
}

bool SplatFilm::restore(std::span<const uint8_t>& bytes) {
  for (uint32_t tile = 0; tile < m_tiles.count(); ++tile) {
    Kept& kept = m_kept[tile];
    if (!readArray(bytes, m_blocks[tile]) || !readArray(bytes, kept.places) || !readArray(bytes, kept.values))
      return false;
    if (!m_blocks[tile].empty() && m_blocks[tile].size() != blockSize()) return false;
    if (kept.values.size() != kept.places.size() * size_t(m_channels.count)) return false;
    for (const SplatPlace& place : kept.places) {
      const bool isInPixel = std::abs(place.offset.x) <= 0.5f && std::abs(place.offset.y) <= 0.5f;
      if (place.x >= kTileSize || place.y >= kTileSize || !isInPixel) return false;
    }
  }
  return true;
}

}  // namespace odis::render
