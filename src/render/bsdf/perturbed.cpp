#include "render/bsdf/perturbed.h"

namespace odis::render {

PerturbationOptions readPerturbation(const Properties& properties) {
  return {properties.boolean("flip_invalid_normals", true),
          properties.boolean("use_shadowing_function", true)};
}

Perturbed::Perturbed(BsdfPtr nested, const PerturbationOptions& options)
    : m_nested(std::move(nested)), m_options(options) {
  m_traits = m_nested->traits();
  m_traits.tangents = true;
}

Perturbed::Turned Perturbed::turn(const SurfacePoint& at, const Vec3& wo) const {
  Vec3 n = normal(at);
  if (!isFinite(n)) n = Vec3(0, 0, 1);
  if (m_options.flipInvalidNormals && wo.z * dot(wo, n) <= 0) n = {-n.x, -n.y, n.z};
  Turned result{CoordinateFrame::fromTangent(n, tangent(at)), at, 0};
  const CoordinateFrame& local = result.frame;
  result.at.shading = {at.shading.toWorld(local.s), at.shading.toWorld(local.t), at.shading.toWorld(local.n)};
  if (m_options.useShadowing) {
    const float c2 = n.z * n.z;
    result.alpha2 = c2 > 0 ? std::min(0.125f * (1 - c2) / c2, 1.0f) : 1;
  }
  return result;
}

// "A Microfacet-Based Shadowing Function to Solve the Bump Terminator Problem", Ray Tracing Gems, chapter 12.
float Perturbed::shadowing(const Turned& turned, const Vec3& wi) const {
  if (turned.alpha2 == 0) return 1;
  const float c2 = std::max(wi.z * wi.z, 1e-12f);
  return 2 / (1 + std::sqrt(1 + turned.alpha2 * std::max(1 - c2, 0.0f) / c2));
}

BsdfSample Perturbed::sample(const SurfacePoint& at, const Vec3& wo, float uLobe, const Vec2& u) const {
  const Turned turned = turn(at, wo);
  BsdfSample result = m_nested->sample(turned.at, turned.frame.toLocal(wo), uLobe, u);
  if (result.lobe == Lobe::none) return result;
  const Vec3 wi = turned.frame.toWorld(result.wi);
  // What leaves one surface and enters the other would leak light.
  if (!(wi.z * result.wi.z > 0)) return {};
  result.wi = wi;
  result.weight *= shadowing(turned, wi);
  return result;
}

BsdfValue Perturbed::evaluate(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const {
  const Turned turned = turn(at, wo);
  const Vec3 turnedWi = turned.frame.toLocal(wi);
  if (!(wi.z * turnedWi.z > 0)) return {};
  BsdfValue result = m_nested->evaluate(turned.at, turned.frame.toLocal(wo), turnedWi);
  result.value *= shadowing(turned, wi);
  return result;
}

Rgb Perturbed::nullTransmission(const SurfacePoint& at, const Vec3& wo) const {
  if (!m_traits.passesStraight) return Rgb(0.0f);
  const Turned turned = turn(at, wo);
  const Vec3 turnedWo = turned.frame.toLocal(wo);
  if (!(wo.z * turnedWo.z > 0)) return Rgb(0.0f);
  return m_nested->nullTransmission(turned.at, turnedWo) * shadowing(turned, -wo);
}

float Perturbed::guidableProbability(const SurfacePoint& at, const Vec3& wo) const {
  const Turned turned = turn(at, wo);
  return m_nested->guidableProbability(turned.at, turned.frame.toLocal(wo));
}

BsdfFeatures Perturbed::features(const SurfacePoint& at, const Vec3& wo) const {
  const Turned turned = turn(at, wo);
  return m_nested->features(turned.at, turned.frame.toLocal(wo));
}

}  // namespace odis::render
