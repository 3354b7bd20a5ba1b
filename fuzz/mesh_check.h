// What must hold of every mesh that a file becomes.
#pragma once

#include <cmath>
#include <cstdlib>

#include "render/shape/mesh.h"

namespace odis::fuzz {

// Makes the mesh and looks at points of it, as a ray that hits it would.
inline void checkMesh(render::MeshData data, const render::MeshOptions& options) {
  using namespace render;
  if (!data.normals.empty() && data.normals.size() != data.positions.size()) std::abort();
  if (!data.uvs.empty() && data.uvs.size() != data.positions.size()) std::abort();
  std::vector<std::string> attributes;
  for (const MeshAttribute& attribute : data.attributes) attributes.push_back(attribute.name);
  Warnings warnings;
  const std::shared_ptr<Mesh> mesh = Mesh::make(std::move(data), options, {}, warnings);
  if (!mesh) return;
  const auto count = uint32_t(mesh->primitiveCount());
  for (const uint32_t triangle : {0u, count / 2, count - 1}) {
    const SurfacePoint at = mesh->pointOn(triangle, {0.25f, 0.5f});
    if (std::abs(length(at.shading.n) - 1) > 1e-3f) std::abort();
    for (const std::string& name : attributes) mesh->attribute(name, at);
  }
  if (mesh->area() > 0) mesh->sample({1, 2, 3}, {0.5f, 0.5f});
}

}  // namespace odis::fuzz
