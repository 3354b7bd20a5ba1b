// The BSDF sampling fractions of all cells at once.
#pragma once

#include <span>
#include <vector>

#include "odis/cells/statistics.h"
#include "odis/models/direction_model.h"
#include "odis/models/second_moments.h"

namespace odis::core {

// What the pilot predicts of guided samples.
struct GuidingPrediction {
  ImageMoments image;
  float varianceRatio = 1;  // of a guided sample to an unguided one, over the whole image
};

// What the choice is made from: of the samples in `parts`, which are (some) of the vertices that the maps
// were made from, those that `stride` leaves (fractionStride). Their contributions are divided by
// `pixelValues`; without any, by those of an even image.
struct FractionInputs {
  const CellStore& store;
  std::span<const CellStatistics> cells;
  std::span<const DirectionDistribution> distributions;
  const uint16_t* maps;  // of the cells
  GuideRules rules;
  FractionParts parts;
  uint32_t stride;
  ArrayView<const float> pixelValues;
};

// Fills in the BSDF sampling fractions of `result`. Where no vertex knows its contributions they are
// kFallbackBsdfFraction.
GuidingPrediction chooseFractions(std::vector<CellDecisions>& result, const FractionInputs& inputs);

}  // namespace odis::core
