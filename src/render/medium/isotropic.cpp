// isotropic: scatters evenly to all sides. No parameters.
#include "render/math/warp.h"
#include "render/medium/volume_factories.h"

namespace odis::render {
namespace {

class Isotropic final : public PhaseFunction {
 public:
  Sample sample(const MediumPoint&, float, const Vec2& u) const override {
    return {squareToSphere(u), kInvPi / 4};
  }
  float pdf(const MediumPoint&, const Vec3&) const override { return kInvPi / 4; }
};

}  // namespace

PhaseFunctionPtr makeIsotropic(const Properties&, Builder&) {
  return std::make_shared<Isotropic>();
}

}  // namespace odis::render
