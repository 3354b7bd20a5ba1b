// The selection probabilities of all cells at once.
#pragma once

#include <span>
#include <vector>

#include "odis/cells/statistics.h"
#include "odis/decisions/direction_model.h"
#include "odis/guide.h"

namespace odis {

// Fills the alphas of `result`, whose maps are there, from (a part of) the vertices that the maps were made
// from. Contributions are divided by `pixelValues`, if there are any. Returns the variance that is predicted
// of a guided sample, as a ratio to an unguided one.
float chooseAlphas(std::vector<Cell>& result, const CellStore& store, std::span<const CellStatistics> cells,
                   std::span<const DirectionDistribution> distributions, PilotParts parts,
                   std::span<const float> pixelValues);

}  // namespace odis
