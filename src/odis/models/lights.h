// Which group of lights next-event estimation should choose in a cell.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "odis/cells/statistics.h"

namespace odis::core {

using LightParts = OdisLightParts;

// The number of light groups up to which each cell learns about them from the samples that its map needs.
inline constexpr uint32_t kFewGroups = 32;
// The learned-light fraction where a cell has seen enough.
inline constexpr double kLearnedFraction = 0.9;

// For each group of lights the mean, over the cell's vertices, of the squared next-event estimate from that
// group alone, visibility included.
using LightSquares = std::array<double, kMaxLightGroups>;

// From a cell's statistics to what its groups of lights give: the interface behind which formula and
// network stand side by side.
class LightModel {
 public:
  virtual ~LightModel() = default;
  // Given the statistics of the cell and its ancestors, and its parent's result (null for the coarsest
  // level). Called for parents before their children; thread-safe. `groups` is at most kMaxLightGroups.
  virtual LightSquares predict(const CellChain& chain, const LightSquares* parent, uint32_t groups) const = 0;
  // Whether the model decides in cells of media, too, and among how many groups; elsewhere the formula does.
  virtual bool knowsMedia() const { return true; }
  virtual uint32_t mostGroups() const { return kMaxLightGroups; }
  // How reliable the result is of the first cell of a chain, from 0 to 1: the learned-light fraction is in
  // proportion to it.
  virtual double reliability(const CellChain& chain, uint32_t groups) const = 0;
};

// The cell's means, shrunk towards its parent's by how many samples the cell has.
class LightFormula : public LightModel {
 public:
  LightSquares predict(const CellChain& chain, const LightSquares* parent, uint32_t groups) const override;
  double reliability(const CellChain& chain, uint32_t groups) const override;
};

// The model that decides in a cell: the formula where the model knows nothing of media and the cell is one.
template <class Model>
const Model& modelFor(const CellStatistics& cell, const Model& model, const Model& formula) {
  return cell.inMedium && !model.knowsMedia() ? formula : model;
}

// Makes the light tables of all cells (GuideView::lightTables) and fills in their learned-light fractions.
// The best probability of a group is in proportion to the root of its squared contribution. Groups that are
// parts of one light follow it only where that gains much over drawing each part as often as the others.
std::vector<float> tabulateLights(const Tasks& tasks, std::vector<CellDecisions>& result,
                                  std::span<const CellStatistics> cells, const LightModel& model,
                                  uint32_t groups, std::span<const LightParts> parts = {});

}  // namespace odis::core
