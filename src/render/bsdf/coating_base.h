// What smooth and rough coatings share: a layer of a dielectric over any other BSDF. Light is refracted on
// its way in and out, and absorbed within; what the interface reflects back to the nested BSDF is left out
// (Weidlich and Wilkie 2007, "Arbitrarily Layered Micro-Facet Surfaces"; Mitsuba 0.6).
#pragma once

#include "render/bsdf/fresnel.h"
#include "render/bsdf/parameter.h"

namespace odis::render {

struct CoatingBase {
  BsdfPtr nested;
  RgbParameter specular, sigmaA;
  float eta = 1.5f;  // layer over outside
  float thickness = 1;
  float specularWeight = 0.5f;  // share of the interface's reflectance in that of both

  // Within the layer, the direction that is `w` outside, on the same side; with z = 0 where there is none.
  Vec3 inside(const Vec3& w) const { return refracted(w, 1 / eta); }
  // The reverse; z = 0 at total internal reflection.
  Vec3 outside(const Vec3& w) const { return refracted(w, eta); }

  // Transmittance of the layer's inside along both directions, which are given within it.
  Rgb absorption(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const {
    const float path = thickness * (1 / std::abs(wo.z) + 1 / std::abs(wi.z));
    const Rgb sigma = sigmaA(at);
    const auto passed = [&](float s) { return s > 0 ? std::exp(-s * path) : 1.0f; };
    return {passed(sigma.x), passed(sigma.y), passed(sigma.z)};
  }

  // The nested BSDF seen through the layer, chosen with `probability`; the interface passes `transmittance`
  // on the way in and out together.
  BsdfValue evaluateNested(const SurfacePoint& at, const Vec3& wo, const Vec3& wi, float transmittance,
                           float probability) const {
    const Vec3 o = inside(wo), i = inside(wi);
    if (o.z == 0 || i.z == 0) return {};
    const BsdfValue under = nested->evaluate(at, o, i);
    const float density = wi.z / (eta * eta * i.z);  // solid angle inside over outside
    return {under.value * absorption(at, o, i) * (transmittance * density), under.pdf * density * probability,
            under.guidablePdf * density * probability};
  }

  // A sample of it, whose weight lacks the transmittance of the interface.
  BsdfSample sampleNested(const SurfacePoint& at, const Vec3& wo, float uLobe, const Vec2& u,
                          float probability) const {
    const Vec3 o = inside(wo);
    if (o.z == 0) return {};
    BsdfSample result = nested->sample(at, o, std::min(uLobe, kOneMinusEpsilon), u);
    if (result.lobe == Lobe::none) return result;
    const Vec3 i = result.wi;
    result.wi = result.lobe == Lobe::null ? -wo : outside(i);
    if (result.wi.z == 0) return {};
    result.weight *= absorption(at, o, i) / probability;
    const float density = isDiscrete(result.lobe) ? 1 : result.wi.z / (eta * eta * i.z);
    result.pdf *= density * probability;
    result.guidablePdf *= density * probability;
    return result;
  }

  // Probability of sampling the interface where it lets `transmittance` of the light pass.
  float specularProbability(float transmittance) const {
    return reflectionProbability(transmittance, specularWeight);
  }

  BsdfFeatures features(const SurfacePoint& at, const Vec3& wo, float transmittance, float alpha) const {
    const Rgb top = specular(at) * (1 - transmittance);
    const Vec3 o = inside(wo);
    if (o.z == 0) return {clampUnit(top), alpha};
    const BsdfFeatures under = nested->features(at, o);
    // The interface reflects back much of what a diffuse BSDF scatters, little of what a mirror does.
    const float diffuse = std::clamp(1 - fresnelDiffuseReflectance(1 / eta), 0.0f, 1.0f);
    const float leaving = lerp(under.roughness, transmittance, diffuse);
    const Rgb base = under.albedo * absorption(at, o, o) * (transmittance * leaving);
    return {clampUnit(base + top), luminance(base) > luminance(top) ? under.roughness : alpha};
  }

 private:
  static Vec3 refracted(const Vec3& w, float ratio) {
    const float z = safeSqrt(1 - ratio * ratio * (w.x * w.x + w.y * w.y));
    return {ratio * w.x, ratio * w.y, std::copysign(z, w.z)};
  }
};

// The parameters that both have; defined in coating.cpp.
CoatingBase readCoating(const Properties& properties, Builder& builder);

}  // namespace odis::render
