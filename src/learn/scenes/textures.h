// Procedural textures that tile.
#pragma once

#include <string>

#include "learn/scenes/random.h"
#include "learn/scenes/solids.h"

namespace odis::learn {

enum class Pattern { planks, tiles, bricks, stripes, checks, noise, marble, spots, blocks };

struct Texture {
  std::string png;
  Vec2 tile;  // metres that it covers
};

// Between the two colours (linear), with some variation of its own.
Texture makeTexture(Pattern pattern, const Rgb& first, const Rgb& second, Random random);

// Smooth noise in [0, 1] that repeats every `period` cells in both directions; `octaves` of it, each half as
// strong and twice as fine (Perlin 1985, with values in the place of gradients).
class ValueNoise {
 public:
  explicit ValueNoise(uint64_t seed) : m_seed(seed) {}
  double at(double x, double y, int period, int octaves) const;

 private:
  double lattice(int x, int y) const;
  uint64_t m_seed;
};

}  // namespace odis::learn
