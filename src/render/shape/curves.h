// Tubes about curves, as hair and fibres: round, hollow, open at their ends, seen from outside only.
#pragma once

#include <vector>

#include "render/shape/affine.h"
#include "render/shape/shape.h"
#include "render/xml/error.h"

namespace odis::render {

// Control points in world space. A curve begins at each of `starts` (indices into the points) and ends where
// the next begins.
struct CurveData {
  struct Point {
    float x, y, z, radius;
  };
  std::vector<Point> points;
  std::vector<uint32_t> starts;
};

// Reads a text of one control point a line, x, y, z and the radius; blank lines part curves. Throws
// SceneError for what is no such text, or a curve of fewer than `fewest` points. The points are transformed
// by `toWorld`, the radii are not. src/render/shape/curve_file.cpp
CurveData readCurves(const std::string& path, const SourceLocation& at, const Matrix4& toWorld,
                     size_t fewest);

// What is between control points: straight lines from one to the next, or uniform cubic B-splines. Each piece
// is a primitive.
enum class CurveBasis : uint8_t { linear, bspline };

class Curves final : public Shape {
 public:
  Curves(CurveData data, CurveBasis basis);

  RTCGeometryTy* makeGeometry(RTCDeviceTy* device) const override;
  SurfacePoint surfacePoint(const Ray& ray, const RawHit& hit) const override;
  // Approximated by straight tubes between the ends of the pieces.
  float area() const override { return m_area; }
  // Curves can't be sampled, and so don't emit.
  bool canEmit() const override { return false; }
  ShapeSample sample(const Vec3&, const Vec2&) const override { return {}; }
  float pdf(const Vec3&, const SurfacePoint&) const override { return 0; }
  uint64_t primitiveCount() const override { return m_pieces.size(); }
  PrimitiveExtent extent(uint32_t piece) const override;
  uint64_t bytes() const override;

 private:
  // The axis of a tube at one place, and its derivatives along a piece.
  struct Axis {
    Vec3d p, d, dd;
    double radius, dRadius;
  };
  Axis axisAt(uint32_t piece, double v) const;

  CurveBasis m_basis;
  std::vector<CurveData::Point> m_points;
  std::vector<uint32_t> m_pieces;  // first control point of each
  float m_area = 0;
};

}  // namespace odis::render
