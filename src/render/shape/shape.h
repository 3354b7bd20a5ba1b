// The interface of shapes: what the intersector finds and what area lights are sampled on.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/bsdf/bsdf.h"
#include "render/emitter/emitter.h"
#include "render/medium/medium.h"

struct RTCGeometryTy;
struct RTCDeviceTy;

namespace odis::render {

struct ShapeSample {
  SurfacePoint at;  // p, ng, shading.n, shape, primitive, barycentric, and uv unless Shape::uvOf() finds them
  Vec3 wi;          // unit, from the reference point to at.p
  float distance = 0;
  float pdf = 0;  // solid angle at the reference point; 0 if nothing could be sampled
};

// A hit as Embree reports it, with the place of the instance it is in (null: no instance).
struct RawHit {
  float t = 0;
  float u = 0, v = 0;
  uint32_t primitive = 0;
  const Placement* instance = nullptr;
};

class Mesh;
class Shape;

// What a ray met: null and nothing else if it met nothing.
struct Hit {
  const Shape* shape = nullptr;
  RawHit raw;
  const Motion* motion = nullptr;  // of an instance that moves, whose place raw.instance is not

  // The point in world space that the ray met.
  SurfacePoint surfacePoint(const Ray& ray) const;
};

// The same for an instance that moves.
SurfacePoint movingPoint(const Ray& ray, const Hit& hit);

// Bounds of a primitive (a triangle of a mesh, the whole of other shapes): its box, and a cone about all
// shading normals.
struct PrimitiveExtent {
  Vec3 min, max;
  Vec3 axis{0, 0, 1};  // unit
  float theta = kPi;   // radians
  float area = 0;

  void extendBy(const PrimitiveExtent& other) {
    for (int axis = 0; axis < 3; ++axis) {
      min[axis] = std::min(min[axis], other.min[axis]);
      max[axis] = std::max(max[axis], other.max[axis]);
    }
  }
  float longestSide() const { return std::max({max.x - min.x, max.y - min.y, max.z - min.z}); }
};

class Shape {
 public:
  virtual ~Shape() = default;

  // The size of the smallest thing that the shape may be, in its own space.
  virtual float detail() const;
  // Creates and commits the Embree geometry of triangles larger than this, which are then not part of what
  // makeGeometry() makes; null if there are none. `whole`: all triangles are, if one is, so that edges are
  // the same for both of their triangles.
  virtual RTCGeometryTy* makeLargeGeometry(RTCDeviceTy* /*device*/, float /*extent*/, bool /*whole*/) {
    return nullptr;
  }
  // Creates and commits the Embree geometry. Shapes in world space unless they belong to a shape group.
  virtual RTCGeometryTy* makeGeometry(RTCDeviceTy* device) const = 0;
  // The point in world space that `ray` met at `hit`.
  virtual SurfacePoint surfacePoint(const Ray& ray, const RawHit& hit) const = 0;

  virtual float area() const = 0;
  // Samples a point as seen from `ref`, by solid angle where the shape knows how (spheres by their cone),
  // else by area.
  virtual ShapeSample sample(const Vec3& ref, const Vec2& u) const = 0;
  // The texture coordinates of what sample() gave: some shapes leave them to those that ask.
  virtual Vec2 uvOf(const SurfacePoint& sampled) const { return sampled.uv; }
  // Density with respect to solid angle with which sample(ref, .) gives the direction to `at`.
  virtual float pdf(const Vec3& ref, const SurfacePoint& at) const = 0;
  virtual uint64_t primitiveCount() const { return 1; }
  // The point with texture coordinates in [0, 1]^2; only of shapes that are one primitive.
  virtual SurfacePoint pointAtUv(const Vec2& /*uv*/) const { return {}; }
  // The area there of an element of uv, per its size.
  virtual float areaElement(const Vec2& /*uv*/) const { return 0; }
  // A point for u, uniform in [0, 1)^2, and what it weighs in a mean over the area, 1 on average: shapes of
  // one primitive by uv, meshes by area.
  virtual SurfacePoint pointOverArea(const Vec2& u) const { return pointAtUv(u); }
  virtual float areaWeight(const Vec2& u) const { return areaElement(u) / area(); }
  virtual PrimitiveExtent extent(uint32_t primitive) const = 0;
  // The same for one primitive: samples it, and the density with which it gives the direction to `at`, on it.
  virtual ShapeSample samplePrimitive(uint32_t /*primitive*/, const Vec3& ref, const Vec2& u) const {
    return sample(ref, u);
  }
  virtual float primitivePdf(const Vec3& ref, const SurfacePoint& at) const { return pdf(ref, at); }
  // The value of an attribute of the mesh at a point of it, a grey if it is one number; nothing if there is
  // none of this name.
  virtual std::optional<Rgb> attribute(const std::string& /*name*/, const SurfacePoint& /*at*/) const {
    return {};
  }
  // The least and the greatest number of an attribute; nothing if there is none of this name.
  virtual std::optional<Vec2> attributeRange(const std::string& /*name*/) const { return {}; }
  virtual uint64_t bytes() const { return 0; }

  // This shape if it is a mesh, else null.
  const Mesh* mesh() const { return m_mesh; }
  const Bsdf& bsdf() const { return *m_bsdf; }
  const SurfaceEmitter* emitter() const { return m_emitter.get(); }
  // Where the surface ends: midpoints of edges, centres of circles, in the space of the shape; none if it is
  // closed. Takes a while for large meshes.
  virtual std::vector<Vec3> openings() const { return {}; }
  // Whether an area light may lie on it.
  virtual bool canEmit() const { return true; }
  // Whether surface points need dpdu, dpdv and a shading frame along them.
  bool tangents() const { return !m_bsdf || m_bsdf->traits().tangents; }
  SurfaceEmitter* emitter() { return m_emitter.get(); }
  void setBsdf(BsdfPtr bsdf) { m_bsdf = std::move(bsdf); }
  void setEmitter(std::shared_ptr<SurfaceEmitter> emitter) { m_emitter = std::move(emitter); }
  // Whether light may pass it straight through.
  bool passesStraight() const { return m_bsdf && m_bsdf->traits().passesStraight; }
  // The media on both sides of the surface, null for none. As in Mitsuba a surface with a medium on either
  // side bounds both; others lie within whatever medium there is.
  bool boundsMedia() const { return m_interior || m_exterior; }
  const Medium* interior() const { return m_interior.get(); }
  const Medium* exterior() const { return m_exterior.get(); }
  void setMedia(MediumPtr interior, MediumPtr exterior) {
    m_interior = std::move(interior);
    m_exterior = std::move(exterior);
  }
  // The medium that a ray gets into that leaves the point in this direction out of the medium `current`.
  const Medium* mediumBeyond(const SurfacePoint& at, const Vec3& direction, const Medium* current) const {
    if (!boundsMedia()) return current;
    return dot(direction, at.ng) > 0 ? m_exterior.get() : m_interior.get();
  }

 protected:
  const Mesh* m_mesh = nullptr;

 private:
  BsdfPtr m_bsdf;
  std::shared_ptr<SurfaceEmitter> m_emitter;
  MediumPtr m_interior, m_exterior;
};

inline float Shape::detail() const {
  PrimitiveExtent whole{Vec3(kInfinity), Vec3(-kInfinity)};
  for (uint64_t i = 0; i < primitiveCount(); ++i) whole.extendBy(extent(uint32_t(i)));
  return whole.longestSide();
}

inline SurfacePoint Hit::surfacePoint(const Ray& ray) const {
  SurfacePoint at = motion ? movingPoint(ray, *this) : shape->surfacePoint(ray, raw);
  at.time = ray.time;
  return at;
}

using ShapePtr = std::shared_ptr<Shape>;

}  // namespace odis::render
