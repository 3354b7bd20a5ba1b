// Whether lights are chosen by what cells have learned, and by which model.
#pragma once

#include "odis/models/fraction_samples.h"
#include "odis/models/lights.h"

namespace odis::core {

enum class LightDecider : uint8_t { nothing, formula, model };

// A choice of lights for all cells: tables (GuideView::lightTables) and learned-light fractions.
struct LightChoice {
  std::vector<float> tables;
  std::vector<CellDecisions> decisions;
};

// What the decision is made from: the vertices of the pilot that BSDF sampling fractions are chosen by.
struct LightDecisionInputs {
  const CellStore& store;
  FractionParts parts;
  uint32_t stride;
  ArrayView<const float> pixelValues;
  uint32_t groups;
};

// The second moment of next-event estimation over the pixels' values if lights were chosen so, as a ratio to
// the pilot's, which chose them without having learned. Each vertex follows the table of its cell `level`
// levels above the finest. 0 where no vertex tells.
double lightMoment(const LightDecisionInputs& inputs, const LightChoice& choice, int level);

// Decides for the whole image. The model is believed where its tables leave less than the formula's for the
// vertices that both were made from; in a cell whose lights differ from place to place it is too sure.
// Nothing is learned where the formula's tables of the next coarser cells, to which a vertex's own sample
// adds little, save less than 5 %: that would not pay for look-ups and lost stratification over the lights.
// Many groups of lights are learned in any case, since a pilot tells little of them. Where no vertex tells
// the model decides.
LightDecider decideLights(const LightDecisionInputs& inputs, const LightChoice& formula,
                          const LightChoice& model);

}  // namespace odis::core
