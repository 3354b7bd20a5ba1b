#include "render/emitter/light_triangles.h"

#include <odis/instruction_sets.h>

#include "render/math/warp.h"
#include "render/shape/surface_math.h"

namespace odis::render {

namespace {

// Without area, so that no density is finite.
const LightTriangle kNoTriangle{
    {Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0)}, Vec3(0, 0, 0), 0, Rgb(0, 0, 0)};

// Triangles in columns.
struct Triangles {
  Columns3 corners[3], normal;
  Column area;
};

ODIS_WIDE void samplePoints(size_t count, const Triangles& of, const Column& u, const Column& v,
                            const Columns3& ref, LightSamples& samples) {
  const auto& [c0, c1, c2] = of.corners;
  for (size_t i = 0, end = endOfLanes(count); i < end; ++i) {
    const Vec2 b = squareToTriangle({u[i], v[i]});
    const Vec3 d = pointOnTriangle(c0[i], c1[i], c2[i], b) - ref[i];
    const float squared = lengthSquared(d), distance = std::sqrt(squared);
    const Vec3 wi = d * (1 / distance);
    const float cosine = -dot(of.normal[i], wi), pdf = squared / (cosine * of.area[i]);
    samples.wi.set(i, wi);
    samples.distance[i] = distance;
    samples.pdf[i] = cosine > 0 && pdf < kInfinity ? pdf : 0.0f;
    samples.delta[i] = 0;
  }
}

}  // namespace

LightTriangles::LightTriangles() {
  m_triangles.fill(&kNoTriangle);
}

void LightTriangles::find(size_t count, const Columns3& ref, LightSamples& samples) const {
  static_assert(sizeof(LightTriangle) == 16 * sizeof(float));
  Triangles triangles;
  for (size_t first = 0; first < count; first += 4) {
    const auto row = [&](size_t number) {
      return [this, number](size_t lane) { return &m_triangles[lane]->corners[0].x + 4 * number; };
    };
    auto& [a, b, c] = triangles.corners;
    Columns3 &normal = triangles.normal, &radiance = samples.radiance;
    toColumns(first, row(0), a.x.of, a.y.of, a.z.of, b.x.of);
    toColumns(first, row(1), b.y.of, b.z.of, c.x.of, c.y.of);
    toColumns(first, row(2), c.z.of, normal.x.of, normal.y.of, normal.z.of);
    toColumns(first, row(3), triangles.area.of, radiance.x.of, radiance.y.of, radiance.z.of);
  }
  samplePoints(count, triangles, m_u, m_v, ref, samples);
}

}  // namespace odis::render
