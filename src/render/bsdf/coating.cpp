// coating: a smooth dielectric layer over any other BSDF, as varnish or clear lacquer.
//
//   int_ior, ext_ior       number or name, index of refraction of the layer and of the outside; "bk7", "air"
//   thickness              number >= 0, of the layer, in the inverse unit of sigma_a; 1
//   sigma_a                rgb or texture >= 0, absorption within the layer per unit of length; 0
//   specular_reflectance   rgb or texture, scales the reflection of the layer's interface; 1
//   (nested bsdf)          one
//
// The interface reflects on both sides, the nested BSDF scatters where it does without the layer. With equal
// indices and no absorption the nested BSDF alone is left.
#include "render/bsdf/coating_base.h"

#include "render/bsdf/factories.h"

namespace odis::render {
namespace {

class Coating final : public Bsdf {
 public:
  explicit Coating(CoatingBase base) : m_base(std::move(base)) {
    m_traits = m_base.nested->traits();
    m_traits.choosesLobes = true;
    m_traits.passesStraight = false;  // the layer refracts
  }

  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float uLobe, const Vec2& u) const override {
    const float entering = transmittance(wo), p = m_base.specularProbability(entering);
    if (uLobe < p)
      return discreteSample(reflect(wo), m_base.specular(at) * ((1 - entering) / p), p, Lobe::delta);
    BsdfSample result = m_base.sampleNested(at, wo, (uLobe - p) / (1 - p), u, 1 - p);
    result.weight *= entering * transmittance(result.wi);
    return result;
  }

  BsdfValue evaluate(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const override {
    const float entering = transmittance(wo);
    return m_base.evaluateNested(at, wo, wi, entering * transmittance(wi),
                                 1 - m_base.specularProbability(entering));
  }

  float guidableProbability(const SurfacePoint& at, const Vec3& wo) const override {
    const Vec3 o = m_base.inside(wo);
    if (o.z == 0) return 0;
    return m_base.nested->guidableProbability(at, o) * (1 - m_base.specularProbability(transmittance(wo)));
  }

  BsdfFeatures features(const SurfacePoint& at, const Vec3& wo) const override {
    return m_base.features(at, wo, transmittance(wo), 0);
  }

 private:
  float transmittance(const Vec3& w) const {
    return 1 - fresnelDielectric(std::abs(w.z), m_base.eta).reflectance;
  }

  CoatingBase m_base;
};

}  // namespace

CoatingBase readCoating(const Properties& properties, Builder& builder) {
  CoatingBase base;
  base.nested = builder.nestedBsdf(properties, 0);
  base.eta = readRelativeIor(properties, "bk7");
  base.thickness = properties.number("thickness", between(0, 1e10), 1.0f);
  base.sigmaA = RgbParameter(
      builder.texture(properties, "sigma_a", {"colour or texture", between(0, 1e10)}, Rgb(0.0f)));
  base.specular = readReflectance(properties, builder, "specular_reflectance", 1);
  const float passed = average(base.absorption(SurfacePoint(), Vec3(0, 0, 1), Vec3(0, 0, 1)));
  const float s = average(base.specular.mean());
  base.specularWeight = s + passed > 0 ? s / (s + passed) : 0.5f;
  return base;
}

BsdfPtr makeCoating(const Properties& properties, Builder& builder) {
  return std::make_shared<Coating>(readCoating(properties, builder));
}

}  // namespace odis::render
