// A surface as the zeros of a grid of signed distances, interpolated trilinearly.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "render/shape/affine.h"
#include "render/shape/shape.h"
#include "render/shape/user_geometry.h"
#include "render/xml/error.h"

namespace odis::render {

// Values at the corners of cells that fill the unit cube, x fastest; at least two along each axis.
struct DistanceGrid {
  std::array<uint32_t, 3> size{};
  std::vector<float> values;
};

// Reads a volume of one channel. Throws SceneError: at `at` if it can't be read, in the file if it is no such
// file. src/render/shape/sdfgrid.cpp
DistanceGrid readDistanceGrid(const std::string& path, const SourceLocation& at);

// Hansson-Soderlund et al. 2022, "Ray Tracing of Signed Distance Function Grids". Every cell that the surface
// passes through is a primitive. There are no texture coordinates.
class SdfGrid final : public Shape {
 public:
  // With `smooth`, shading normals are continuous from cell to cell; else they are those of the surface.
  SdfGrid(DistanceGrid grid, const Matrix4& toWorld, bool smooth);

  RTCGeometryTy* makeGeometry(RTCDeviceTy* device) const override;
  SurfacePoint surfacePoint(const Ray& ray, const RawHit& hit) const override;
  float area() const override { return 0; }  // unknown
  bool canEmit() const override { return false; }
  ShapeSample sample(const Vec3&, const Vec2&) const override { return {}; }
  float pdf(const Vec3&, const SurfacePoint&) const override { return 0; }
  uint64_t primitiveCount() const override { return m_cells.size(); }
  PrimitiveExtent extent(uint32_t cell) const override;
  uint64_t bytes() const override;

  Imath::Box3d bounds(uint32_t cell) const;
  bool hit(uint32_t cell, const PreciseRay& ray, double& t) const;

 private:
  using Cell = std::array<uint32_t, 3>;

  float corner(uint32_t x, uint32_t y, uint32_t z) const {
    return m_grid.values[(uint64_t(z) * m_grid.size[1] + y) * m_grid.size[0] + x];
  }
  bool isCrossed(const Cell& cell) const;
  // At a point in cells; beyond the grid as at its border.
  double value(const Vec3d& p) const;
  // The change of value from one side of a cell to the other along each axis, elsewhere as at the point.
  Vec3d gradient(const Vec3d& p, const Cell& cell) const;
  Vec3d smoothNormal(const Vec3d& p) const;
  // The point of the surface nearest to a point in cells that is at most `most` cells off it; false if there
  // is no such point along the gradient.
  bool moveOntoSurface(const Cell& cell, double most, Vec3d& p) const;

  DistanceGrid m_grid;
  Affine m_toWorld;
  Imath::M44d m_toGrid;  // from the world to cells
  std::vector<Cell> m_cells;
  bool m_smooth;
};

}  // namespace odis::render
