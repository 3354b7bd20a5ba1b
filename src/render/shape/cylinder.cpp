// cylinder: open at both ends, its normals pointing away from the axis.
//
//   p0, p1        points, (0, 0, 0) and (0, 0, 1)   the ends of the axis
//   radius        number, 1
//   to_world      transform        applied to the whole
//   flip_normals  boolean, false   turn the surface inside out
//
// u runs about the axis, v along it from p0 (0) to p1 (1).
#include "render/shape/cylinder.h"

#include "render/shape/factories.h"
#include "render/shape/surface_math.h"

namespace odis::render {

Cylinder::Cylinder(const Vec3d& start, const Vec3d& axis, const Vec3d& x, const Vec3d& y, double radius,
                   bool flipNormals)
    : m_start(start),
      m_axis(axis),
      m_x(x),
      m_y(y),
      m_radius(radius),
      m_length(std::sqrt(axis.dot(axis))),
      m_flipNormals(flipNormals) {}

RTCGeometryTy* Cylinder::makeGeometry(RTCDeviceTy* device) const {
  return makeUserGeometry(device, *this);
}

Imath::Box3d Cylinder::bounds() const {
  const Vec3d extent =
      Vec3d(std::hypot(m_x.x, m_y.x), std::hypot(m_x.y, m_y.y), std::hypot(m_x.z, m_y.z)) * m_radius;
  Imath::Box3d box(m_start - extent, m_start + extent);
  box.extendBy(m_start + m_axis - extent);
  box.extendBy(m_start + m_axis + extent);
  return box;
}

bool Cylinder::hit(const PreciseRay& ray, double& t) const {
  // A circle and a line, in the plane at right angles to the axis.
  const Vec3d fromStart = ray.origin - m_start;
  const Imath::V2d origin(fromStart.dot(m_x), fromStart.dot(m_y)),
      direction(ray.direction.dot(m_x), ray.direction.dot(m_y));
  const double squared = direction.dot(direction);
  const double nearest = -origin.dot(direction) / squared;
  const Imath::V2d offset = origin + direction * nearest;
  const double rest = m_radius * m_radius - offset.dot(offset);
  if (!(rest >= 0)) return false;
  const double half = std::sqrt(rest / squared);
  for (const double root : {nearest - half, nearest + half}) {
    const double z = (fromStart + ray.direction * root).dot(m_axis);
    if (!ray.contains(root) || z < 0 || z > m_length * m_length) continue;
    t = root;
    return true;
  }
  return false;
}

SurfacePoint Cylinder::pointAt(double cosPhi, double sinPhi, double z) const {
  double phi = std::atan2(sinPhi, cosPhi);
  if (phi < 0) phi += 2 * M_PI;
  const Vec3d outward = m_x * cosPhi + m_y * sinPhi;

  SurfacePoint at;
  at.shape = this;
  at.p = Vec3(m_start + m_axis * z + outward * m_radius);
  at.pError = preciseError(maxAbs(m_start) + maxAbs(m_axis) + m_radius);
  at.uv = {float(phi / (2 * M_PI)), float(z)};
  at.dpdu = Vec3((m_y * cosPhi - m_x * sinPhi) * (2 * M_PI * m_radius));
  at.dpdv = Vec3(m_axis);
  at.ng = Vec3(m_flipNormals ? -outward : outward);
  at.shading = CoordinateFrame::fromTangent(at.ng, at.dpdu);
  return at;
}

SurfacePoint Cylinder::surfacePoint(const Ray& ray, const RawHit& hit) const {
  const Ray inObject = toObject(ray, hit);
  // t is rounded, so the point is moved onto the cylinder.
  const Vec3d on = Vec3d(inObject.origin) + Vec3d(inObject.direction) * double(hit.t) - m_start;
  const double x = on.dot(m_x), y = on.dot(m_y), r = std::hypot(x, y);
  SurfacePoint at = pointAt(x / r, y / r, on.dot(m_axis) / (m_length * m_length));
  toWorld(at, hit);
  return at;
}

ShapeSample Cylinder::sample(const Vec3& ref, const Vec2& u) const {
  const double phi = 2 * M_PI * u.y;
  return uniformAreaSample(
      ref, [&] { return pointAt(std::cos(phi), std::sin(phi), u.x); }, area());
}

float Cylinder::pdf(const Vec3& ref, const SurfacePoint& at) const {
  return uniformAreaPdf(ref, at, area());
}

SurfacePoint Cylinder::pointAtUv(const Vec2& uv) const {
  const double phi = 2 * M_PI * uv.x;
  return pointAt(std::cos(phi), std::sin(phi), uv.y);
}

PrimitiveExtent Cylinder::extent(uint32_t) const {
  const Imath::Box3d box = bounds();
  return {.min = roundedDown(box.min), .max = roundedUp(box.max), .area = area()};
}

ShapePtr makeCylinder(const Properties& node, Builder& builder) {
  const Affine affine(readToWorld(node));
  const Vec3d p0 = node.preciseVector("p0", Vec3d(0, 0, 0)), p1 = node.preciseVector("p1", Vec3d(0, 0, 1));
  const double length = std::sqrt((p1 - p0).dot(p1 - p0));
  const float radius = node.number("radius", kRadiusRange, 1.0f);
  if (!(length > 0) || !std::isfinite(length))
    throw SceneError(node.location, "p0 and p1 of a cylinder must be finite and apart");

  // The frame about the axis decides where u starts, so it is that of CoordinateFrame(normal) before the
  // transform.
  const CoordinateFrame frame(Vec3((p1 - p0) / length));
  const Vec3d axis = affine.vector(p1 - p0), x = affine.vector(Vec3d(frame.s)),
              y = affine.vector(Vec3d(frame.t));
  const Vec3d direction = axis.normalized();
  if (!isSquare(x, y) || std::abs(x.dot(direction)) > 1e-4 * x.length() ||
      std::abs(y.dot(direction)) > 1e-4 * y.length())
    builder.warn(node.location, "to_world shears or scales unevenly, which a cylinder can't: it stays round");
  const Vec3d unitX = (x - direction * x.dot(direction)).normalized();
  const Vec3d unitY = affine.mirrors() ? unitX.cross(direction) : direction.cross(unitX);
  return std::make_shared<Cylinder>(affine.point(p0), axis, unitX, unitY, radius * x.length(),
                                    node.boolean("flip_normals", false));
}

}  // namespace odis::render
