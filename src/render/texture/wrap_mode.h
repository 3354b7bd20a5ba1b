// What look-ups beyond the borders of images and grids come to.
#pragma once

namespace odis::render {

enum class WrapMode { repeat, clamp, mirror, zero, one };

// What an index beyond the borders turns into where there is no texel.
inline constexpr int kZeroTexel = -1, kOneTexel = -2;

// The index of the texel, of `n` in a row, that stands at index i.
inline int wrap(int i, int n, WrapMode mode) {
  if (i >= 0 && i < n) return i;
  switch (mode) {
    case WrapMode::repeat: {
      const int r = i % n;
      return r < 0 ? r + n : r;
    }
    case WrapMode::clamp:
      return i < 0 ? 0 : n - 1;
    case WrapMode::mirror: {
      int r = i % (2 * n);
      if (r < 0) r += 2 * n;
      return r < n ? r : 2 * n - 1 - r;
    }
    case WrapMode::zero:
      return kZeroTexel;
    case WrapMode::one:
      return kOneTexel;
  }
  return kZeroTexel;
}

// floor() as an int, of what fits one.
inline int floorOf(float x) {
  const int i = int(x);
  return i - int(float(i) > x);
}

}  // namespace odis::render
