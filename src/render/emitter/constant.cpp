// constant: an environment of the same radiance in all directions.
//
//   radiance   rgb or number   W/(m^2 sr); default 1
//
// Directions are drawn uniformly from the sphere.
#include "render/emitter/constant.h"

#include "render/emitter/factories.h"
#include "render/math/warp.h"

namespace odis::render {

namespace {
constexpr float kSphereSolidAngle = 4 * kPi;
}

EmitterSample ConstantEnvironment::sample(uint32_t, const Vec3&, const Vec2& u) const {
  return {.wi = squareToSphere(u),
          .distance = kInfinity,
          .radiance = m_radiance,
          .pdf = 1 / kSphereSolidAngle,
          .delta = false};
}

Vec2 ConstantEnvironment::invert(const Vec3& wi) const {
  return sphereToSquare(wi);
}

float ConstantEnvironment::pdf(const Vec3&) const {
  return 1 / kSphereSolidAngle;
}

std::vector<EmitterPtr> makeConstant(const Properties& node, Builder&) {
  return {std::make_shared<ConstantEnvironment>(emission(node, "radiance"))};
}

}  // namespace odis::render
