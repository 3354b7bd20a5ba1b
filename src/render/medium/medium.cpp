#include "render/medium/medium.h"

namespace odis::render {

namespace {

// The scattering within a medium. A phase function is normalized: its value is its density, for all of which
// directions may be guided.
class MediumBsdf final : public Bsdf {
 public:
  MediumBsdf(const Medium& medium, bool samplesEmitters) : m_medium(medium) {
    m_traits.evaluable = samplesEmitters;
    m_traits.transmissive = true;
  }

  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float uLobe, const Vec2& u) const override {
    const PhaseFunction::Sample drawn = m_medium.phase().sample({at.p, wo}, uLobe, u);
    if (!(drawn.pdf > 0)) return {};
    return {drawn.wi, Rgb(1.0f), drawn.pdf, drawn.pdf, 1, Lobe::smooth};
  }
  BsdfValue evaluate(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const override {
    const float pdf = m_medium.phase().pdf({at.p, wo}, wi);
    return {Rgb(pdf), pdf, pdf};
  }
  float guidableProbability(const SurfacePoint&, const Vec3&) const override { return 1; }
  BsdfFeatures features(const SurfacePoint& at, const Vec3& wo) const override {
    return {m_medium.albedo(at.p), roughness(at, wo)};
  }
  float roughness(const SurfacePoint&, const Vec3&) const override { return m_medium.phase().roughness(); }

 private:
  const Medium& m_medium;
};

}  // namespace

Medium::Medium(PhaseFunctionPtr phase, bool samplesEmitters)
    : m_phase(std::move(phase)), m_bsdf(std::make_unique<MediumBsdf>(*this, samplesEmitters)) {}

}  // namespace odis::render
