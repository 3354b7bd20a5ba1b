#include "render/emitter/light_bounds.h"

namespace odis::render {

namespace {

struct Cone {
  Vec3 axis;
  float theta;
};

// The smallest cone around two, or all directions if it is wider than that.
Cone merged(const Cone& a, const Cone& b) {
  const float between = std::atan2(length(cross(a.axis, b.axis)), dot(a.axis, b.axis));
  if (std::min(between + b.theta, kPi) <= a.theta) return a;
  if (std::min(between + a.theta, kPi) <= b.theta) return b;
  const float theta = (a.theta + between + b.theta) / 2;
  const Vec3 across = b.axis - a.axis * dot(a.axis, b.axis);
  if (theta >= kPi || !(length(across) > 0)) return {a.axis, kPi};
  const float turn = theta - a.theta;
  return {normalize(a.axis * std::cos(turn) + normalize(across) * std::sin(turn)), theta};
}

}  // namespace

LightBounds merged(const LightBounds& a, const LightBounds& b) {
  LightBounds result = a;
  for (int i = 0; i < 3; ++i) {
    result.min[i] = std::min(a.min[i], b.min[i]);
    result.max[i] = std::max(a.max[i], b.max[i]);
  }
  const Cone cone = merged(Cone{a.axis, a.thetaO}, Cone{b.axis, b.thetaO});
  result.axis = cone.axis;
  result.thetaO = cone.theta;
  result.thetaE = std::max(a.thetaE, b.thetaE);
  result.phi = a.phi + b.phi;
  return result;
}

// The mean of max(0, cos) over the cap of half-angle thetaO.
float axialIntensity(float thetaO) {
  const float c = std::cos(thetaO);
  return c >= 0 ? (1 + c) / 2 : 0.5f / (1 - c);
}

float orientationMeasure(float thetaO, float thetaE) {
  const float thetaW = std::min(thetaO + thetaE, kPi);
  const float sinO = std::sin(thetaO), cosO = std::cos(thetaO);
  return 2 * kPi * (1 - cosO) +
         kPi / 2 * (2 * thetaW * sinO - std::cos(thetaO - 2 * thetaW) - 2 * thetaO * sinO + cosO);
}

}  // namespace odis::render
