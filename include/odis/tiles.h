// How a frame divides its image: whole tiles are what it takes fastest, in any order.
#pragma once

#include "odis/cpp17.h"  // first of all

#include "odis/structs.h"

namespace odis {

inline constexpr uint32_t kTileSize = ODIS_TILE_SIZE;  // in pixels, across and down
inline constexpr uint32_t kTileBlock = 4;              // likewise

// The tiles of an image, counted row by row from 0. They are squares that begin kTileSize pixels apart, the
// first at (-tileOffsetX, -tileOffsetY), and are cut off at the image's borders. Within a tile pixels are
// ordered by blocks of 4 x 4, blocks and what is in them row by row, so that neighbours in the order are
// neighbours in the image. Pixels are counted row by row and must be those of the image, tiles likewise.
class TileGrid {
 public:
  // Width and height of the image, and the offsets of its tiles (OdisFrameOptions.tileOffsetX).
  TileGrid(uint32_t width, uint32_t height, uint32_t offsetX = 0, uint32_t offsetY = 0)
      : m_width(width),
        m_height(height),
        m_offsetX(offsetX),
        m_offsetY(offsetY),
        m_columns((m_offsetX + m_width + kTileSize - 1) / kTileSize),
        m_rows((m_offsetY + m_height + kTileSize - 1) / kTileSize) {}

  uint32_t columns() const { return m_columns; }
  uint32_t rows() const { return m_rows; }
  uint32_t tileCount() const { return m_columns * m_rows; }
  // The pixels of the image.
  uint32_t pixelCount() const { return m_width * m_height; }

  uint32_t tileOf(uint32_t pixel) const {
    return (pixel / m_width + m_offsetY) / kTileSize * m_columns + (pixel % m_width + m_offsetX) / kTileSize;
  }
  // The place of a pixel in the order of its tile, below kTileSize * kTileSize. Tiles that are cut off leave
  // out places.
  uint32_t placeInTile(uint32_t pixel) const {
    const uint32_t x = (pixel % m_width + m_offsetX) % kTileSize,
                   y = (pixel / m_width + m_offsetY) % kTileSize;
    return ((y / kTileBlock) * (kTileSize / kTileBlock) + x / kTileBlock) * kTileBlock * kTileBlock +
           (y % kTileBlock) * kTileBlock + x % kTileBlock;
  }
  // Calls visit(pixel) for each pixel of a tile, in the order of their places.
  template <class Visit>
  void forEachPixel(uint32_t tile, const Visit& visit) const {
    // In pixels from the corner of the first tile.
    const uint32_t x0 = tile % m_columns * kTileSize, y0 = tile / m_columns * kTileSize;
    for (uint32_t block = 0; block < kTileSize / kTileBlock * (kTileSize / kTileBlock); ++block)
      for (uint32_t i = 0; i < kTileBlock * kTileBlock; ++i) {
        const uint32_t x = x0 + block % (kTileSize / kTileBlock) * kTileBlock + i % kTileBlock - m_offsetX;
        const uint32_t y = y0 + block / (kTileSize / kTileBlock) * kTileBlock + i / kTileBlock - m_offsetY;
        // Before the image numbers wrap around, and are beyond it, too.
        if (x < m_width && y < m_height) visit(y * m_width + x);
      }
  }

 private:
  uint32_t m_width, m_height;
  uint32_t m_offsetX, m_offsetY;  // how far before the image the first tile begins
  uint32_t m_columns, m_rows;
};

}  // namespace odis
