#include "odis/maps/histogram.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "odis/instruction_sets.h"

namespace odis::core {

Splat splat(const Float3& wi) {
  const Float2 square = directionToSquare(wi);
  // Directions that are not numbers have some place, too.
  const auto place = [](float at) { return min(max(at * kMapSize - 0.5f, -0.5f), kMapSize - 0.5f); };
  const float x = place(square.x), y = place(square.y);
  // Rounded down, as no coordinate is less than -1: std::floor() is a call.
  const int x0 = int(x + 1) - 1, y0 = int(y + 1) - 1;
  const float fx = x - float(x0), fy = y - float(y0);
  return {{wrappedTexel(x0, y0), wrappedTexel(x0 + 1, y0), wrappedTexel(x0, y0 + 1),
           wrappedTexel(x0 + 1, y0 + 1)},
          {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy}};
}

namespace {

// Where the rim of a map continues: the texels around it, from the upper left corner along the upper side,
// the lower side, and then the left and the right side. Corners are the texels diagonally opposite.
struct RimTexels {
  std::array<uint8_t, kMapSize + 2> above, below;
  std::array<uint8_t, kMapSize> left, right;
  RimTexels() {
    for (size_t i = 0; i < above.size(); ++i) {
      above[i] = uint8_t(wrappedTexel(int(i) - 1, -1));
      below[i] = uint8_t(wrappedTexel(int(i) - 1, kMapSize));
    }
    for (size_t i = 0; i < left.size(); ++i) {
      left[i] = uint8_t(wrappedTexel(-1, int(i)));
      right[i] = uint8_t(wrappedTexel(kMapSize, int(i)));
    }
  }
};

}  // namespace

ODIS_WIDE Histogram blurred(const Histogram& map) {
  static const RimTexels rim;
  constexpr int kWidth = kMapSize + 2;
  // Row by row, with the rim; a row of a block lies side by side in the map.
  float square[kWidth][kWidth], along[kWidth][kMapSize];
  for (int x = 0; x < kWidth; ++x) {
    square[0][x] = map[rim.above[size_t(x)]];
    square[kWidth - 1][x] = map[rim.below[size_t(x)]];
  }
  for (int y = 0; y < kMapSize; ++y) {
    square[y + 1][0] = map[rim.left[size_t(y)]];
    square[y + 1][kWidth - 1] = map[rim.right[size_t(y)]];
    for (int x = 0; x < kMapSize; x += kBlockSize)
      std::memcpy(&square[y + 1][x + 1], &map[size_t(texelAt(x, y))], kBlockSize * sizeof(float));
  }
  // Along rows, then along columns.
  for (int y = 0; y < kWidth; ++y)
    for (int x = 0; x < kMapSize; ++x) along[y][x] = (square[y][x] + square[y][x + 2]) + 2 * square[y][x + 1];
  Histogram result;
  for (int y = 0; y < kMapSize; ++y) {
    float row[kMapSize];
    for (int x = 0; x < kMapSize; ++x) row[x] = ((along[y][x] + along[y + 2][x]) + 2 * along[y + 1][x]) / 16;
    for (int x = 0; x < kMapSize; x += kBlockSize)
      std::memcpy(&result[size_t(texelAt(x, y))], row + x, kBlockSize * sizeof(float));
  }
  return result;
}

}  // namespace odis::core
