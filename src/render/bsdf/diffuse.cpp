// diffuse: an ideal Lambertian surface, one-sided.
//
//   reflectance   rgb or texture, 0.5   (also "diffuse_reflectance")
//
// f = reflectance / pi on the side of the normal, zero behind it.
#include "render/bsdf/factories.h"
#include "render/bsdf/parameter.h"
#include "render/math/warp.h"

namespace odis::render {
namespace {

class Diffuse final : public Bsdf {
 public:
  explicit Diffuse(RgbParameter reflectance) : m_reflectance(std::move(reflectance)) {
    m_traits.choosesLobes = false;
    m_sides[0] = {.reflectance = &m_reflectance, .side = 1};
    m_sides[1] = {.reflectance = &m_reflectance, .side = 0};
  }

  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float, const Vec2& u) const override {
    const Vec3 wi = squareToCosineHemisphere(u);
    const float pdf = cosineHemispherePdf(wi.z);
    if (!(wo.z > 0) || !(pdf > 0)) return {};
    return {wi, m_reflectance(at), pdf, pdf, 1, Lobe::smooth};
  }

  BsdfValue evaluate(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const override {
    if (!(wo.z > 0)) return {};
    const float pdf = cosineHemispherePdf(wi.z);  // 0 below the surface
    return {m_reflectance(at) * pdf, pdf, pdf};
  }

  float guidableProbability(const SurfacePoint&, const Vec3& wo) const override {
    return wo.z > 0 ? 1.0f : 0.0f;
  }
  BsdfFeatures features(const SurfacePoint& at, const Vec3&) const override {
    return {clampUnit(m_reflectance(at)), 1};
  }
  float roughness(const SurfacePoint&, const Vec3&) const override { return 1; }

 private:
  RgbParameter m_reflectance;
};

}  // namespace

BsdfPtr makeDiffuse(const Properties& properties, Builder& builder) {
  return std::make_shared<Diffuse>(readDiffuseReflectance(properties, builder));
}

}  // namespace odis::render
