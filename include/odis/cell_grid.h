// Nested cells in world space: cubes of doubling size, each split by the dominant axis of the surface
// normal; vertices in media, which have none, have cells of their own, of twice the edge: media fill volumes.
// A cell is named by a key of 64 bits: three coordinates of 19 bits, the axis, the level.
//
// Up to the grid's reach all cells of a level have the same size. Beyond it they lie in rings, each twice as
// far out as the one before and made of cells twice as large, so that a horizon needs few of them. The number
// of the ring, times kRingStride >> level (level + 1 in media), is added to the first coordinate.
#pragma once

#include <cstring>

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
  // `reach` in edges of the finest cells, from the point that lies half of it from the origin along each
  // axis: kLeastReach to kMostReach; 0 if there is no end of it.
  CellGrid(const Float3& origin, float finestEdge, float reach = 0)
      : m_origin(origin), m_inverseEdge(1 / finestEdge), m_inverseReach(reach > 0 ? 1 / reach : 0) {}
  ODIS_HOST_DEVICE explicit CellGrid(const OdisCellGrid& grid)
      : m_origin(grid.origin), m_inverseEdge(grid.inverseEdge), m_inverseReach(grid.inverseReach) {}
  OdisCellGrid flat() const { return {m_origin, m_inverseEdge, m_inverseReach}; }
  bool operator==(const CellGrid& other) const {
    return m_origin.x == other.m_origin.x && m_origin.y == other.m_origin.y &&
           m_origin.z == other.m_origin.z && m_inverseEdge == other.m_inverseEdge &&
           m_inverseReach == other.m_inverseReach;
  }
  static constexpr float kLeastReach = 8, kMostReach = 640;
  Float3 origin() const { return m_origin; }
  float finestEdge() const { return 1 / m_inverseEdge; }
  // Returns a grid whose cells have `times` the edge and reach equally far.
  CellGrid coarser(int times) const {
    const float reach = m_inverseReach > 0 ? max(1 / m_inverseReach / float(times), kLeastReach) : 0;
    return CellGrid(m_origin, float(times) * finestEdge(), reach);
  }

  ODIS_HOST_DEVICE uint64_t key(const Float3& position, const Float3& normal, int level) const {
    assert(isIndex(level, kCellLevels));
    const Float3 local = (position - m_origin) * m_inverseEdge;
    const int ring = ringAround(local);
    const uint32_t axis = dominantAxis(normal);
    const float share = axis == kNoAxis ? 1.0f / (1 << kMediumDoublings) : 1.0f;
    const float scale = powerOfTwo(-exponentOf(ring)) * share;
    const float limit = m_inverseReach > 0 ? float(kRingMiddle - 1) : float(kMiddle - 1);
    const int stride = axis == kNoAxis ? kRingStride >> kMediumDoublings : kRingStride;
    return pack((coordinate(local.x * scale, limit) + ring * stride) >> level,
                coordinate(local.y * scale, limit) >> level, coordinate(local.z * scale, limit) >> level,
                axis, level);
  }

  // The edge of a cell's cube.
  ODIS_HOST_DEVICE float edge(uint64_t key) const {
    return powerOfTwo(doublingsOf(key) + exponentOf(ringOf(key))) / m_inverseEdge;
  }

  // The middle of a cell's cube.
  Float3 middle(uint64_t key) const {
    const float edge = this->edge(key);
    const int x = unpacked(key, 0) - (ringOf(key) * kRingStride >> doublingsOf(key));
    return m_origin + Float3{float(x) + 0.5f, float(unpacked(key, kBits)) + 0.5f,
                             float(unpacked(key, 2 * kBits)) + 0.5f} *
                          edge;
  }

  // Whether a cell lies within the grid's reach.
  bool isWithinReach(uint64_t key) const { return ringOf(key) == 0; }

  // The key of the cell of the same level that lies (x, y, z) cells away, as if rings had no end.
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
  // Whether a cell is one of a medium: its vertices have no normals, and all cosines are 1.
  ODIS_HOST_DEVICE static bool isOfMedium(uint64_t key) { return axisOf(key) == kNoAxis; }

 private:
  static constexpr int kBits = 19, kMiddle = 1 << (kBits - 1);
  static constexpr uint64_t kMask = (uint64_t(1) << kBits) - 1;
  // Coordinates of all rings stay below half a stride, and those of the outermost one within 19 bits.
  static constexpr int kRingBits = 11, kRingStride = 1 << kRingBits, kMostRing = 120;
  static constexpr int kRingMiddle = kRingStride / 2;
  static constexpr uint32_t kNoAxis = 6;
  // How often the edge of cells in media is doubled.
  static constexpr int kMediumDoublings = 1;
  // Cells of ring r have 2^(r + kRingExponent) times the edge of those within reach.
  static constexpr int kRingExponent = 2;

  ODIS_HOST_DEVICE static int exponentOf(int ring) { return ring > 0 ? ring + kRingExponent : 0; }
  // 2 to the power of `exponent`, which is in [-126, 127].
  ODIS_HOST_DEVICE static float powerOfTwo(int exponent) {
    const uint32_t bits = uint32_t(exponent + 127) << 23;
    float result;
    std::memcpy(&result, &bits, sizeof(result));
    return result;
  }
  // 0 within reach, 1 up to twice as far, 2 up to four times as far, and so on.
  ODIS_HOST_DEVICE int ringAround(const Float3& local) const {
    const auto along = [this](float x) { return abs(x * m_inverseReach - 0.5f); };
    const float most = powerOfTwo(kMostRing - 1);
    float distance = max(max(along(local.x), along(local.y)), along(local.z));
    distance = distance < most ? distance : most;
    uint32_t bits;
    std::memcpy(&bits, &distance, sizeof(bits));
    return max(int(bits >> 23) - 126, 0);
  }
  ODIS_HOST_DEVICE int ringOf(uint64_t key) const {
    const int doublings = doublingsOf(key);
    const int ring = (unpacked(key, 0) + (kRingMiddle >> doublings)) >> (kRingBits - doublings);
    return m_inverseReach > 0 ? min(max(ring, 0), kMostRing) : 0;
  }

  // How often the edge of a cell within reach is doubled.
  ODIS_HOST_DEVICE static int doublingsOf(uint64_t key) {
    return (levelOf(key) & 3) + (isOfMedium(key) ? kMediumDoublings : 0);
  }

  // Rounds down. Numbers are clamped to the limit either side of 0, which only merges what is absurdly far
  // away; what is not a number lies at the lower end.
  ODIS_HOST_DEVICE static int coordinate(float x, float limit) {
    x = x > -limit ? x : -limit;
    x = x < limit ? x : limit;
    const int towardsZero = int(x);
    return towardsZero - int(x < float(towardsZero));
  }
  // 0 to 5: +x, -x, +y, -y, +z, -z; 6 of zero, which is that of vertices in media.
  ODIS_HOST_DEVICE static uint32_t dominantAxis(const Float3& n) {
    const float x = abs(n.x), y = abs(n.y), z = abs(n.z);
    // Without branches, which would often be mispredicted: compilers choose between integers without.
    const bool isX = (x >= y) & (x >= z), isY = !isX & (y >= z);
    const uint32_t zero = kNoAxis * uint32_t(x + y + z == 0);  // its isX holds
    const uint32_t alongX = uint32_t(!(n.x >= 0)) + zero, alongY = 2 + uint32_t(!(n.y >= 0)),
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
  float m_inverseEdge = 1, m_inverseReach = 0;
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
