// Numbers of several paths side by side. Loops over lanes that call short functions without branches become
// vector instructions where they are compiled for them (ODIS_WIDE). Where many parameters come by reference,
// they are copied before the loop: compilers have to assume that writing a column may change what a reference
// leads to, and leave the loop as it is if too much would have to be checked for that.
#pragma once

#include <xmmintrin.h>

#include <cassert>
#include <cstddef>
#include <cstdint>

#include "render/math/vec.h"

namespace odis::render {

// How many paths lie side by side. The steps of a bounce have more instructions than the first-level cache
// holds, and each group of paths fetches them from the second-level cache again: larger groups do so less
// often. The columns of 64 paths take 48 KiB; 128 paths were slower.
inline constexpr size_t kLanes = 64;

// The end of a loop over the first `count` lanes: the next multiple of eight, so that vectors are full.
inline size_t endOfLanes(size_t count) {
  assert(count <= kLanes);
  return (count + 7) / 8 * 8;
}

// A number of each. Not a std::array, whose elements GCC 12 does not turn into vectors.
struct alignas(64) Column {
  float of[kLanes];

  float& operator[](size_t lane) { return of[lane]; }
  float operator[](size_t lane) const { return of[lane]; }
};

// An integer of each; as a mask it is 0 where something is not so.
struct alignas(64) IntColumn {
  int32_t of[kLanes];

  int32_t& operator[](size_t lane) { return of[lane]; }
  int32_t operator[](size_t lane) const { return of[lane]; }
};

// Some of the lanes.
struct LaneList {
  uint8_t lanes[kLanes];
  size_t count = 0;

  // Without a branch, which would often be mispredicted.
  void addIf(bool belongs, size_t lane) {
    assert(count < kLanes && lane < kLanes);
    lanes[count] = uint8_t(lane);
    count += belongs;
  }
  bool empty() const { return count == 0; }
  const uint8_t* begin() const { return lanes; }
  const uint8_t* end() const { return lanes + count; }
};

// A vector of each.
struct Columns3 {
  Column x, y, z;

  Vec3 operator[](size_t lane) const { return {x[lane], y[lane], z[lane]}; }
  void set(size_t lane, const Vec3& v) {
    x[lane] = v.x;
    y[lane] = v.y;
    z[lane] = v.z;
  }
};

// Four numbers that lie side by side, of each of the lanes `first` to `first` + 3, go to four columns, which
// are aligned to 16 bytes. row(lane) says where a lane has its four.
template <class Row>
[[gnu::always_inline]] inline void toColumns(size_t first, const Row& row, float* a, float* b, float* c,
                                             float* d) {
  __m128 r0 = _mm_loadu_ps(row(first)), r1 = _mm_loadu_ps(row(first + 1)), r2 = _mm_loadu_ps(row(first + 2)),
         r3 = _mm_loadu_ps(row(first + 3));
  _MM_TRANSPOSE4_PS(r0, r1, r2, r3);
  _mm_store_ps(a + first, r0);
  _mm_store_ps(b + first, r1);
  _mm_store_ps(c + first, r2);
  _mm_store_ps(d + first, r3);
}

// The way back: row(lane) says where the four numbers go.
template <class Row>
[[gnu::always_inline]] inline void fromColumns(size_t first, const Row& row, const float* a, const float* b,
                                               const float* c, const float* d) {
  __m128 r0 = _mm_load_ps(a + first), r1 = _mm_load_ps(b + first), r2 = _mm_load_ps(c + first),
         r3 = _mm_load_ps(d + first);
  _MM_TRANSPOSE4_PS(r0, r1, r2, r3);
  _mm_storeu_ps(row(first), r0);
  _mm_storeu_ps(row(first + 1), r1);
  _mm_storeu_ps(row(first + 2), r2);
  _mm_storeu_ps(row(first + 3), r3);
}

}  // namespace odis::render
