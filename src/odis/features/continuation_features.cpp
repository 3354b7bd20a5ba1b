#include "odis/features/continuation_features.h"

#include <algorithm>
#include <cmath>

namespace odis {

namespace {

// Ratios lie between 2 to the minus and to the plus this; nothing at all is as little as there can be.
constexpr float kMostOctaves = 8;

float octaves(double ratio, float most) {
  return ratio > 0 ? std::clamp(float(std::log2(ratio)), -most, most) : -most;
}

// The formula's answer to a chain, from the coarsest level on.
Continuation formulaFor(const CellChain& chain) {
  Continuation result;
  bool parent = false;
  for (int level = kCellLevels - 1; level >= 0; --level) {
    if (!chain[level]) continue;
    result = ShrunkMoments().predict({chain[level]}, parent ? &result : nullptr);
    parent = true;
  }
  return result;
}

}  // namespace

void computeFeatures(const CellChain& chain, ContinuationFeatures& features) {
  static constexpr CellStatistics kNothing{};
  features.formula = formulaFor(chain);
  const double square = features.formula.square;
  const double unit = square > 0 ? 1 / std::sqrt(square) : 0;

  float* next = features.scalars.data();
  for (int l = 0; l < kCellLevels; ++l) {
    const CellStatistics& cell = chain[l] ? *chain[l] : kNothing;
    const bool there = cell.count > 0;
    const double each = there ? 1 / cell.count : 0;
    const auto& sums = cell.outgoing;
    const double back =
        luminance(Float3{float(sums[0] * each), float(sums[1] * each), float(sums[2] * each)});
    // How many samples there are, how many of them matter for what arrives and for what is scattered back.
    *next++ = float(std::log2(1 + cell.count));
    *next++ = float(std::log2(1 + effectiveSamples(cell.sum, cell.sumSquares)));
    *next++ = float(std::log2(1 + effectiveSamples(back, cell.outgoingSquares * each) * cell.count));
    // What is scattered back, its mean square and its mean, for how many rays, and what arrives.
    *next++ = octaves(cell.outgoingSquares * each * unit * unit, 1.5f * kMostOctaves);
    *next++ = octaves(back * unit, kMostOctaves);
    *next++ = there ? float(std::log2(std::max(cell.rays * each, 0.5))) : 0;
    *next++ = octaves(cell.sum * each * unit, kMostOctaves);
    // How flat the surface is.
    *next++ = std::sqrt(dot(cell.normal, cell.normal)) * float(each);
  }
  // How near is what the cell sees, and the cell around it; how large they are.
  for (int l = 0; l < 2; ++l)
    *next++ = chain[l] && chain[l]->count > 0 ? float(chain[l]->nearness / chain[l]->count) : 0;
  *next++ = chain[0] ? float(chain[0]->level) : 0;
}

}  // namespace odis
