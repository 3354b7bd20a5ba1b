// polarizer, circular, retarder: thin optical elements that light passes straight through. Light is not
// polarised here: either polarizer passes half of it, a retarder all of it, as in Mitsuba's unpolarised
// variants.
//
//   transmittance   rgb or texture, scales what passes; 1
//   theta           number or texture, degrees, of the axis (polarizer, retarder); changes nothing
//   delta           number or texture, degrees, of the phase (retarder); changes nothing
//   polarizing      boolean (polarizer), left_handed boolean (circular); change nothing
#include "render/bsdf/factories.h"
#include "render/bsdf/parameter.h"

namespace odis::render {
namespace {

class OpticalElement final : public Bsdf {
 public:
  OpticalElement(RgbParameter transmittance, float share)
      : m_transmittance(std::move(transmittance)), m_share(share) {
    m_traits = {false, true};
    m_traits.passesStraight = true;
  }

  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float, const Vec2&) const override {
    return discreteSample(-wo, m_transmittance(at) * m_share, 1, Lobe::null);
  }
  BsdfValue evaluate(const SurfacePoint&, const Vec3&, const Vec3&) const override { return {}; }
  Rgb nullTransmission(const SurfacePoint& at, const Vec3&) const override {
    return m_transmittance(at) * m_share;
  }
  float guidableProbability(const SurfacePoint&, const Vec3&) const override { return 0; }
  BsdfFeatures features(const SurfacePoint& at, const Vec3&) const override {
    return {m_transmittance(at) * m_share, 0};
  }

 private:
  RgbParameter m_transmittance;
  float m_share;  // of unpolarised light
};

BsdfPtr makeElement(const Properties& properties, Builder& builder, float share) {
  return std::make_shared<OpticalElement>(readReflectance(properties, builder, "transmittance", 1), share);
}

}  // namespace

BsdfPtr makePolarizer(const Properties& properties, Builder& builder) {
  readScalar(properties, builder, "theta", kAnyNumber, 0);
  properties.boolean("polarizing", true);
  return makeElement(properties, builder, 0.5f);
}

BsdfPtr makeCircularPolarizer(const Properties& properties, Builder& builder) {
  properties.boolean("left_handed", false);
  return makeElement(properties, builder, 0.5f);
}

BsdfPtr makeRetarder(const Properties& properties, Builder& builder) {
  readScalar(properties, builder, "theta", kAnyNumber, 0);
  readScalar(properties, builder, "delta", kAnyNumber, 90);
  return makeElement(properties, builder, 1);
}

}  // namespace odis::render
