// What a network knows about how much comes back from a cell.
#pragma once

#include <array>

#include "odis/cells/statistics.h"
#include "odis/decisions/roulette.h"

namespace odis {

// Numbers for each level, and of the cell.
inline constexpr int kContinuationScalars = 8 * kCellLevels + 3;

struct ContinuationFeatures {
  // Logarithms and shares, within [-12, 32]: see continuation_features.cpp for each.
  std::array<float, kContinuationScalars> scalars;
  // By formula; whatever has a unit stands beside the root of its mean square.
  Continuation formula;
};

// Features of the first cell of a chain.
void computeFeatures(const CellChain& chain, ContinuationFeatures& features);

}  // namespace odis
