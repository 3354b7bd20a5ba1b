// The pilots of a view: what every image begins with, several times over with other numbers.
#pragma once

#include <span>

#include "learn/data/vertex_columns.h"
#include "render/path/features.h"
#include "render/path/path.h"

namespace odis::learn {

// Paths end at this depth, in pilots and in targets: nothing of a data set may grow without bound.
inline constexpr int kDeepestPath = 32;

// Traces one path for every pixel of the scene's film.
Pilot tracePilot(const render::Scene& scene, const render::LightSampler& lights, uint64_t seed);
// The same for some of the pixels: of each path the vertices up to the first usable one are kept. Adds to
// features, an entry a pixel.
Pilot tracePilot(const render::Scene& scene, const render::LightSampler& lights, uint64_t seed,
                 const std::vector<bool>& wanted, std::vector<render::FeatureSums>& features);

// Where the cells of all these vertices lie (odis/cells), and the unit of radiance.
ViewFrame frameOf(std::span<const Pilot> pilots);

}  // namespace odis::learn
