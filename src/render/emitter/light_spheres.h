// Samples of spheres that shine evenly, for several paths at once.
#pragma once

#include <ImathVec.h>

#include <array>

#include "render/emitter/light_triangles.h"

namespace odis::render {

// A sphere that shines outwards.
struct LightSphere {
  Imath::V3d center;  // world space
  double radius;
  Rgb radiance;
};

// The spheres that lanes sample.
class LightSpheres {
 public:
  bool empty() const { return m_lanes.empty(); }
  // A lane samples a sphere, for u in [0, 1)^2. In the order of the lanes.
  void set(size_t lane, const LightSphere& sphere, const Vec2& u);
  // Fills in what the emitters' sample() finds of these lanes, seen from `ref`. Returns those of them that
  // lie inside of their spheres, for which nothing is filled in.
  LaneList find(const Columns3& ref, LightSamples& samples) const;

 private:
  LaneList m_lanes;
  std::array<const LightSphere*, kLanes> m_spheres;
  std::array<Vec2, kLanes> m_numbers;
};

}  // namespace odis::render
