// Light leaving a mesh whose radiance is a texture. Manual page in area.cpp.
#pragma once

#include <vector>

#include "render/emitter/area.h"
#include "render/shape/mesh.h"

namespace odis::render {

// Each triangle is cut into n^2 equal ones, which are the parts, uniform by area each; the brighter ones
// are chosen more often.
class TexturedMeshLight final : public AreaLight {
 public:
  TexturedMeshLight(const Mesh& mesh, TexturePtr radiance);

  uint32_t partCount() const override { return m_first.back(); }
  LightBounds bounds(uint32_t part) const override;
  EmitterSample sample(uint32_t part, const Vec3& ref, const Vec2& u) const override;
  uint32_t part(const SurfacePoint& at) const override;
  float pdf(const Vec3& ref, const SurfacePoint& at) const override;

 private:
  struct Cell {
    uint32_t triangle, n, index;
  };
  Cell cellOf(uint32_t part) const;
  uint32_t divisions(uint32_t triangle) const;
  // The average of the radiance over the cell and its channels.
  float meanRadiance(const Cell& cell) const;

  const Mesh& m_mesh;
  std::vector<uint32_t> m_first;  // part of each triangle, and their number
};

}  // namespace odis::render
