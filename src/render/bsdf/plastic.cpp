// plastic: a diffuse base under a perfectly smooth dielectric coat, one-sided.
//
//   int_ior, ext_ior       number or name, index of refraction of the coat and of the outside;
//                          "polypropylene", "air"
//   diffuse_reflectance    rgb or texture, of the base; 0.5
//   specular_reflectance   rgb or texture, scales the coat's reflection; 1
//   nonlinear              whether light reflected inside the coat takes on the base's colour every time;
//                          false
#include "render/bsdf/factories.h"
#include "render/bsdf/fresnel.h"
#include "render/bsdf/plastic_base.h"
#include "render/math/warp.h"

namespace odis::render {
namespace {

class Plastic final : public Bsdf {
 public:
  explicit Plastic(PlasticBase base) : m_base(std::move(base)) {}

  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float uLobe, const Vec2& u) const override {
    if (!(wo.z > 0)) return {};
    const float t = transmittance(wo);
    const float specularProbability = m_base.specularProbability(t);
    if (uLobe < specularProbability)
      return discreteSample(reflect(wo), m_base.specular(at) * ((1 - t) / specularProbability),
                            specularProbability, Lobe::delta);
    const Vec3 wi = squareToCosineHemisphere(u);
    return finishSample(wi, evaluate(at, wo, wi), Lobe::smooth);
  }

  BsdfValue evaluate(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const override {
    if (!(wo.z > 0) || !(wi.z > 0)) return {};
    const float t = transmittance(wo), cosinePdf = cosineHemispherePdf(wi.z);
    const float pdf = cosinePdf * (1 - m_base.specularProbability(t));
    return {m_base.baseAlbedo(at) * (cosinePdf * t * transmittance(wi) / sqr(m_base.eta)), pdf, pdf};
  }

  float guidableProbability(const SurfacePoint&, const Vec3& wo) const override {
    return wo.z > 0 ? 1 - m_base.specularProbability(transmittance(wo)) : 0;
  }

  BsdfFeatures features(const SurfacePoint& at, const Vec3& wo) const override {
    return m_base.features(at, transmittance(wo), 0);
  }

 private:
  float transmittance(const Vec3& w) const {
    return 1 - fresnelDielectric(std::abs(w.z), m_base.eta).reflectance;
  }

  PlasticBase m_base;
};

}  // namespace

BsdfPtr makePlastic(const Properties& properties, Builder& builder) {
  PlasticBase base;
  base.eta = readRelativeIor(properties, "polypropylene");
  base.internalReflectance = fresnelDiffuseReflectance(1 / base.eta);
  base.diffuse = readReflectance(properties, builder, "diffuse_reflectance", 0.5f);
  base.specular = readReflectance(properties, builder, "specular_reflectance", 1);
  base.nonlinear = properties.boolean("nonlinear", false);
  base.setWeight();
  return std::make_shared<Plastic>(std::move(base));
}

}  // namespace odis::render
