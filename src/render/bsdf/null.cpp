// null: no surface at all; light passes straight through. No parameters.
#include "render/bsdf/factories.h"
#include "render/bsdf/parameter.h"

namespace odis::render {
namespace {

class Null final : public Bsdf {
 public:
  Null() {
    m_traits = {false, true};
    m_traits.passesStraight = true;
  }

  BsdfSample sample(const SurfacePoint&, const Vec3& wo, float, const Vec2&) const override {
    return discreteSample(-wo, Rgb(1.0f), 1, Lobe::null);
  }
  BsdfValue evaluate(const SurfacePoint&, const Vec3&, const Vec3&) const override { return {}; }
  Rgb nullTransmission(const SurfacePoint&, const Vec3&) const override { return Rgb(1.0f); }
  float guidableProbability(const SurfacePoint&, const Vec3&) const override { return 0; }
  BsdfFeatures features(const SurfacePoint&, const Vec3&) const override { return {Rgb(1.0f), 0}; }
};

}  // namespace

BsdfPtr makeNull(const Properties&, Builder&) {
  return std::make_shared<Null>();
}

}  // namespace odis::render
