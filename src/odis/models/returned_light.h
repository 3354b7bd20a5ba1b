// Russian roulette: whether what comes back from a cell is worth going on for.
#pragma once

#include <span>
#include <vector>

#include "odis/cells/statistics.h"
#include "odis/models/second_moments.h"

namespace odis::core {

// What a vertex of a cell scatters back along its path, next-event estimation and all beyond included, and
// what that costs.
struct ReturnedLight {
  std::array<double, 3> mean{};  // radiance: red, green, blue
  double square = 0;             // mean of the squared luminance
  double rays = 1;               // mean number of rays traced for it, shadow rays included
};

// The cell's means, shrunk towards its parent's (null for the coarsest level) by how many samples the cell
// has.
ReturnedLight returnedLight(const CellStatistics& cell, const ReturnedLight* parent);

// Fills in the cells' survival factors and what stands in for paths that end
// (CellDecisions::outgoingRadiance; zero without `controlVariate`). With S what comes back from a vertex, m
// what stands in for it, c its rays, and V and C the variance and the rays of a sample of the image, the
// survival that makes (V + what roulette adds) times (C - what it saves) least is throughput / pixel *
// sqrt(E[(S - m)^2] / c) * sqrt(C / V) (Bolin and Meyer 1997; Rath et al. 2022, EARS, without splitting).
// The survival factor is what the throughput over the pixel's value is multiplied by.
void fillRoulette(const Tasks& tasks, std::vector<CellDecisions>& result,
                  std::span<const CellStatistics> cells, const ImageMoments& image, bool controlVariate);

}  // namespace odis::core
