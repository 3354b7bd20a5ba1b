// The selection probability alpha of each cell and material class, by predicted variance and cost.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "odis/cells/statistics.h"
#include "odis/decisions/direction_model.h"
#include "odis/guide.h"

namespace odis {

// The candidates; 1 means not to guide.
inline constexpr std::array<float, 6> kAlphas = {1.0f, 0.8f, 0.6f, 0.4f, 0.25f, 0.15f};

// Sums over a cell's vertices of one class, for each candidate: the second moment of next-event estimate plus
// direction, relative to the pixel, and the rays of what follows.
struct SelectionSums {
  double count = 0;
  std::array<double, kAlphas.size()> secondMoment{};
  std::array<double, kAlphas.size()> rays{};

  void add(const SelectionSums& other, double scale = 1);
};
using CellSelection = std::array<SelectionSums, kMaterialClasses>;

// The second moments of one vertex, one for each candidate.
using SecondMoments = std::array<float, kAlphas.size()>;

// Adds one vertex, whose density under its cell's map (with the vertex's own sample taken out) is `mapPdf`
// for its direction and `lightMapPdf` for the direction of its next-event estimate. What it adds to its pixel
// is multiplied by `scale`. Returns what it added to the second moments.
SecondMoments addVertex(CellSelection& sums, const PilotVertex& vertex, float mapPdf, float lightMapPdf,
                        float scale = 1);

// What the sums are weighed against: those of the whole image, over its first vertices.
struct SelectionTotals {
  double variance = 0;  // relative to the pixels' values
  double rays = 0;      // because of the first vertices' directions
  double count = 0;
};

// A cell's sums with those of a coarser one behind them, scaled to a fixed number of samples.
SelectionSums back(const SelectionSums& own, const SelectionSums& prior);

// The index of the candidate with the least predicted variance + cost.
size_t chooseAlpha(const SelectionSums& sums, const SelectionTotals& totals);

}  // namespace odis
