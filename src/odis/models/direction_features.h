// What the network for directions is told of a cell: written once, used by training and at run time.
#pragma once

#include <array>

#include "odis/cells/statistics.h"

namespace odis::core {

// Maps that a cell's distribution is put together from: of each level its histogram; what lies around,
// twice, blurred once; the finest level's histogram blurred twice, the next one's blurred once; a cosine
// lobe with a little of everything.
inline constexpr int kAround = kCellLevels, kHistograms = kAround + 2, kOwnBlurred = kHistograms,
                     kParentBlurred = kOwnBlurred + 1, kLobe = kParentBlurred + 1, kBasisMaps = kLobe + 1;
// Numbers for each level.
inline constexpr int kCellScalars = 3 * kCellLevels;

struct CellFeatures {
  // Logarithms, within [0, 32]: see cell_features.cpp for each.
  std::array<float, kCellScalars> scalars;
  // Sums over texels of radiance times cosine: the levels' histograms and what lies around, where the chain
  // has them (so they last as long as it does); all zeros where nothing was seen.
  std::array<const Histogram*, kHistograms> seen;
  std::array<float, kHistograms> perSum;  // what makes distributions of them; 0 where nothing was seen
  Histogram lobe;                         // a distribution
  std::array<bool, kBasisMaps> there;     // whether something was seen
  // To the texels' centres, of the cell's mean normal, with its sign.
  Histogram cosines;
};

// Features of the first cell of a chain.
void computeFeatures(const CellChain& chain, CellFeatures& features);

// One of the kBasisMaps, a distribution or all zeros.
Histogram basisMap(const CellFeatures& features, int map);
// The sum of all, each times its share: what basisMap() gives, at the cost of two blurs.
Histogram blendMaps(const CellFeatures& features, const std::array<float, kBasisMaps>& shares);

}  // namespace odis::core
