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

inline Vec3 roundedDown(const Imath::V3d& v) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  return {std::nextafter(float(v.x), -infinity), std::nextafter(float(v.y), -infinity),
          std::nextafter(float(v.z), -infinity)};
}
inline Vec3 roundedUp(const Imath::V3d& v) {
  return -roundedDown(-v);
}

namespace detail {

inline PreciseRay preciseRay(const RTCRay& ray) {
  return {{ray.org_x, ray.org_y, ray.org_z}, {ray.dir_x, ray.dir_y, ray.dir_z}, ray.tnear, ray.tfar};
}

template <class Analytic>
void boundsCallback(const RTCBoundsFunctionArguments* arguments) {
  // Rounded outwards, as the box is known in double precision.
  const Imath::Box3d box = static_cast<const Analytic*>(arguments->geometryUserPtr)->bounds();
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
  if (!arguments->valid[0]) return;
  auto& rayHit = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);
  double t;
  if (!static_cast<const Analytic*>(arguments->geometryUserPtr)->hit(preciseRay(rayHit.ray), t)) return;
  rayHit.ray.tfar = float(t);
  rayHit.hit.u = rayHit.hit.v = 0;
  rayHit.hit.Ng_x = rayHit.hit.Ng_y = rayHit.hit.Ng_z = 0;
  rayHit.hit.primID = arguments->primID;
  rayHit.hit.geomID = arguments->geomID;
  rayHit.hit.instID[0] = arguments->context->instID[0];
}

template <class Analytic>
void occludedCallback(const RTCOccludedFunctionNArguments* arguments) {
  if (!arguments->valid[0]) return;
  auto& ray = *reinterpret_cast<RTCRay*>(arguments->ray);
  double t;
  if (static_cast<const Analytic*>(arguments->geometryUserPtr)->hit(preciseRay(ray), t))
    ray.tfar = -std::numeric_limits<float>::infinity();
}

}  // namespace detail

// `Analytic` has `Imath::Box3d bounds() const` and `bool hit(const PreciseRay&, double& t) const`, the
// nearest hit.
template <class Analytic>
RTCGeometry makeUserGeometry(RTCDevice device, const Analytic& shape) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, 1);
  rtcSetGeometryUserData(geometry, const_cast<Analytic*>(&shape));
  rtcSetGeometryBoundsFunction(
      geometry, [](const RTCBoundsFunctionArguments* a) { detail::boundsCallback<Analytic>(a); }, nullptr);
  rtcSetGeometryIntersectFunction(geometry, detail::intersectCallback<Analytic>);
  rtcSetGeometryOccludedFunction(geometry, detail::occludedCallback<Analytic>);
  rtcCommitGeometry(geometry);
  return geometry;
}

}  // namespace odis::render
