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

// Samples of lights for several paths: EmitterSample, in columns.
struct LightSamples {
  Columns3 wi, radiance;
  Column distance, pdf;
  IntColumn delta;

  void set(size_t lane, const EmitterSample& sample) {
    wi.set(lane, sample.wi);
    radiance.set(lane, sample.radiance);
    distance[lane] = sample.distance;
    pdf[lane] = sample.pdf;
    delta[lane] = sample.delta;
  }
};

// The triangles that lanes sample.
class LightTriangles {
 public:
  LightTriangles();
  bool empty() const { return m_empty; }
  // A lane samples a triangle, for u in [0, 1)^2.
  void set(size_t lane, const LightTriangle& triangle, const Vec2& u) {
    m_triangles[lane] = &triangle;
    m_u[lane] = u.x;
    m_v[lane] = u.y;
    m_empty = false;
  }
  // What the emitters' sample() finds of the first `count` lanes, seen from `ref`. The density is 0 behind a
  // triangle and where a lane has none.
  void find(size_t count, const Columns3& ref, LightSamples& samples) const;

 private:
  bool m_empty = true;
  std::array<const LightTriangle*, kLanes> m_triangles;
  Column m_u{}, m_v{};
};

}  // namespace odis::render
