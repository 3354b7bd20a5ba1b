// conductor: a perfectly smooth metal, one-sided.
//
//   material               name of a metal ("Au", "Cu", ...) or "none", a perfect mirror; default "none"
//   eta, k                 rgb or texture, the complex index of refraction, instead of a material; 0 and 1
//   ext_eta                number or name, index of the surrounding medium that eta and k are divided by; 1
//   specular_reflectance   rgb or texture, scales the reflection; 1
#include "render/bsdf/factories.h"
#include "render/bsdf/fresnel.h"
#include "render/bsdf/parameter.h"

namespace odis::render {
namespace {

class Conductor final : public Bsdf {
 public:
  Conductor(ComplexIor ior, RgbParameter specular) : m_ior(std::move(ior)), m_specular(std::move(specular)) {
    m_traits.evaluable = m_traits.choosesLobes = false;
  }

  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float, const Vec2&) const override {
    if (!(wo.z > 0)) return {};
    return discreteSample(reflect(wo), m_ior.reflectance(at, wo.z) * m_specular(at), 1, Lobe::delta);
  }
  BsdfValue evaluate(const SurfacePoint&, const Vec3&, const Vec3&) const override { return {}; }
  float guidableProbability(const SurfacePoint&, const Vec3&) const override { return 0; }
  BsdfFeatures features(const SurfacePoint& at, const Vec3& wo) const override {
    return {clampUnit(m_ior.reflectance(at, std::abs(wo.z)) * m_specular(at)), 0};
  }

 private:
  ComplexIor m_ior;
  RgbParameter m_specular;
};

}  // namespace

BsdfPtr makeConductor(const Properties& properties, Builder& builder) {
  return std::make_shared<Conductor>(readComplexIor(properties, builder),
                                     readReflectance(properties, builder, "specular_reflectance", 1));
}

}  // namespace odis::render
