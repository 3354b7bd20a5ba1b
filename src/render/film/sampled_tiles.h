// The pixels that are sampled for an image, and the tiles that they are traced by.
#pragma once

#include <odis/tiles.h>
#include <odis/odis.hpp>

#include <cassert>

#include "render/film/film_settings.h"

namespace odis::render {

// A rectangle of pixels of the full image. Its pixels are counted row by row, and so are its tiles, which are
// those that the library takes samples by.
class SampledTiles {
 public:
  // The first tile begins with the rectangle, or, for a film that splats, at a multiple of the tiles' size in
  // the full image: its sums are rounded tile by tile, and tiles of a crop are those of the whole.
  SampledTiles(const Crop& sampled, FilmKind kind)
      : m_sampled(sampled),
        m_offset(kind == FilmKind::splat ? Vec2i(behindMultiple(sampled.x), behindMultiple(sampled.y))
                                         : Vec2i(0, 0)),
        m_grid(uint32_t(sampled.width), uint32_t(sampled.height), uint32_t(m_offset.x),
               uint32_t(m_offset.y)) {}

  const Crop& sampled() const { return m_sampled; }
  // The image that a frame of the library is asked for.
  FrameOptions asFrame() const {
    FrameOptions image;
    image.width = uint32_t(m_sampled.width);
    image.height = uint32_t(m_sampled.height);
    image.tileOffsetX = uint32_t(m_offset.x);
    image.tileOffsetY = uint32_t(m_offset.y);
    return image;
  }

  uint32_t count() const { return m_grid.tileCount(); }
  // The first pixel of a tile, in the full image; it may lie before the rectangle.
  Vec2i corner(uint32_t tile) const {
    assert(tile < count());
    const auto size = int(kTileSize);
    const int column = int(tile % m_grid.columns()), row = int(tile / m_grid.columns());
    return Vec2i(m_sampled.x, m_sampled.y) - m_offset + Vec2i(column * size, row * size);
  }
  // Calls visit(pixel) for the numbers of the pixels of a tile, neighbours close to each other.
  template <class Visit>
  void forEachPixel(uint32_t tile, const Visit& visit) const {
    m_grid.forEachPixel(tile, visit);
  }
  // The number of a pixel of the full image, and the other way round.
  uint32_t pixelIndex(const Vec2i& at) const {
    return uint32_t(at.y - m_sampled.y) * uint32_t(m_sampled.width) + uint32_t(at.x - m_sampled.x);
  }
  Vec2i pixelAt(uint32_t index) const {
    return {m_sampled.x + int(index) % m_sampled.width, m_sampled.y + int(index) / m_sampled.width};
  }

 private:
  static int behindMultiple(int x) {
    const auto size = int(kTileSize);
    return (x % size + size) % size;
  }

  Crop m_sampled;
  Vec2i m_offset;  // how far before the rectangle the first tile begins
  TileGrid m_grid;
};

}  // namespace odis::render
