// The radiance cache: what a path may end with in a cell, in place of what it would find.
#pragma once

#include <span>
#include <vector>

#include "odis/cells/statistics.h"

namespace odis::core {

// The cached radiance of each cell and half of the paths, [cell][half]; the cells are those of a store that
// caches.
//
// A half's mean is shrunk towards its parent cell's, and its standard error is that of as many samples with
// the largest spread that the *other* half has found in the cell and its ancestors. So whether a mean is used
// is independent of whether it happened to be too dark or too bright: on average, over the cells that are
// trusted, it is right. (A mean that is judged by its own samples is trusted most where they happened to
// miss the light.) Ancestors take part because a few samples that missed the light know of no spread at all.
//
// By that spread each sample is limited, too (cells/returned.h): what it holds beyond goes into the means of
// coarser cells, so that a lucky path in a mean that the other half trusts does not sparkle. What is spread
// over all cells in the end makes every mean uncertain.
std::vector<CachedRadiance> cacheRadiance(const Tasks& tasks, std::span<const CellStatistics> cells);

}  // namespace odis::core
