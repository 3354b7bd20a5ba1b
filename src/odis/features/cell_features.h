// What the networks know about a cell: written once, used by training and at run time.
#pragma once

#include <array>

#include "odis/cells/statistics.h"

namespace odis {

// Counts up whenever a feature changes its meaning: weights made for other features are refused.
inline constexpr uint32_t kFeatureVersion = 1;

// Maps that a cell's distribution is put together from: of each level its histogram, of the finest also blurred twice, of the
// next blurred once, and a cosine lobe with a little of everything.
inline constexpr int kBasisMaps = kCellLevels + 3;
// Numbers for each level, of one level beside the next coarser, and of the cell.
inline constexpr int kCellScalars = 4 * kCellLevels + 2 * (kCellLevels - 1) + 3;

struct CellFeatures {
  // Logarithms and shares, mostly within [-8, 16]: see cell_features.cpp for each.
  std::array<float, kCellScalars> scalars;
  // Distributions over texels of radiance times cosine: the levels' histograms with the sum 1, or all zeros where nothing
  // was seen; the lobe.
  std::array<Histogram, kCellLevels> levels;
  Histogram lobe;
  std::array<bool, kBasisMaps> there;  // whether something was seen
  // To the texels' centres, of the cell's mean normal, with its sign.
  Histogram cosines;
};

// Features of the first cell of a chain.
void computeFeatures(const CellChain& chain, CellFeatures& features);

// One of the kBasisMaps.
Histogram basisMap(const CellFeatures& features, int map);
// The sum of all, each times its share: what basisMap() gives, at the cost of two blurs.
Histogram blendMaps(const CellFeatures& features, const std::array<float, kBasisMaps>& shares);

// Binomial blur over 3 x 3 texels, across the seams of the octahedral map; keeps the sum.
Histogram blurred(const Histogram& map);

}  // namespace odis
