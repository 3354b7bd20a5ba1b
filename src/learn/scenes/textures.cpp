#include "learn/scenes/textures.h"

#include <algorithm>
#include <functional>
#include <vector>

#include "render/image/tonemap.h"
#include "render/image/write.h"

namespace odis::learn {

double ValueNoise::lattice(int x, int y) const {
  return Random(m_seed ^ (uint64_t(uint32_t(x)) << 32 | uint32_t(y))).unit();
}

double ValueNoise::at(double x, double y, int period, int octaves) const {
  double sum = 0, weights = 0, weight = 1;
  for (int octave = 0; octave < octaves; ++octave, x *= 2, y *= 2, period *= 2, weight /= 2) {
    const int ix = int(std::floor(x)), iy = int(std::floor(y));
    const auto ease = [](double t) { return t * t * (3 - 2 * t); };
    const auto wrap = [&](int i) { return (i % period + period) % period + 1000 * octave; };
    const double fx = ease(x - ix), fy = ease(y - iy);
    const double low = lattice(wrap(ix), wrap(iy)) * (1 - fx) + lattice(wrap(ix + 1), wrap(iy)) * fx;
    const double high = lattice(wrap(ix), wrap(iy + 1)) * (1 - fx) + lattice(wrap(ix + 1), wrap(iy + 1)) * fx;
    sum += weight * (low * (1 - fy) + high * fy);
    weights += weight;
  }
  return sum / weights;
}

namespace {

constexpr int kSize = 160;  // pixels, either side

// How far a place of the unit square is from the first colour to the second.
using Blend = std::function<double(double u, double v)>;

// Rows of boards or stones, each shifted against the one before, with a joint of `joint` (of a row's height)
// between them; every piece has a tone of its own between `least` and 1.
Blend courses(int rows, int perRow, double shift, double joint, double least, uint64_t seed) {
  return [=](double u, double v) {
    const int row = int(v * rows);
    const double inRow = v * rows - row, along = u * perRow + shift * row;
    const int piece = int(std::floor(along));
    const double inPiece = along - std::floor(along), aspect = double(rows) / perRow;
    if (inRow < joint || inPiece * aspect < joint) return 0.0;
    const double tone = Random(seed ^ uint64_t(row * 64 + piece % perRow)).unit();
    return least + (1 - least) * tone;
  };
}

Blend blendOf(Pattern pattern, Random& random) {
  const uint64_t seed = random.bits();
  const ValueNoise noise(seed);
  const int count = random.integer(3, 9);
  switch (pattern) {
    case Pattern::planks: {
      const Blend boards = courses(random.integer(4, 8), 1, 0.37, 0.03, 0.45, seed);
      return [=](double u, double v) {  // the grain runs along the boards
        const double tone = boards(u, v);
        return tone > 0 ? tone * (0.75 + 0.25 * noise.at(u * 4, v * 64, 4, 2)) : 0.0;
      };
    }
    case Pattern::tiles: {
      const int tiles = random.integer(2, 5);
      return courses(tiles, tiles, 0, random.range(0.02, 0.06), random.range(0.6, 0.98), seed);
    }
    case Pattern::bricks:
      return courses(2 * random.integer(3, 6), 3, 0.5, random.range(0.08, 0.16), 0.5, seed);
    case Pattern::stripes:
      return [=](double u, double) { return (u * count - std::floor(u * count)) < 0.5 ? 1.0 : 0.0; };
    case Pattern::checks:
      return [](double u, double v) { return (u < 0.5) == (v < 0.5) ? 1.0 : 0.0; };
    case Pattern::noise:
      return [=](double u, double v) { return noise.at(u * count, v * count, count, 4); };
    case Pattern::marble:
      return [=](double u, double v) {
        const double bent = u * 2 + 1.5 * noise.at(u * 4, v * 4, 4, 4);
        return std::pow(std::abs(std::sin(render::kPi * bent)), 0.3);
      };
    case Pattern::spots:
      return [=](double u, double v) {  // a disc of its own size in every cell
        const double x = u * count, y = v * count;
        Random cell(seed ^ uint64_t(int(y) * 64 + int(x)));
        const double radius = cell.range(0.15, 0.4);
        return std::hypot(x - std::floor(x) - 0.5, y - std::floor(y) - 0.5) < radius ? 1.0 : 0.0;
      };
    case Pattern::blocks:
      break;
  }
  // Rectangles at random, one on the other: a picture.
  struct Block {
    double u, v, halfWidth, halfHeight, tone;
  };
  std::vector<Block> blocks(size_t(random.integer(6, 25)));
  for (Block& b : blocks)
    b = {random.unit(), random.unit(), random.range(0.03, 0.3), random.range(0.03, 0.3), random.unit()};
  return [=](double u, double v) {
    double tone = 0.3;
    for (const Block& b : blocks)
      if (std::abs(u - b.u) < b.halfWidth && std::abs(v - b.v) < b.halfHeight) tone = b.tone;
    return tone;
  };
}

Vec2 tileOf(Pattern pattern, Random& random) {
  const auto square = [&](double least, double most) { return Vec2(float(random.logRange(least, most))); };
  switch (pattern) {
    case Pattern::planks:
      return {float(random.range(1.2, 2.4)), float(random.range(0.5, 1.2))};
    case Pattern::bricks:
      return square(0.7, 1.6);
    case Pattern::noise:
      return square(0.3, 3);
    case Pattern::marble:
      return square(1, 4);
    default:
      return square(0.3, 2);
  }
}

}  // namespace

Texture makeTexture(Pattern pattern, const Rgb& first, const Rgb& second, Random random) {
  Texture result;
  result.tile = tileOf(pattern, random);
  const Blend blend = blendOf(pattern, random);
  std::vector<uint8_t> pixels;
  pixels.reserve(3 * kSize * kSize);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const double t = blend((x + 0.5) / kSize, (y + 0.5) / kSize);
      // Thirty steps look as smooth and make small files.
      const Rgb color = render::lerp(float(std::round(t * 30) / 30), first, second);
      for (int c = 0; c < 3; ++c) pixels.push_back(render::toByte(color[c]));
    }
  result.png = render::encodePng(kSize, kSize, 3, pixels.data());
  return result;
}

}  // namespace odis::learn
