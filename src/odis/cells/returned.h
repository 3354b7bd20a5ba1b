// What vertices scatter back along their paths, added up for the radiance cache so that no single one decides
// a mean.
#pragma once

#include <array>
#include <span>

#include "odis/cell_grid.h"
#include "odis/sampling_map.h"

namespace odis::core {

// Sums over vertices of one half of the paths (pathHalf).
struct ReturnedSums {
  double count = 0;                  // number of vertices; one that max_depth cuts short counts less
  std::array<double, 3> outgoing{};  // red, green, blue
  double squares = 0;                // of its luminance
  // The parts of `outgoing` that are too large for the mean of a cell of the finest level: [0] goes into the
  // mean of the next coarser cell, and so on; the last into that of all cells.
  std::array<std::array<double, 3>, kCellLevels> passedOn{};
};
void addTo(ReturnedSums& sum, const ReturnedSums& more);
void scale(ReturnedSums& sums, double weight);

// What is left of `outgoing` for the finest cell.
std::array<double, 3> keptOf(const ReturnedSums& sums);

// The luminance of a sum of colours.
double brightnessOf(const std::array<double, 3>& color);

// Number, sum and sum of squares of what vertices scatter back, as luminance.
struct Spread {
  double count = 0, sum = 0, squares = 0;

  // 0 where less than two are known.
  double variance() const;
};
Spread spreadOf(const ReturnedSums& sums);
void addTo(Spread& sum, const Spread& more);

// The largest variance of a cell's and its ancestors' vertices, given that of the parent: a few vertices that
// missed the light know of no spread. In a cell of the coarsest level all vertices may have missed what those
// of other cells have found, so that its variance is at least a share of that of all cells.
double largestVariance(const Spread& cell, double ofParent);
double largestVarianceOfCoarsest(const Spread& cell, const Spread& all);

// How much of what a vertex scatters back may count in the means of a cell and its ancestors, as luminance.
using ReturnedLimits = std::array<double, kCellLevels>;
// Returns the limit with which one of `count` vertices moves their mean by a few standard errors at most.
double returnedLimit(double count, double variance);
// Notes which parts of a vertex's radiance are too large for the means of the cell and its ancestors.
void passOn(ReturnedSums& sums, const Float3& outgoing, const ReturnedLimits& limits);

}  // namespace odis::core
