// Nested cells in world space: cubes of doubling size, each split by the dominant axis of the surface normal.
#pragma once

#include <vector>

#include "odis/types.h"

namespace odis {

inline constexpr uint32_t kNoCell = 0xffffffffu;

// Where the cells lie: turns a vertex into the key of its cell at a level.
class CellGrid {
 public:
  CellGrid() = default;
  CellGrid(const Float3& origin, float finestEdge) : m_origin(origin), m_inverseEdge(1 / finestEdge) {}
  Float3 origin() const { return m_origin; }
  float finestEdge() const { return 1 / m_inverseEdge; }

  uint64_t key(const Float3& position, const Float3& normal, int level) const {
    const Float3 local = (position - m_origin) * m_inverseEdge;
    return pack(coordinate(local.x) >> level, coordinate(local.y) >> level, coordinate(local.z) >> level,
                dominantAxis(normal), level);
  }

  // The middle of a cell's cube.
  Float3 middle(uint64_t key) const {
    const float edge = float(1 << (key >> 60)) / m_inverseEdge;
    const auto along = [&](int shift) {
      return (float(int((key >> shift) & 0x7ffff) - (1 << 18)) + 0.5f) * edge;
    };
    return m_origin + Float3{along(0), along(19), along(38)};
  }

  // The key of the cell of the same level so many cells away.
  static uint64_t neighbour(uint64_t key, int x, int y, int z) {
    const auto moved = [&](int shift, int by) { return int((key >> shift) & 0x7ffff) - (1 << 18) + by; };
    return pack(moved(0, x), moved(19, y), moved(38, z), uint32_t(key >> 57) & 7, int(key >> 60));
  }

  // The key of the cell around a cell, one level coarser.
  static uint64_t parent(uint64_t key) {
    const auto halved = [&](int shift) { return (int((key >> shift) & 0x7ffff) - (1 << 18)) >> 1; };
    return pack(halved(0), halved(19), halved(38), uint32_t(key >> 57) & 7, int(key >> 60) + 1);
  }

 private:
  // Rounded down. Positions are clamped to 2^18 cells either side of the origin, which only merges what is
  // absurdly far away; what is not a number lies at the lower end.
  static int coordinate(float x) {
    constexpr float kLimit = (1 << 18) - 1;
    x = x > -kLimit ? x : -kLimit;
    x = x < kLimit ? x : kLimit;
    const int towardsZero = int(x);
    return towardsZero - int(x < float(towardsZero));
  }
  // 0 to 5: +x, -x, +y, -y, +z, -z.
  static uint32_t dominantAxis(const Float3& n) {
    const float x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
    if (x >= y && x >= z) return n.x >= 0 ? 0 : 1;
    if (y >= z) return n.y >= 0 ? 2 : 3;
    return n.z >= 0 ? 4 : 5;
  }
  static uint64_t pack(int x, int y, int z, uint32_t axis, int level) {
    const auto bits = [](int value) { return uint64_t(value + (1 << 18)) & 0x7ffff; };
    return bits(x) | bits(y) << 19 | bits(z) << 38 | uint64_t(axis) << 57 | uint64_t(level) << 60;
  }

  Float3 m_origin;
  float m_inverseEdge = 1;
};

// A hash table from cell keys to indices 0, 1, 2, ... in the order of insertion. Linear probing, at most half
// full.
class CellIndex {
 public:
  // The index of a key; kNoCell if it is not there.
  uint32_t find(uint64_t key) const {
    if (m_slots.empty()) return kNoCell;
    for (uint64_t slot = hash(key) & m_mask;; slot = (slot + 1) & m_mask) {
      if (m_slots[slot].index == kNoCell) return kNoCell;
      if (m_slots[slot].key == key) return m_slots[slot].index;
    }
  }
  // Asks for the place where find() will look to be fetched.
  void prefetch(uint64_t key) const {
    if (!m_slots.empty()) __builtin_prefetch(&m_slots[hash(key) & m_mask]);
  }
  // The index of a key, the next free one if it is new.
  uint32_t insert(uint64_t key) {
    if (2 * (m_size + 1) > m_slots.size()) grow();
    for (uint64_t slot = hash(key) & m_mask;; slot = (slot + 1) & m_mask) {
      if (m_slots[slot].index == kNoCell) {
        m_slots[slot] = {key, m_size};
        return m_size++;
      }
      if (m_slots[slot].key == key) return m_slots[slot].index;
    }
  }
  uint32_t size() const { return m_size; }
  uint64_t bytes() const { return m_slots.size() * sizeof(Slot); }

 private:
  struct Slot {
    uint64_t key = 0;
    uint32_t index = kNoCell;
  };
  // The finalizer of MurmurHash3.
  static uint64_t hash(uint64_t x) {
    x = (x ^ (x >> 33)) * 0xff51afd7ed558ccdull;
    x = (x ^ (x >> 33)) * 0xc4ceb9fe1a85ec53ull;
    return x ^ (x >> 33);
  }
  void grow() {
    std::vector<Slot> old = std::move(m_slots);
    m_slots.assign(old.empty() ? 1024 : old.size() * 2, {});
    m_mask = m_slots.size() - 1;
    for (const Slot& slot : old) {
      if (slot.index == kNoCell) continue;
      uint64_t place = hash(slot.key) & m_mask;
      while (m_slots[place].index != kNoCell) place = (place + 1) & m_mask;
      m_slots[place] = slot;
    }
  }

  std::vector<Slot> m_slots;
  uint64_t m_mask = 0;
  uint32_t m_size = 0;
};

}  // namespace odis
