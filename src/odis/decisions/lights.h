// Which group of lights next-event estimation should choose in a cell.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "odis/cells/statistics.h"
#include "odis/guide.h"

namespace odis {

// For each group, the mean over the cell's vertices of the squared contribution, visibility included, that a light of
// the group makes when the group is chosen.
using LightSquares = std::array<double, kMostLightGroups>;

// From a cell's statistics to what its lights give: the interface behind which formula and network stand side by side.
class LightModel {
 public:
  virtual ~LightModel() = default;
  // Given the statistics of the cell and its ancestors, and its parent's result (null for the coarsest level). Called for
  // parents before their children; thread-safe.
  // There are so many groups, at most kMostLightGroups.
  virtual LightSquares predict(const CellChain& chain, const LightSquares* parent, uint32_t groups) const = 0;
  // How much of the share of learned choices a cell gets, from 0 to 1.
  virtual double trust(const CellStatistics& cell) const = 0;
};

// The cell's means, shrunk towards its parent's by how many samples the cell has.
class ShrunkLightSquares : public LightModel {
 public:
  LightSquares predict(const CellChain& chain, const LightSquares* parent, uint32_t groups) const override;
  double trust(const CellStatistics& cell) const override;
};

// Tables of `groups` + 1 entries for each cell, one after the other, and the cells' shares (Cell::lightShare). The best
// probability of a group is in proportion to the root of its squared contribution. Of a light in parts these follow it
// only where that gains much over drawing each as often as the others.
std::vector<float> tabulateLights(std::vector<Cell>& result, std::span<const CellStatistics> cells,
                                  const LightModel& model, uint32_t groups,
                                  std::span<const LightParts> parts = {});

}  // namespace odis
