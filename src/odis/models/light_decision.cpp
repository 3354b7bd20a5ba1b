#include "odis/models/light_decision.h"

#include <algorithm>

#include "odis/mixture.h"

namespace odis::core {

namespace {

// No vertex counts more than this, as in the choice of BSDF sampling fractions.
constexpr double kMostSquare = 2500;
constexpr double kLeastSaved = 0.05;

// The square of what next-event estimation adds to a vertex's pixel, over the pixel's value.
double squareOf(const FractionSample& v, ArrayView<const float> pixelValues) {
  const double light = v.lightPdf > 0 ? v.light * powerHeuristic(v.lightPdf, v.lightBsdfPdf) : v.light;
  const double value = pixelValues.empty() ? light : light / pixelValues[v.pixel];
  return value * value <= kMostSquare ? value * value : kMostSquare;
}

}  // namespace

double lightMoment(const LightDecisionInputs& inputs, const LightChoice& choice, int level) {
  double pilot = 0, chosen = 0;
  for (const ArrayView<const FractionSample>& part : inputs.parts)
    for (const FractionSample& v : part) {
      if (!isForFractions(v.pixel, inputs.stride) || !(v.light > 0) || !(v.lightGroupProbability > 0) ||
          v.lightGroup >= inputs.groups)
        continue;
      const double square = squareOf(v, inputs.pixelValues);
      pilot += square;
      const CellStore& store = inputs.store;
      const uint32_t cell = store.index().find(store.grid().key(v.position, v.normal, level));
      if (cell == kNoCell) {
        chosen += square;
        continue;
      }
      const float* table = &choice.tables[size_t(cell) * (inputs.groups + 1) + v.lightGroup];
      const double fraction = choice.decisions[cell].learnedLightFraction;
      const double unlearned = v.lightGroupProbability;
      chosen += square * unlearned / ((1 - fraction) * unlearned + fraction * (table[1] - table[0]));
    }
  return pilot > 0 ? chosen / pilot : 0;
}

LightDecider decideLights(const LightDecisionInputs& inputs, const LightChoice& formula,
                          const LightChoice& model) {
  const double ofModel = lightMoment(inputs, model, 0);
  if (!(ofModel > 0)) return LightDecider::model;
  if (inputs.groups <= kFewGroups && lightMoment(inputs, formula, 1) > 1 - kLeastSaved)
    return LightDecider::nothing;
  return ofModel <= lightMoment(inputs, formula, 0) ? LightDecider::model : LightDecider::formula;
}

}  // namespace odis::core
