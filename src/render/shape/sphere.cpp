// sphere
//
//   center        point, (0, 0, 0)
//   radius        number, 1
//   to_world      transform        applied after center and radius; rotations turn the uv coordinates
//   flip_normals  boolean, false   turn the surface inside out; a transform that mirrors does so too
//
// u runs about the z axis, v from the north pole (0) to the south pole (1).
#include "render/shape/sphere.h"

#include "render/math/warp.h"
#include "render/shape/factories.h"
#include "render/shape/sphere_cone.h"
#include "render/shape/surface_math.h"

namespace odis::render {

Sphere::Sphere(const Vec3d& center, double radius, const std::array<Vec3d, 3>& axes, bool flipNormals)
    : m_center(center), m_radius(radius), m_axes(axes), m_flipNormals(flipNormals) {}

RTCGeometryTy* Sphere::makeGeometry(RTCDeviceTy* device) const {
  return makeUserGeometry(device, *this);
}

Imath::Box3d Sphere::bounds() const {
  return {m_center - Vec3d(m_radius), m_center + Vec3d(m_radius)};
}

// Inlined into the callbacks of this file, which alone call it: shadow rays spend much of their time here.
[[gnu::always_inline]] inline bool Sphere::hit(const PreciseRay& ray, double& t) const {
  // From the point of the ray nearest to the centre, both hits are equally far.
  const Vec3d fromCenter = ray.origin - m_center;
  const double squared = ray.direction.dot(ray.direction);
  const double nearest = -fromCenter.dot(ray.direction) / squared;
  const Vec3d offset = fromCenter + ray.direction * nearest;
  const double rest = m_radius * m_radius - offset.dot(offset);
  if (!(rest >= 0)) return false;
  const double half = std::sqrt(rest / squared);
  t = nearest - half;
  if (!ray.contains(t)) t = nearest + half;
  return ray.contains(t);
}

Vec3d Sphere::toLocal(const Vec3d& unit) const {
  return {unit.dot(m_axes[0]), unit.dot(m_axes[1]), unit.dot(m_axes[2])};
}

Vec2 Sphere::uvToward(const Vec3d& local) {
  const double rho = std::sqrt(local.x * local.x + local.y * local.y);
  float phi = std::atan2(float(local.y), float(local.x));
  if (phi < 0) phi += 2 * kPi;
  return {phi * (0.5f * kInvPi), std::atan2(float(rho), float(local.z)) * kInvPi};
}

Vec2 Sphere::uvOf(const SurfacePoint& sampled) const {
  return uvToward(toLocal(Vec3d(m_flipNormals ? -sampled.ng : sampled.ng)));
}

SurfacePoint Sphere::placeToward(const Vec3d& unit) const {
  SurfacePoint at;
  at.shape = this;
  at.p = Vec3(m_center + unit * m_radius);
  at.ng = at.shading.n = Vec3(m_flipNormals ? -unit : unit);
  return at;
}

SurfacePoint Sphere::pointToward(const Vec3d& unit) const {
  SurfacePoint at = placeToward(unit);
  at.pError = preciseError(maxAbs(m_center) + m_radius);
  const Vec3d local = toLocal(unit);
  at.uv = uvToward(local);
  at.shading = CoordinateFrame(at.ng);
  if (!tangents()) return at;
  const double rho = std::sqrt(local.x * local.x + local.y * local.y);
  const double cosPhi = rho > 0 ? local.x / rho : 1, sinPhi = rho > 0 ? local.y / rho : 0;
  at.dpdu = Vec3((m_axes[1] * local.x - m_axes[0] * local.y) * (2 * M_PI * m_radius));
  at.dpdv = Vec3((m_axes[0] * (local.z * cosPhi) + m_axes[1] * (local.z * sinPhi) - m_axes[2] * rho) *
                 (M_PI * m_radius));
  at.shading = CoordinateFrame::fromTangent(at.ng, at.dpdu);
  return at;
}

SurfacePoint Sphere::surfacePoint(const Ray& ray, const RawHit& hit) const {
  const Ray local = toObject(ray, hit);
  // t is rounded, so the point is moved onto the sphere.
  const Vec3d fromCenter = Vec3d(local.origin) + Vec3d(local.direction) * double(hit.t) - m_center;
  SurfacePoint at = pointToward(fromCenter * (1 / std::sqrt(fromCenter.dot(fromCenter))));
  toWorld(at, hit);
  return at;
}

float Sphere::area() const {
  return float(4 * M_PI * m_radius * m_radius);
}

ShapeSample Sphere::sample(const Vec3& ref, const Vec2& u) const {
  const SphereCone cone(m_center, m_radius, ref);
  if (!cone.outside)
    return uniformAreaSample(
        ref, [&] { return placeToward(Vec3d(squareToSphere(u))); }, area());
  const auto [normal, wi, distance] = sampleSphere(cone, u);
  return {placeToward(normal), wi, distance, cone.pdf()};
}

float Sphere::pdf(const Vec3& ref, const SurfacePoint& at) const {
  const SphereCone cone(m_center, m_radius, ref);
  return cone.outside ? cone.pdf() : uniformAreaPdf(ref, at, area());
}

SurfacePoint Sphere::pointAtUv(const Vec2& uv) const {
  const double phi = 2 * M_PI * uv.x, theta = M_PI * uv.y, sinTheta = std::sin(theta);
  return pointToward(m_axes[0] * (std::cos(phi) * sinTheta) + m_axes[1] * (std::sin(phi) * sinTheta) +
                     m_axes[2] * std::cos(theta));
}

PrimitiveExtent Sphere::extent(uint32_t) const {
  const Imath::Box3d box = bounds();
  return {.min = roundedDown(box.min), .max = roundedUp(box.max), .area = area()};
}

ShapePtr makeSphere(const Properties& node, Builder& builder) {
  const Affine affine(readToWorld(node));
  if (!isSquare(affine.x, affine.y) || !isSquare(affine.y, affine.z) || !isSquare(affine.z, affine.x))
    builder.warn(node.location, "to_world shears or scales unevenly, which a sphere can't: it stays round");
  const float radius = node.number("radius", kRadiusRange, 1.0f);
  const Vec3d center = affine.point(node.preciseVector("center", Vec3d(0, 0, 0)));
  // Orthonormal axes, also if the transform's are not quite.
  const double scale = std::sqrt(affine.x.dot(affine.x));
  const Vec3d x = affine.x / scale, z = x.cross(affine.y).normalized(), y = z.cross(x);
  const bool flip = node.boolean("flip_normals", false) != affine.mirrors();
  return std::make_shared<Sphere>(center, radius * scale,
                                  std::array<Vec3d, 3>{x, y, affine.mirrors() ? -z : z}, flip);
}

}  // namespace odis::render
