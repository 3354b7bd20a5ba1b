#include "render/emitter/light_spheres.h"

#include <odis/instruction_sets.h>

#include "render/shape/sphere_cone.h"

namespace odis::render {

namespace {

struct alignas(64) DoubleColumn {
  double of[kLanes];
};

// Spheres in columns, those of the first lanes, and what they are sampled from.
struct Spheres {
  DoubleColumn x, y, z, radius;
  Columns3 ref;
  Column u, v;
};

// What samples find.
struct Found {
  Columns3 wi;
  Column distance, pdf;
  IntColumn isOutside;
  IntColumn isLit;  // whether the sphere's outside faces the reference
};

ODIS_WIDE void samplePoints(size_t count, const Spheres& of, Found& found) {
  for (size_t i = 0, end = endOfLanes(count); i < end; ++i) {
    const SphereCone cone({of.x.of[i], of.y.of[i], of.z.of[i]}, of.radius.of[i], of.ref[i]);
    const SphereSample sample = sampleSphere(cone, {of.u[i], of.v[i]});
    found.wi.set(i, sample.wi);
    found.distance[i] = sample.distance;
    found.pdf[i] = cone.pdf();
    found.isOutside[i] = cone.outside;
    const Vec3 normal(float(sample.normal.x), float(sample.normal.y), float(sample.normal.z));
    found.isLit[i] = dot(normal, -sample.wi) > 0;
  }
}

}  // namespace

void LightSpheres::set(size_t lane, const LightSphere& sphere, const Vec2& u) {
  m_spheres[m_lanes.count] = &sphere;
  m_numbers[m_lanes.count] = u;
  m_lanes.addIf(true, lane);
}

LaneList LightSpheres::find(const Columns3& ref, LightSamples& samples) const {
  Spheres spheres{};
  for (size_t k = 0; k < m_lanes.count; ++k) {
    const LightSphere& sphere = *m_spheres[k];
    spheres.x.of[k] = sphere.center.x;
    spheres.y.of[k] = sphere.center.y;
    spheres.z.of[k] = sphere.center.z;
    spheres.radius.of[k] = sphere.radius;
    spheres.ref.set(k, ref[m_lanes.lanes[k]]);
    spheres.u[k] = m_numbers[k].x;
    spheres.v[k] = m_numbers[k].y;
  }
  Found found;
  samplePoints(m_lanes.count, spheres, found);
  LaneList inside;
  for (size_t k = 0; k < m_lanes.count; ++k) {
    const size_t lane = m_lanes.lanes[k];
    inside.addIf(!found.isOutside[k], lane);
    if (!found.isOutside[k]) continue;
    samples.set(lane, {.wi = found.wi[k],
                       .distance = found.distance[k],
                       .radiance = found.isLit[k] ? m_spheres[k]->radiance : Rgb(0, 0, 0),
                       .pdf = found.pdf[k]});
  }
  return inside;
}

}  // namespace odis::render
