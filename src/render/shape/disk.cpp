// disk: the unit disk in the plane z = 0, facing +z.
//
//   to_world      transform        an uneven scale makes an ellipse
//   flip_normals  boolean, false   turn the surface inside out
//
// u is the distance from the centre, v the angle about it over 2 pi.
#include "render/shape/disk.h"

#include "render/math/warp.h"
#include "render/shape/factories.h"
#include "render/shape/surface_math.h"

namespace odis::render {

Disk::Disk(const Affine& toWorld, bool flipNormals)
    : m_center(toWorld.origin), m_x(toWorld.x), m_y(toWorld.y) {
  const Vec3d normal = m_x.cross(m_y);
  const double squared = normal.dot(normal);
  m_dualX = m_y.cross(normal) / squared;
  m_dualY = normal.cross(m_x) / squared;
  m_normal = normal / (flipNormals != toWorld.mirrors() ? -std::sqrt(squared) : std::sqrt(squared));
  m_area = float(M_PI * std::sqrt(squared));
}

RTCGeometryTy* Disk::makeGeometry(RTCDeviceTy* device) const {
  return makeUserGeometry(device, *this);
}

Imath::Box3d Disk::bounds() const {
  const Vec3d extent(std::hypot(m_x.x, m_y.x), std::hypot(m_x.y, m_y.y), std::hypot(m_x.z, m_y.z));
  return {m_center - extent, m_center + extent};
}

bool Disk::hit(const PreciseRay& ray, double& t) const {
  t = (m_center - ray.origin).dot(m_normal) / ray.direction.dot(m_normal);
  if (!ray.contains(t)) return false;
  const Imath::V2d at = local(ray.at(t) - m_center);
  return at.x * at.x + at.y * at.y <= 1;
}

SurfacePoint Disk::pointAt(double x, double y) const {
  const double r = std::hypot(x, y);
  const double cosPhi = r > 0 ? x / r : 1, sinPhi = r > 0 ? y / r : 0;
  double phi = std::atan2(y, x);
  if (phi < 0) phi += 2 * M_PI;

  SurfacePoint at;
  at.shape = this;
  const Vec3d p = m_center + m_x * x + m_y * y;
  at.p = Vec3(p);
  at.pError = preciseError(maxAbs(m_center) + maxAbs(m_x) + maxAbs(m_y));
  at.uv = {float(r), float(phi / (2 * M_PI))};
  at.dpdu = Vec3(m_x * cosPhi + m_y * sinPhi);
  at.dpdv = Vec3((m_y * x - m_x * y) * (2 * M_PI));
  at.ng = Vec3(m_normal);
  at.shading = CoordinateFrame::fromTangent(at.ng, at.dpdu);
  return at;
}

SurfacePoint Disk::surfacePoint(const Ray& ray, const RawHit& hit) const {
  const Ray inObject = toObject(ray, hit);
  // t is rounded, so the point is found again.
  const Vec3d fromCenter = Vec3d(inObject.origin) - m_center, direction(inObject.direction);
  const Imath::V2d on = local(fromCenter - direction * (fromCenter.dot(m_normal) / direction.dot(m_normal)));
  SurfacePoint at = pointAt(on.x, on.y);
  toWorld(at, hit);
  return at;
}

ShapeSample Disk::sample(const Vec3& ref, const Vec2& u) const {
  const Vec2 on = squareToDisk(u);
  return uniformAreaSample(
      ref, [&] { return pointAt(on.x, on.y); }, m_area);
}

float Disk::pdf(const Vec3& ref, const SurfacePoint& at) const {
  return uniformAreaPdf(ref, at, m_area);
}

SurfacePoint Disk::pointAtUv(const Vec2& uv) const {
  const double phi = 2 * M_PI * uv.y;
  return pointAt(uv.x * std::cos(phi), uv.x * std::sin(phi));
}

PrimitiveExtent Disk::extent(uint32_t) const {
  const Imath::Box3d box = bounds();
  return {.min = roundedDown(box.min),
          .max = roundedUp(box.max),
          .axis = Vec3(m_normal),
          .theta = 0,
          .area = m_area};
}

ShapePtr makeDisk(const Properties& node, Builder&) {
  return std::make_shared<Disk>(Affine(readToWorld(node)), node.boolean("flip_normals", false));
}

}  // namespace odis::render
