// Russian roulette: what a path that goes on from a cell is worth.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "odis/cells/statistics.h"
#include "odis/decisions/selection.h"
#include "odis/guide.h"

namespace odis {

// What a vertex of a cell scatters back along its path, next-event estimate and all beyond, and what it takes to know.
struct Continuation {
  std::array<double, 3> mean{};  // radiance: red, green, blue
  double square = 0;             // mean of the squared luminance
  double rays = 1;               // traced for it on average, shadow rays included
  double correction = 1;         // by how much square / rays is off, as far as known: of the worth alone
};

// From a cell's statistics to its continuation: the interface behind which formula and network stand side by side.
class ContinuationModel {
 public:
  virtual ~ContinuationModel() = default;
  // Given the statistics of the cell and its ancestors, and its parent's continuation (null for the coarsest level). Called for
  // parents before their children; thread-safe.
  virtual Continuation predict(const CellChain& chain, const Continuation* parent) const = 0;
  // Guided, stratified samples vary less than the pilot's single ones, so that roulette's own noise weighs more beside
  // theirs: what survival is multiplied by.
  virtual double caution() const { return 3; }
};

// The cell's means, shrunk towards its parent's by how many samples the cell has.
class ShrunkMoments : public ContinuationModel {
 public:
  Continuation predict(const CellChain& chain, const Continuation* parent) const override;
};

// Fills in what going on is worth in each cell (Cell::worth) and what stands in for paths that don't (Cell::expected;
// zero without `controlVariate`). With S what comes back from a vertex, m what stands in for it, c its rays, and V and C
// the variance and the rays of a sample of the image, the survival that makes (V + what roulette adds) times (C - what
// it saves) least is throughput / pixel * sqrt(E[(S - m)^2] / c) * sqrt(C / V) (Bolin and Meyer 1997; Rath et al. 2022,
// EARS, without splitting). The worth is what the throughput over the pixel's value is multiplied by.
void weighContinuations(std::vector<Cell>& result, std::span<const CellStatistics> cells,
                        const ContinuationModel& model, const SelectionTotals& totals, bool controlVariate);

}  // namespace odis
