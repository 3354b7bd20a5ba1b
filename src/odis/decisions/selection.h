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
inline constexpr std::array<float, 8> kAlphas = {1.0f, 0.9f, 0.75f, 0.6f, 0.5f, 0.35f, 0.25f, 0.15f};

// Sums over a cell's vertices of one class, for each candidate: the second moment of next-event estimate plus
// direction, relative to the pixel, and the rays of what follows.
struct SelectionSums {
  double count = 0;
  std::array<double, kAlphas.size()> secondMoment{};
  std::array<double, kAlphas.size()> rays{};

  void add(const SelectionSums& other, double scale = 1);
};
using CellSelection = std::array<SelectionSums, kMaterialClasses>;

// Adds one vertex, whose density under its cell's map (with the vertex's own sample taken out) is `mapPdf`
// for its direction and `lightMapPdf` for the direction of its next-event estimate.
void addVertex(CellSelection& sums, const PilotVertex& vertex, float mapPdf, float lightMapPdf);

// What the sums are weighed against: those of the whole image.
struct SelectionTotals {
  double variance = 0;
  double rays = 0;
};

// The candidate with the least predicted variance + cost, for a cell whose own sums are backed by a prior's.
float chooseAlpha(const SelectionSums& own, const SelectionSums& prior, const SelectionTotals& totals);

}  // namespace odis
