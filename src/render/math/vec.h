// Vectors, colours, matrices and frames of the renderer: Imath's types under the names that the field uses.
#pragma once

#include <ImathColor.h>
#include <ImathMatrix.h>
#include <ImathVec.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace odis::render {

using Vec2 = Imath::V2f;
using Vec2i = Imath::V2i;
using Vec3 = Imath::V3f;
using Rgb = Imath::C3f;
using Rgbd = Imath::Color3<double>;
// Imath multiplies row vectors: p' = p * M, so "A, then B" is A * B and the translation is in the last row.
using Matrix4 = Imath::M44f;

inline constexpr float kPi = std::numbers::pi_v<float>;
inline constexpr float kInvPi = std::numbers::inv_pi_v<float>;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
// The largest float below one: random numbers live in [0, kOneMinusEpsilon].
inline constexpr float kOneMinusEpsilon = 0x1.fffffep-1f;

inline float dot(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline float absDot(const Vec3& a, const Vec3& b) {
  return std::abs(dot(a, b));
}
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return a.cross(b);
}
inline float lengthSquared(const Vec3& v) {
  return dot(v, v);
}
inline float length(const Vec3& v) {
  return std::sqrt(dot(v, v));
}
[[gnu::always_inline]] inline Vec3 normalize(const Vec3& v) {
  return v * (1.0f / length(v));
}
inline float sqr(float x) {
  return x * x;
}
inline float safeSqrt(float x) {
  return std::sqrt(std::max(x, 0.0f));
}
inline float lerp(float t, float a, float b) {
  return a + t * (b - a);
}
// The nearest number within a range; `least` for what is not a number, which std::clamp() would hand on. To
// be used wherever the result becomes an integer or an index.
template <class Number>
[[gnu::always_inline]] inline Number limited(Number x, Number least, Number most) {
  return std::min(std::max(least, x), most);
}

// Relative luminance of linear Rec. 709 / sRGB primaries.
inline float luminance(const Rgb& c) {
  return 0.212671f * c.x + 0.715160f * c.y + 0.072169f * c.z;
}
inline float maxComponent(const Rgb& c) {
  return std::max(std::max(c.x, c.y), c.z);
}
inline float average(const Rgb& c) {
  return (c.x + c.y + c.z) * (1.0f / 3.0f);
}
// -1 on the back, 1 on the front; without a branch, which would be mispredicted wherever both sides are seen.
inline float signOfSide(bool back) {
  constexpr float kSigns[] = {1, -1};
  return kSigns[back];
}
inline bool isBlack(const Rgb& c) {
  return c.x == 0.0f && c.y == 0.0f && c.z == 0.0f;
}
// One of two vectors; without a branch where both are computed.
inline Vec3 select(bool first, const Vec3& a, const Vec3& b) {
  return {first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z};
}
inline bool isFinite(const Rgb& c) {
  return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}
inline bool isFinite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
inline Rgb lerp(float t, const Rgb& a, const Rgb& b) {
  return a + (b - a) * t;
}

inline Vec3 transformPoint(const Matrix4& m, const Vec3& p) {
  return p * m;
}
inline Vec3 transformVector(const Matrix4& m, const Vec3& v) {
  Vec3 result;
  m.multDirMatrix(v, result);
  return result;
}
// Transforms a normal by the inverse transpose; takes the inverse of the matrix that points are transformed
// by.
inline Vec3 transformNormal(const Matrix4& inverse, const Vec3& n) {
  return {n.x * inverse[0][0] + n.y * inverse[0][1] + n.z * inverse[0][2],
          n.x * inverse[1][0] + n.y * inverse[1][1] + n.z * inverse[1][2],
          n.x * inverse[2][0] + n.y * inverse[2][1] + n.z * inverse[2][2]};
}

// An orthonormal, right-handed frame. Local coordinates have the normal along z.
struct CoordinateFrame {
  Vec3 s{1, 0, 0}, t{0, 1, 0}, n{0, 0, 1};

  CoordinateFrame() = default;
  CoordinateFrame(const Vec3& s_, const Vec3& t_, const Vec3& n_) : s(s_), t(t_), n(n_) {}
  // Any frame about the unit normal (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
  explicit CoordinateFrame(const Vec3& normal) : n(normal) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    s = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
    t = {b, sign + n.y * n.y * a, -n.y};
  }
  // The frame about `normal` whose s is as near to `tangent` as it can be; any frame if the two are parallel.
  static CoordinateFrame fromTangent(const Vec3& normal, const Vec3& tangent) {
    const Vec3 s = tangent - normal * dot(normal, tangent);
    const float squared = lengthSquared(s);
    if (!(squared > 1e-12f * lengthSquared(tangent)) || !(squared > 0.0f)) return CoordinateFrame(normal);
    const Vec3 unit = s * (1.0f / std::sqrt(squared));
    return {unit, cross(normal, unit), normal};
  }

  Vec3 toLocal(const Vec3& v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
  Vec3 toWorld(const Vec3& v) const { return s * v.x + t * v.y + n * v.z; }
};

struct Ray {
  Vec3 origin;
  Vec3 direction;  // unit length
  float tMax = kInfinity;
  float time = 0;  // as a fraction of the time that the shutter is open
};

}  // namespace odis::render
