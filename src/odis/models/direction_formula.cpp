#include "odis/models/direction_formula.h"

#include "odis/cells/shrinkage.h"
#include "odis/maps/texel_directions.h"

namespace odis::core {

DirectionFormula::DirectionFormula(const std::array<float, kCellLevels>& priorSamples)
    : m_priorSamples(priorSamples) {}

DirectionDistribution DirectionFormula::predict(const CellChain& chain,
                                                const DirectionDistribution* parent) const {
  const CellStatistics& cell = *chain[0];
  DirectionDistribution result;
  const Histogram cosines = cosinesOf(cell);

  // What is believed before the cell has seen anything: its parent's map, or a cosine lobe on top of a little
  // of everything (surfaces that transmit light receive it from both sides); in media all is even.
  Histogram prior;
  float priorSum = 0;
  for (int t = 0; t < kMapTexels; ++t) {
    prior[t] = parent ? parent->probability[t] : std::max(cosines[t], 0.05f);
    priorSum += prior[t];
  }

  const float own =
      float(ownWeight(effectiveSamples(cell.sum, cell.sumSquares), m_priorSamples[size_t(cell.level)]));
  const float perSample = cell.sum > 0 ? own / float(cell.sum) : 0;
  for (int t = 0; t < kMapTexels; ++t) {
    result.probability[t] =
        (cell.sum > 0 ? 1 - own : 1) * prior[t] / priorSum + perSample * cell.histogram[t];
    result.inverseCosine[t] = inverseCosine(cosines[t]);
  }
  // A sample is part of its cell's histogram and of its ancestors'.
  result.sensitivity = perSample + (cell.sum > 0 ? 1 - own : 1) * (parent ? parent->sensitivity : 0);
  return result;
}

}  // namespace odis::core
