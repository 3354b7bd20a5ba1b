#include "odis/decisions/direction_model.h"
#include "odis/decisions/texel_directions.h"

namespace odis {

DirectionDistribution HistogramModel::predict(const CellChain& chain,
                                              const DirectionDistribution* parent) const {
  const CellStatistics& cell = *chain[0];
  DirectionDistribution result;
  const Histogram cosines = cosinesTo(meanNormal(cell));

  // What is believed before the cell has seen anything: its parent's map, or a cosine lobe on top of a little
  // of everything (surfaces that transmit light receive it from both sides).
  Histogram prior;
  float priorSum = 0;
  for (int t = 0; t < kMapTexels; ++t) {
    prior[t] = parent ? parent->probability[t] : std::max(cosines[t], 0.05f);
    priorSum += prior[t];
  }

  // Trust is counted in effective samples: many samples of which one holds all the light are but one.
  const double effective = effectiveSamples(cell.sum, cell.sumSquares);
  const float trust = m_options.trust[cell.level];
  const float own = float(effective / (effective + trust));
  const float perSample = cell.sum > 0 ? own / float(cell.sum) : 0;
  for (int t = 0; t < kMapTexels; ++t) {
    result.probability[t] =
        (cell.sum > 0 ? 1 - own : 1) * prior[t] / priorSum + perSample * cell.histogram[t];
    result.perCosine[t] = perCosine(cosines[t]);
  }
  // A sample stands in its cell's histogram and in its ancestors'.
  result.sensitivity = perSample + (cell.sum > 0 ? 1 - own : 1) * (parent ? parent->sensitivity : 0);
  return result;
}

}  // namespace odis
