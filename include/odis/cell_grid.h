// Nested cells in world space: cubes of doubling size, each split by the dominant axis of the surface
// normal. A cell is named by a key of 64 bits: three coordinates of 19 bits, the axis, the level.
#pragma once

#include "odis/number.h"
#include "odis/view.h"

namespace odis {

using CellSlot = OdisCellSlot;

inline constexpr uint32_t kNoCell = ODIS_NO_CELL;
inline constexpr int kCellLevels = ODIS_CELL_LEVELS;

// Where the cells lie: turns a vertex into the key of its cell at a level.
class CellGrid {
 public:
  CellGrid() = default;
  CellGrid(const Float3& origin, float finestEdge) : m_origin(origin), m_inverseEdge(1 / finestEdge) {}
  ODIS_HOST_DEVICE explicit CellGrid(const OdisCellGrid& grid)
      : m_origin(grid.origin), m_inverseEdge(grid.inverseEdge) {}
  OdisCellGrid flat() const { return {m_origin, m_inverseEdge}; }
  bool operator==(const CellGrid& other) const {
    return m_origin.x == other.m_origin.x && m_origin.y == other.m_origin.y &&
           m_origin.z == other.m_origin.z && m_inverseEdge == other.m_inverseEdge;
  }
  Float3 origin() const { return m_origin; }
  float finestEdge() const { return 1 / m_inverseEdge; }

  ODIS_HOST_DEVICE uint64_t key(const Float3& position, const Float3& normal, int level) const {
    assert(isIndex(level, kCellLevels));
    const Float3 local = (position - m_origin) * m_inverseEdge;
    return pack(coordinate(local.x) >> level, coordinate(local.y) >> level, coordinate(local.z) >> level,
                dominantAxis(normal), level);
  }

  // The middle of a cell's cube.
  Float3 middle(uint64_t key) const {
    const float edge = float(1 << levelOf(key)) / m_inverseEdge;
    const auto along = [&](int shift) { return (float(unpacked(key, shift)) + 0.5f) * edge; };
    return m_origin + Float3{along(0), along(kBits), along(2 * kBits)};
  }

  // The key of the cell of the same level that lies (x, y, z) cells away.
  static uint64_t neighbour(uint64_t key, int x, int y, int z) {
    return pack(unpacked(key, 0) + x, unpacked(key, kBits) + y, unpacked(key, 2 * kBits) + z, axisOf(key),
                levelOf(key));
  }

  // The key of the cell around a cell, one level coarser.
  ODIS_HOST_DEVICE static uint64_t parent(uint64_t key) {
    return pack(unpacked(key, 0) >> 1, unpacked(key, kBits) >> 1, unpacked(key, 2 * kBits) >> 1, axisOf(key),
                levelOf(key) + 1);
  }
  ODIS_HOST_DEVICE static int levelOf(uint64_t key) { return int(key >> 60); }

 private:
  static constexpr int kBits = 19, kMiddle = 1 << (kBits - 1);
  static constexpr uint64_t kMask = (uint64_t(1) << kBits) - 1;

  // Rounds down. Positions are clamped to 2^18 cells either side of the origin, which only merges what is
  // absurdly far away; what is not a number lies at the lower end.
  ODIS_HOST_DEVICE static int coordinate(float x) {
    constexpr float kLimit = kMiddle - 1;
    x = x > -kLimit ? x : -kLimit;
    x = x < kLimit ? x : kLimit;
    const int towardsZero = int(x);
    return towardsZero - int(x < float(towardsZero));
  }
  // 0 to 5: +x, -x, +y, -y, +z, -z.
  ODIS_HOST_DEVICE static uint32_t dominantAxis(const Float3& n) {
    const float x = abs(n.x), y = abs(n.y), z = abs(n.z);
    // Without branches, which would often be mispredicted: compilers choose between integers without.
    const bool isX = (x >= y) & (x >= z), isY = !isX & (y >= z);
    const uint32_t alongX = !(n.x >= 0), alongY = 2 + uint32_t(!(n.y >= 0)),
                   alongZ = 4 + uint32_t(!(n.z >= 0));
    return isX ? alongX : isY ? alongY : alongZ;
  }
  ODIS_HOST_DEVICE static uint64_t packed(int value) { return uint64_t(value + kMiddle) & kMask; }
  ODIS_HOST_DEVICE static int unpacked(uint64_t key, int shift) {
    return int((key >> shift) & kMask) - kMiddle;
  }
  ODIS_HOST_DEVICE static uint32_t axisOf(uint64_t key) { return uint32_t(key >> 57) & 7; }
  ODIS_HOST_DEVICE static uint64_t pack(int x, int y, int z, uint32_t axis, int level) {
    return packed(x) | packed(y) << kBits | packed(z) << (2 * kBits) | uint64_t(axis) << 57 |
           uint64_t(level) << 60;
  }

  Float3 m_origin;
  float m_inverseEdge = 1;
};

// The slot at which the search for a key begins, before the mask: the finalizer of MurmurHash3.
ODIS_HOST_DEVICE inline uint64_t cellHash(uint64_t key) {
  key = (key ^ (key >> 33)) * 0xff51afd7ed558ccdull;
  key = (key ^ (key >> 33)) * 0xc4ceb9fe1a85ec53ull;
  return key ^ (key >> 33);
}

// Finds the cell of a key by linear probing in a table of mask + 1 slots, a power of two, some of which are
// free; `hash` is cellHash(key). kNoCell if the key is not there or there is no table.
ODIS_HOST_DEVICE inline uint32_t findSlot(const CellSlot* slots, uint64_t mask, uint64_t key, uint64_t hash) {
  if (!slots) return kNoCell;
  assert((mask & (mask + 1)) == 0);
  for (uint64_t slot = hash & mask;; slot = (slot + 1) & mask) {
    if (slots[slot].cell == kNoCell) return kNoCell;
    if (slots[slot].key == key) return slots[slot].cell;
  }
}
ODIS_HOST_DEVICE inline uint32_t findSlot(const CellSlot* slots, uint64_t mask, uint64_t key) {
  return findSlot(slots, mask, key, cellHash(key));
}

}  // namespace odis
