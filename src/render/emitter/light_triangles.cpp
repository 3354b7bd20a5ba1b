#include "render/emitter/light_triangles.h"

#include <odis/instruction_sets.h>

#include "render/math/warp.h"

namespace odis::render {

ODIS_WIDE void LightTriangles::findPoints(LightTriangles& of) {
  const auto& [c0, c1, c2] = of.m_corners;
  for (size_t i = 0, end = endOfLanes(of.m_count); i < end; ++i) {
    const Vec2 b = squareToTriangle({of.m_u[i], of.m_v[i]});
    const Vec3 d = c0[i] * (1 - b.x - b.y) + c1[i] * b.x + c2[i] * b.y - of.m_ref[i];
    const float squared = lengthSquared(d), distance = std::sqrt(squared);
    const Vec3 wi = d * (1 / distance);
    const float cosine = -dot(of.m_normal[i], wi), pdf = squared / (cosine * of.m_area[i]);
    of.m_wi.set(i, wi);
    of.m_distance[i] = distance;
    of.m_pdf[i] = cosine > 0 && pdf < kInfinity ? pdf : 0.0f;
  }
}

void LightTriangles::find() {
  static_assert(sizeof(LightTriangle) == 16 * sizeof(float));
  for (size_t first = 0; first < m_count; first += 4) {
    const auto row = [&](size_t number) {
      return [this, number](size_t lane) {
        return &m_triangles[std::min(lane, m_count - 1)]->corners[0].x + 4 * number;
      };
    };
    auto& [a, b, c] = m_corners;
    toColumns(first, row(0), a.x.of, a.y.of, a.z.of, b.x.of);
    toColumns(first, row(1), b.y.of, b.z.of, c.x.of, c.y.of);
    toColumns(first, row(2), c.z.of, m_normal.x.of, m_normal.y.of, m_normal.z.of);
    toColumns(first, row(3), m_area.of, m_radiance.x.of, m_radiance.y.of, m_radiance.z.of);
  }
  findPoints(*this);
}

}  // namespace odis::render
