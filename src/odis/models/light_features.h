// What a network knows about a pair of a cell and a group of lights.
#pragma once

#include <array>

#include "odis/models/lights.h"

namespace odis::core {

// Of each level the group's share of what next-event estimation gave there, and how many samples saw that;
// the share by formula; the number of groups.
inline constexpr int kPairFeatures = 2 * kCellLevels + 2;

using GroupShares = std::array<float, kMaxLightGroups>;

struct LightFeatures {
  std::array<GroupShares, kPairFeatures> pairs;  // [feature][group]; groups that are not: zero
  GroupShares formula;                           // shares, with the sum 1
};

// Features of the first cell of a chain, where there are so many groups.
void computeFeatures(const CellChain& chain, uint32_t groups, LightFeatures& features);

}  // namespace odis::core
