// The selection probabilities of all cells at once.
#pragma once

#include <span>
#include <vector>

#include "odis/cells/statistics.h"
#include "odis/decisions/direction_model.h"
#include "odis/decisions/selection.h"
#include "odis/guide.h"

namespace odis {

// What is predicted of the guided samples.
struct AlphaPrediction {
  SelectionTotals totals;
  float varianceRatio = 1;              // of a guided sample to an unguided one, over the whole image
  std::vector<PixelPrediction> pixels;  // one for each pixel value
};

// Fills the alphas of `result`, whose maps are there, from (a part of) the vertices that the maps were made
// from. Contributions are divided by `pixelValues`, if there are any.
AlphaPrediction chooseAlphas(std::vector<Cell>& result, const CellStore& store,
                             std::span<const CellStatistics> cells,
                             std::span<const DirectionDistribution> distributions, PilotParts parts,
                             std::span<const float> pixelValues);

}  // namespace odis
