// Which vertex and which cell are looked into.
#pragma once

#include "learn/data/starts.h"
#include "odis/cells/statistics.h"
#include "render/integrators/render.h"

namespace odis::learn {

struct InspectedPlace {
  PathVertex vertex;
  Start start;              // the same on its surface
  Float3 position, normal;  // that the cell is found by
};

// The first vertex that may be guided on the path of the pixel's first sample. Throws OptionError if there
// is none, or no such pixel.
InspectedPlace placeOfPixel(const render::Scene& scene, const render::LightSampler& lights,
                            const render::RenderOptions& options, render::Vec2i pixel);

// The finest cell at a point that the pilot saw something in, and of its vertices the nearest to the point,
// one that may be guided if there is any. Throws OptionError if there is none.
InspectedPlace placeAtPoint(const render::Scene& scene, std::span<const PathVertex> pilot,
                            const core::CellStore& store, std::span<const core::CellStatistics> cells,
                            const Float3& point, const std::optional<Float3>& normal);

// The number of the finest cell for a vertex there; kNoCell if no level has one.
uint32_t finestCell(const core::CellStore& store, const Float3& position, const Float3& normal);

// The usable vertices in a cell of this level, by their indices.
std::vector<size_t> membersOf(std::span<const PathVertex> pilot, const CellGrid& grid, uint64_t key,
                              int level);

}  // namespace odis::learn
