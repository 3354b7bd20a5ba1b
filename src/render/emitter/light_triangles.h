// Samples of triangles that shine evenly, for several paths at once.
#pragma once

#include <array>

#include "render/emitter/emitter.h"
#include "render/math/columns.h"

namespace odis::render {

// What a sample of such a triangle is computed from: 64 bytes, a line of the cache.
struct alignas(64) LightTriangle {
  std::array<Vec3, 3> corners;  // world space
  Vec3 normal;                  // unit, on the side that it shines from
  float area;                   // that points are drawn evenly from: its own, or that of all in its part
  Rgb radiance;
};

// Up to kLanes samples. What find() finds of each is what the emitter's sample() does.
class LightTriangles {
 public:
  size_t size() const { return m_count; }
  // Adds a sample of a triangle, for u in [0, 1)^2, to be seen from `ref`.
  void add(const LightTriangle& triangle, const Vec2& u, const Vec3& ref) {
    m_triangles[m_count] = &triangle;
    m_u[m_count] = u.x;
    m_v[m_count] = u.y;
    m_ref.set(m_count, ref);
    ++m_count;
  }
  void find();
  EmitterSample operator[](size_t lane) const {
    return {.wi = m_wi[lane], .distance = m_distance[lane], .radiance = m_radiance[lane], .pdf = m_pdf[lane]};
  }

 private:
  static void findPoints(LightTriangles& of);

  size_t m_count = 0;
  std::array<const LightTriangle*, kLanes> m_triangles;
  Column m_u, m_v;
  Columns3 m_ref;
  // The triangles, in columns.
  Columns3 m_corners[3], m_normal, m_radiance;
  Column m_area;
  // What find() computes.
  Columns3 m_wi;
  Column m_distance, m_pdf;  // the latter zero behind the triangle
};

}  // namespace odis::render
