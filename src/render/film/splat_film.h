// A film that adds every sample to all pixels that the reconstruction filter reaches, as Mitsuba's and pbrt's
// do. A pixel q holds
//
//   A(q) = sum of w f(q - x) L,   B(q) = sum of w f(q - x),
//
// over samples with the place x, the value L and the weight w, f being the filter; what is shown is
// A(q) / B(q). Weights of the samples of a pixel add up to the same number in all pixels, however many there
// are (docs/unbiasedness.md#films-that-splat).
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "render/film/sampled_tiles.h"

namespace odis::render {

// Where a sample lies, and how much it counts.
struct SplatPlace {
  Vec2 offset;  // from the centre of its pixel, -0.5 to 0.5
  float weight = 1;
  uint16_t x = 0, y = 0;  // of its pixel in the tile
};

// How many numbers are added up of a sample, for each pixel that it reaches.
struct SplatChannels {
  int count = 4;
  // The first ones are multiplied by the filter, the others by its absolute value: means with the latter stay
  // between the values that they are of where the filter has negative lobes.
  int filtered = 4;
};

// Sums are kept tile by tile, each with a border that the filter reaches over, and joined in the order of the
// tiles when they are asked for: they are the same for any number of threads and for crops. Memory: 4 bytes a
// channel and pixel, times ((16 + 2 reach) / 16)^2, which is 1.27 for a tent of radius 1 and 1.56 for the
// default gaussian; samples that are kept take 16 bytes and 4 a channel.
class SplatFilm {
 public:
  SplatFilm(const FilmSettings& film, const SampledTiles& tiles, const SplatChannels& channels);

  int channels() const { return m_channels.count; }
  // Adds samples of a tile, [sample][channel]. Threads may add to different tiles.
  void add(uint32_t tile, std::span<const SplatPlace> places, std::span<const float> values);
  // Keeps samples whose weights are not known yet. Likewise.
  void keep(uint32_t tile, std::span<const SplatPlace> places, std::span<const float> values);
  // Adds those that were kept with the weight of their pixel, counted as SampledTiles::pixelIndex does.
  void addKept(const std::function<float(uint32_t pixel)>& weight);

  // [pixel of the crop][channel]
  std::vector<float> sums() const;

  // Appends all that there is.
  void save(std::vector<uint8_t>& bytes) const;
  // Reads it from the front of the bytes, which then begin behind it. Returns whether it fits this film.
  bool restore(std::span<const uint8_t>& bytes);

 private:
  struct Kept {
    std::vector<SplatPlace> places;
    std::vector<float> values;
  };

  size_t blockSize() const { return size_t(m_side) * size_t(m_side) * size_t(m_channels.count); }

  std::shared_ptr<const Filter> m_filter;
  Crop m_crop;
  SampledTiles m_tiles;
  SplatChannels m_channels;
  int m_reach, m_side;                       // of a tile with its border, in pixels
  std::vector<std::vector<float>> m_blocks;  // [tile][pixel][channel]; empty: nothing was added
  std::vector<Kept> m_kept;                  // [tile]
};

}  // namespace odis::render
