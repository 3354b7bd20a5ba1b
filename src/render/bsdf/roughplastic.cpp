// roughplastic: a diffuse base under a rough dielectric coat, one-sided.
//
//   int_ior, ext_ior       number or name, index of refraction of the coat and of the outside;
//                          "polypropylene", "air"
//   diffuse_reflectance    rgb or texture, of the base; 0.5
//   specular_reflectance   rgb or texture, scales the coat's reflection; 1
//   nonlinear              whether light reflected inside the coat takes on the base's colour every time;
//                          false
//   distribution           "beckmann" (default) or "ggx"
//   alpha                  number, roughness of the coat; 0.1
//   sample_visible         whether to sample only facets that are visible; true
#include "render/bsdf/faceted.h"
#include "render/bsdf/factories.h"
#include "render/bsdf/plastic_base.h"

namespace odis::render {
namespace {

class RoughPlastic final : public FacetedBsdf {
 public:
  RoughPlastic(PlasticBase base, Microfacet::Type type, float alpha, bool sampleVisible,
               std::shared_ptr<const RoughTransmittance> transmittance)
      : FacetedBsdf(type, sampleVisible),
        m_base(std::move(base)),
        m_alpha(alpha),
        m_transmittance(std::move(transmittance)) {
    m_base.internalReflectance = m_transmittance->internalReflectance();
    m_base.setWeight();
  }

  FacetedSurface surface(const SurfacePoint& at, float cosO) const override {
    const float entering = m_transmittance->external(cosO);
    return {.alphaU = m_alpha,
            .alphaV = m_alpha,
            .specularProbability = m_base.specularProbability(entering),
            .specular = m_base.specular(at),
            .base = m_base.baseAlbedo(at),
            .entering = entering,
            .eta = m_base.eta,
            .transmittance = m_transmittance.get(),
            .type = type()};
  }
  BsdfFeatures features(const SurfacePoint& at, const Vec3& wo) const override {
    return m_base.features(at, m_transmittance->external(std::abs(wo.z)), std::min(m_alpha, 1.0f));
  }

 private:
  PlasticBase m_base;
  float m_alpha;
  std::shared_ptr<const RoughTransmittance> m_transmittance;
};

}  // namespace

BsdfPtr makeRoughPlastic(const Properties& properties, Builder& builder) {
  PlasticBase base;
  base.eta = readRelativeIor(properties, "polypropylene");
  if (base.eta == 1)
    throw SceneError(properties.location,
                     "\"int_ior\" and \"ext_ior\" of roughplastic are equal, expected two media");
  base.diffuse = readReflectance(properties, builder, "diffuse_reflectance", 0.5f);
  base.specular = readReflectance(properties, builder, "specular_reflectance", 1);
  base.nonlinear = properties.boolean("nonlinear", false);

  const RoughnessParameters roughness = readConstantRoughness(properties, builder);
  const float alpha = roughness.alphaU.mean();
  return std::make_shared<RoughPlastic>(std::move(base), roughness.type, alpha, roughness.sampleVisible,
                                        builder.roughTransmittance(roughness.type, alpha, base.eta));
}

}  // namespace odis::render
