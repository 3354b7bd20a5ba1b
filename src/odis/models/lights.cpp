#include "odis/models/lights.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "odis/cells/shrinkage.h"

namespace odis::core {

namespace {

// Weight of the coarser level beside a cell's own samples, in samples: of few groups, and of more for each of
// them, since a few samples say little of a group that is seldom drawn.
constexpr double kLightPriorSamples = 30, kPriorSamplesPerGroup = 2;
// The number of samples that makes the formula half as reliable.
constexpr double kHalfEnough = 20;
// Bounds of a ratio for the parts of a light: the second moment of the best choice among them over that of
// an even one. Below the first bound the best choice is taken; above the second the even one, which keeps
// samples stratified over the whole light, together with the pilot's.
constexpr double kMuchGained = 0.6, kLittleGained = 0.9;
// The greatest weight of a group, so that sums stay finite.
constexpr double kMostWeight = 1e30;

// Evens out the weights of a light's parts where choosing among them gains little; the light's own weight
// remains the best one for that choice.
void evenOut(std::span<double> weights) {
  double sum = 0, squares = 0;
  for (const double weight : weights) {
    sum += weight;
    squares += weight * weight;
  }
  if (!(sum > 0)) return;
  const double count = double(weights.size()), ratio = sum * sum / (count * squares);
  const double best = std::clamp((kLittleGained - ratio) / (kLittleGained - kMuchGained), 0.0, 1.0);
  double moment = 0;
  for (double& weight : weights) {
    const double probability = best * weight / sum + (1 - best) / count;
    if (weight > 0) moment += weight * weight / probability;
    weight = probability;
  }
  for (double& weight : weights) weight *= std::sqrt(moment);
}

}  // namespace

LightSquares LightFormula::predict(const CellChain& chain, const LightSquares* parent,
                                   uint32_t groups) const {
  const CellStatistics& cell = *chain[0];
  LightSquares result{};
  const double ofParent = groups <= kFewGroups ? kLightPriorSamples : kPriorSamplesPerGroup * groups;
  const double prior = parent ? ofParent : 0;
  if (!(cell.lightCount + prior > 0)) return result;
  for (size_t g = 0; g < groups; ++g)
    result[g] = shrunkMean(cell.lightSquares[g], cell.lightCount, parent ? (*parent)[g] : 0, prior);
  return result;
}

double LightFormula::reliability(const CellChain& chain, uint32_t groups) const {
  const CellStatistics& cell = *chain[0];
  // In media light changes little from place to place, so that ancestors tell enough, and what else chooses
  // lights knows nothing of transmittance.
  if (cell.inMedium) return 1;
  if (groups <= kFewGroups) return ownWeight(cell.lightCount, kHalfEnough);
  // Where there are many groups a cell's table comes mostly from its ancestors, and from the coarsest first.
  const CellStatistics* coarsest = chain[0];
  for (const CellStatistics* ancestor : chain)
    if (ancestor) coarsest = ancestor;
  return ownWeight(coarsest->lightCount, kPriorSamplesPerGroup * groups);
}

std::vector<float> tabulateLights(const Tasks& tasks, std::vector<CellDecisions>& result,
                                  std::span<const CellStatistics> cells, const LightModel& model,
                                  uint32_t groups, std::span<const LightParts> parts) {
  const LightFormula formula;
  std::vector<LightSquares> squares(cells.size());
  std::vector<float> table(cells.size() * (groups + 1));
  forEachFromCoarse(tasks, cells, [&](size_t c) {
    const uint32_t parent = cells[c].parent;
    const LightModel& decides =
        groups > model.mostGroups() ? formula : modelFor<LightModel>(cells[c], model, formula);
    const CellChain chain = chainOf(cells, c);
    squares[c] = decides.predict(chain, parent == kNoCell ? nullptr : &squares[parent], groups);
    std::array<double, kMaxLightGroups> weights{};
    for (uint32_t g = 0; g < groups; ++g) {
      const double weight = std::sqrt(squares[c][g]);
      weights[g] = weight > 0 ? std::min(weight, kMostWeight) : 0;
    }
    for (const LightParts& light : parts)
      if (light.first <= groups && light.count <= groups - light.first)
        evenOut(std::span(weights).subspan(light.first, light.count));
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    const double reliability = decides.reliability(chain, groups);
    result[c].learnedLightFraction = total > 0 ? float(kLearnedFraction * reliability) : 0;
    float* cdf = &table[c * (groups + 1)];
    double sum = 0;
    for (uint32_t g = 0; g < groups && total > 0; ++g) {
      sum += weights[g];
      cdf[g + 1] = float(sum / total);
    }
  });
  return table;
}

}  // namespace odis::core
