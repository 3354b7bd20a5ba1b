// Vertices of pilots found again as points on their surfaces, for further samples to start from.
#pragma once

#include <optional>
#include <span>

#include "render/path/path.h"

namespace odis::learn {

// A vertex as a point on its surface, and a ray that ends there as its path's did.
struct Start {
  render::SurfacePoint at;
  render::Vec3 wo;  // in the shading frame
  render::LightReference reference;
  render::Ray towards;
};

// The vertex at `index`, if it can be found: unless it is its path's first, the one before it in the list
// is the one before it on the path.
std::optional<Start> findStart(const render::Scene& scene, std::span<const PathVertex> vertices,
                               size_t index);

}  // namespace odis::learn
