// What the networks know about a cell: written once, used by training and at run time.
#pragma once

#include <array>

#include "odis/cells/statistics.h"

namespace odis {

// Counts up whenever a feature changes its meaning: weights made for other features are refused.
inline constexpr uint32_t kFeatureVersion = 2;

// Maps that a cell's distribution is put together from: of each level its histogram; that of the finest blurred twice, of the
// next blurred once; a cosine lobe with a little of everything; and what lies around, twice, blurred once.
inline constexpr int kOwnBlurred = kCellLevels, kParentBlurred = kCellLevels + 1, kLobe = kCellLevels + 2,
                     kAround = kCellLevels + 3;
inline constexpr int kBasisMaps = kAround + 2;
// Numbers for each level.
inline constexpr int kCellScalars = 3 * kCellLevels;

struct CellFeatures {
  // Logarithms, within [0, 32]: see cell_features.cpp for each.
  std::array<float, kCellScalars> scalars;
  // Distributions over texels of radiance times cosine: the levels' histograms with the sum 1, or all zeros where nothing
  // was seen; the lobe.
  std::array<Histogram, kCellLevels> levels;
  Surroundings around;              // likewise
  std::array<float, 2> aroundSums;  // of them before
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
