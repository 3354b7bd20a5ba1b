// Analytic shapes as Embree user geometry. The shape intersects in double precision, because single precision
// loses the roots of a quadric that is small or far away.
#pragma once

#include <ImathBox.h>

#include <cmath>
#include <limits>

#include "render/math/vec.h"
#include "render/shape/embree.h"

namespace odis::render {

// `direction` need not be of unit length: inside an instance it is not.
struct PreciseRay {
  Imath::V3d origin, direction;
  double tMin, tMax;

  Imath::V3d at(double t) const { return origin + direction * t; }
  bool contains(double t) const { return t > tMin && t < tMax; }
};

// Where a ray meets a shape; of triangles, with their number in the mesh and barycentric coordinates.
struct PreciseHit {
  double t;
  double u = 0, v = 0;
  unsigned primitive;
};

inline Vec3 roundedDown(const Imath::V3d& v) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  return {std::nextafter(float(v.x), -infinity), std::nextafter(float(v.y), -infinity),
          std::nextafter(float(v.z), -infinity)};
}
inline Vec3 roundedUp(const Imath::V3d& v) {
  return -roundedDown(-v);
}

namespace detail {

// Ray i of a packet of n.
inline PreciseRay preciseRay(RTCRayN* rays, unsigned n, unsigned i) {
  return {{RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i)},
          {RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)},
          RTCRayN_tnear(rays, n, i),
          RTCRayN_tfar(rays, n, i)};
}

// Shapes of one primitive need not be told which.
template <class Analytic>
Imath::Box3d boundsOf(const void* shape, unsigned primitive) {
  const auto& analytic = *static_cast<const Analytic*>(shape);
  if constexpr (requires { analytic.bounds(primitive); })
    return analytic.bounds(primitive);
  else
    return analytic.bounds();
}
template <class Analytic>
bool hit(const void* shape, unsigned primitive, const PreciseRay& ray, PreciseHit& hit) {
  const auto& analytic = *static_cast<const Analytic*>(shape);
  hit.primitive = primitive;
  if constexpr (requires { analytic.hit(primitive, ray, hit); })
    return analytic.hit(primitive, ray, hit);
  else if constexpr (requires { analytic.hit(primitive, ray, hit.t); })
    return analytic.hit(primitive, ray, hit.t);
  else
    return analytic.hit(ray, hit.t);
}

template <class Analytic>
void boundsCallback(const RTCBoundsFunctionArguments* arguments) {
  // Rounded outwards, as the box is known in double precision.
  const Imath::Box3d box = boundsOf<Analytic>(arguments->geometryUserPtr, arguments->primID);
  const Vec3 lower = roundedDown(box.min), upper = roundedUp(box.max);
  RTCBounds& bounds = *arguments->bounds_o;
  bounds.lower_x = lower.x;
  bounds.lower_y = lower.y;
  bounds.lower_z = lower.z;
  bounds.upper_x = upper.x;
  bounds.upper_y = upper.y;
  bounds.upper_z = upper.z;
}

template <class Analytic>
void intersectCallback(const RTCIntersectFunctionNArguments* arguments) {
  const unsigned n = arguments->N;
  RTCRayN* rays = RTCRayHitN_RayN(arguments->rayhit, n);
  RTCHitN* hits = RTCRayHitN_HitN(arguments->rayhit, n);
  for (unsigned i = 0; i < n; ++i) {
    PreciseHit found;
    if (!arguments->valid[i] ||
        !hit<Analytic>(arguments->geometryUserPtr, arguments->primID, preciseRay(rays, n, i), found))
      continue;
    RTCRayN_tfar(rays, n, i) = float(found.t);
    RTCHitN_u(hits, n, i) = float(found.u);
    RTCHitN_v(hits, n, i) = float(found.v);
    RTCHitN_Ng_x(hits, n, i) = RTCHitN_Ng_y(hits, n, i) = RTCHitN_Ng_z(hits, n, i) = 0;
    RTCHitN_primID(hits, n, i) = found.primitive;
    RTCHitN_geomID(hits, n, i) = arguments->geomID;
    RTCHitN_instID(hits, n, i, 0) = arguments->context->instID[0];
  }
}

template <class Analytic>
void occludedCallback(const RTCOccludedFunctionNArguments* arguments) {
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i) {
    PreciseHit found;
    if (arguments->valid[i] &&
        hit<Analytic>(arguments->geometryUserPtr, arguments->primID, preciseRay(arguments->ray, n, i), found))
      RTCRayN_tfar(arguments->ray, n, i) = -std::numeric_limits<float>::infinity();
  }
}

}  // namespace detail

// `Analytic` has `Imath::Box3d bounds() const` and `bool hit(const PreciseRay&, double& t) const`, the
// nearest hit; both with the number of the primitive as the first argument if there are several. Triangles
// tell more of a hit.
template <class Analytic>
RTCGeometry makeUserGeometry(RTCDevice device, const Analytic& shape, unsigned primitives = 1) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, primitives);
  rtcSetGeometryUserData(geometry, const_cast<Analytic*>(&shape));
  rtcSetGeometryBoundsFunction(
      geometry, [](const RTCBoundsFunctionArguments* a) { detail::boundsCallback<Analytic>(a); }, nullptr);
  rtcSetGeometryIntersectFunction(geometry, detail::intersectCallback<Analytic>);
  rtcSetGeometryOccludedFunction(geometry, detail::occludedCallback<Analytic>);
  rtcCommitGeometry(geometry);
  return geometry;
}

}  // namespace odis::render
