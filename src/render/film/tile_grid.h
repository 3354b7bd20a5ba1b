// The squares of pixels that an image is traced by.
#pragma once

#include <cassert>
#include <cstdint>

#include "render/film/film_settings.h"

namespace odis::render {

// A square of pixels, and the part of it that is sampled.
inline constexpr int kTileSize = 16;
struct Tile {
  Vec2i corner;    // of the square, in pixels of the full image
  Crop sampled;
};

// Covers a rectangle of pixels of the full image with tiles, row by row.
class TileGrid {
 public:
  // The first tile begins with the rectangle, or, for a film that splats, at a multiple of the tiles' size in
  // the full image: its sums are rounded tile by tile, and tiles of a crop are those of the whole.
  TileGrid(const Crop& sampled, FilmKind kind)
      : m_sampled(sampled),
        m_offset(kind == FilmKind::splat ? Vec2i(beforeMultiple(sampled.x), beforeMultiple(sampled.y))
                                         : Vec2i(0, 0)),
        m_columns(tiles(m_offset.x + sampled.width)),
        m_rows(tiles(m_offset.y + sampled.height)) {}

  uint32_t count() const { return uint32_t(m_columns * m_rows); }
  const Crop& sampled() const { return m_sampled; }
  // How far before the rectangle the first tile begins, in pixels.
  Vec2i offset() const { return m_offset; }
  Tile tile(uint32_t index) const {
    assert(index < count());
    const int column = int(index) % m_columns, row = int(index) / m_columns;
    const Vec2i corner(m_sampled.x - m_offset.x + column * kTileSize,
                       m_sampled.y - m_offset.y + row * kTileSize);
    const int x = std::max(corner.x, m_sampled.x), y = std::max(corner.y, m_sampled.y);
    return {corner,
            {x, y, std::min(corner.x + kTileSize, m_sampled.x + m_sampled.width) - x,
             std::min(corner.y + kTileSize, m_sampled.y + m_sampled.height) - y}};
  }
  // The number of a pixel of the full image among those that are sampled, row by row.
  uint32_t pixelIndex(const Vec2i& at) const {
    return uint32_t(at.y - m_sampled.y) * uint32_t(m_sampled.width) + uint32_t(at.x - m_sampled.x);
  }
  // The other way round.
  Vec2i pixelAt(uint32_t index) const {
    return {m_sampled.x + int(index) % m_sampled.width, m_sampled.y + int(index) / m_sampled.width};
  }

 private:
  static int tiles(int pixels) { return (pixels + kTileSize - 1) / kTileSize; }
  static int beforeMultiple(int x) { return (x % kTileSize + kTileSize) % kTileSize; }

  Crop m_sampled;
  Vec2i m_offset;
  int m_columns, m_rows;
};

}  // namespace odis::render
