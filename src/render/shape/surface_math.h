// What shapes share: sampling by area, points inside instances, and the precision of positions.
#pragma once

#include "render/shape/shape.h"

namespace odis::render {

// How far a point whose coordinates (or those that it was computed from) reach `magnitude` may be off the
// surface: interpolation, the offset itself and the next intersection each err by a few units of 2^-24.
inline float positionError(float magnitude) {
  return magnitude * (64 * 0x1p-24f);
}

// The same of points that are found in double precision from numbers up to `magnitude`, and of shapes that
// are met in it. What rounding to single precision adds hangs on the point alone; spawnRay() knows of that.
inline float preciseError(double magnitude) {
  return float(magnitude * (64 * 0x1p-53));
}

// How far rounding its coordinates to single precision, once as a point and once as the origin of a ray, may
// move a point along a unit normal: each time by 2^-24 of each; with room to spare.
inline float roundingAlong(const Vec3& normal, const Vec3& p) {
  return (std::abs(normal.x * p.x) + std::abs(normal.y * p.y) + std::abs(normal.z * p.z)) * (8 * 0x1p-24f);
}

// The point of a triangle with barycentric coordinates (b1, b2): in double precision, so that it is off the
// triangle by no more than its own coordinates are rounded, however far away the corners are.
inline Vec3 pointOnTriangle(const Vec3& c0, const Vec3& c1, const Vec3& c2, const Vec2& b) {
  const double b1 = b.x, b2 = b.y, b0 = 1 - b1 - b2;
  return {float(c0.x * b0 + c1.x * b1 + c2.x * b2), float(c0.y * b0 + c1.y * b1 + c2.y * b2),
          float(c0.z * b0 + c1.z * b1 + c2.z * b2)};
}

template <class T>
T maxAbs(const Imath::Vec3<T>& v) {
  return std::max(std::max(std::abs(v.x), std::abs(v.y)), std::abs(v.z));
}

// `v` over its length, in double precision so that tiny vectors have a direction too; `fallback` if it has
// none.
inline Vec3 normalizeOr(const Imath::V3d& v, const Vec3& fallback) {
  const double length = std::sqrt(v.dot(v));
  return length > 0 && std::isfinite(length) ? Vec3(v * (1 / length)) : fallback;
}
// The same, in single precision where that is enough.
inline Vec3 normalizeOr(const Vec3& v, const Vec3& fallback) {
  const float squared = lengthSquared(v);
  if (squared > 1e-20f && squared < 1e20f) return v * (1 / std::sqrt(squared));
  return normalizeOr(Imath::V3d(v), fallback);
}

// The solid-angle density at `ref` of a point that is distributed uniformly over `area`.
inline float uniformAreaPdf(const Vec3& ref, const SurfacePoint& at, float area) {
  const Vec3 d = at.p - ref;
  const float squared = lengthSquared(d);
  const float cosine = absDot(at.ng, d) / std::sqrt(squared);
  const float pdf = squared / (cosine * area);
  return std::isfinite(pdf) ? pdf : 0.0f;
}

// Completes the sample of the point that `draw` returns, drawn uniformly over `area`; without a copy of it.
template <class Draw>
ShapeSample uniformAreaSample(const Vec3& ref, const Draw& draw, float area) {
  ShapeSample sample{draw(), {}, 0, 0};
  const Vec3 d = sample.at.p - ref;
  const float squared = lengthSquared(d);
  sample.distance = std::sqrt(squared);
  if (!(sample.distance > 0)) return sample;
  sample.wi = d * (1 / sample.distance);
  const float pdf = squared / (absDot(sample.at.ng, sample.wi) * area);
  if (std::isfinite(pdf)) sample.pdf = pdf;
  return sample;
}

// The ray in the space of the instance that was hit; its direction is not of unit length there, so t is the
// same.
inline Ray toObject(const Ray& ray, const RawHit& hit) {
  if (!hit.instance) return ray;
  return {transformPoint(hit.instance->toInstance, ray.origin),
          transformVector(hit.instance->toInstance, ray.direction), ray.tMax, ray.time};
}

// Takes a point from the space of the instance that was hit to world space. Each term of the sums that its
// coordinates are has its rounding, on this way and on that of a ray from there into the instance, whose
// error then comes back as the point does.
inline void toWorld(SurfacePoint& at, const RawHit& hit) {
  if (!hit.instance) return;
  const auto& [m, inverse] = *hit.instance;
  const Vec3 inObject = at.p;
  at.p = transformPoint(m, inObject);
  float scale = 0;
  Vec3 terms(std::abs(m[3][0]), std::abs(m[3][1]), std::abs(m[3][2]));
  for (int row = 0; row < 3; ++row) {
    float inRow = std::abs(inObject[row]) + std::abs(inverse[3][row]);
    for (int axis = 0; axis < 3; ++axis) inRow += std::abs(at.p[axis] * inverse[axis][row]);
    for (int axis = 0; axis < 3; ++axis) terms[axis] += std::abs(m[row][axis]) * inRow;
    scale += sqr(m[row][0]) + sqr(m[row][1]) + sqr(m[row][2]);
  }
  at.pError = at.pError * std::sqrt(scale) + maxAbs(terms) * (16 * 0x1p-24f);
  at.dpdu = transformVector(m, at.dpdu);
  at.dpdv = transformVector(m, at.dpdv);
  at.ng = normalize(transformNormal(inverse, at.ng));
  at.shading = CoordinateFrame::fromTangent(normalize(transformNormal(inverse, at.shading.n)), at.dpdu);
}

}  // namespace odis::render
