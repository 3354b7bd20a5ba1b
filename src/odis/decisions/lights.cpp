#include "odis/decisions/lights.h"

#include <algorithm>
#include <cmath>

namespace odis {

namespace {

// How many samples' worth of the coarser level stands behind a cell's own.
constexpr double kPriorSamples = 30;
// The share of the choices that follows what was learned where a cell has seen enough, and how many samples are half
// enough.
constexpr double kShare = 0.9, kHalfEnough = 20;
// No weight is more than this, so that sums can be kept.
constexpr double kMostWeight = 1e30;

}  // namespace

LightSquares ShrunkLightSquares::predict(const CellStatistics& cell, const LightSquares* parent) const {
  LightSquares result{};
  const double prior = parent ? kPriorSamples : 0, count = cell.count + prior;
  if (!(count > 0)) return result;
  for (size_t g = 0; g < result.size(); ++g)
    result[g] = (cell.lightSquares[g] + (parent ? prior * (*parent)[g] : 0)) / count;
  return result;
}

std::vector<float> tabulateLights(std::vector<Cell>& result, std::span<const CellStatistics> cells,
                                  const LightModel& model, uint32_t groups) {
  std::vector<LightSquares> squares(cells.size());
  std::vector<float> table(cells.size() * (groups + 1));
  forEachFromCoarse(cells, [&](size_t c) {
    const uint32_t parent = cells[c].parent;
    squares[c] = model.predict(cells[c], parent == kNoCell ? nullptr : &squares[parent]);
    double total = 0;
    std::array<double, kMostLightGroups> weights;
    for (uint32_t g = 0; g < groups; ++g) {
      const double weight = std::sqrt(squares[c][g]);
      total += weights[g] = weight > 0 ? std::min(weight, kMostWeight) : 0;
    }
    result[c].lightShare = total > 0 ? float(kShare * cells[c].count / (cells[c].count + kHalfEnough)) : 0;
    float* cdf = &table[c * (groups + 1)];
    double sum = 0;
    for (uint32_t g = 0; g < groups && total > 0; ++g) {
      sum += weights[g];
      cdf[g + 1] = float(sum / total);
    }
  });
  return table;
}

}  // namespace odis
