// What smooth and rough plastic share: a diffuse base under a dielectric coat.
#pragma once

#include "render/bsdf/fresnel.h"
#include "render/bsdf/parameter.h"

namespace odis::render {

struct PlasticBase {
  RgbParameter diffuse, specular;
  float eta = 1.5f;               // coat over air
  float internalReflectance = 0;  // hemispherical, of the coat seen from below
  bool nonlinear = false;         // whether light that is reflected inside is coloured again
  float specularWeight = 0.5f;    // share of the coat's reflectance in that of both

  void setWeight() {
    const float d = average(diffuse.mean()), s = average(specular.mean());
    specularWeight = d + s > 0 ? s / (d + s) : 0.5f;
  }

  // Radiosity of the base over the light that enters it, after any number of internal reflections.
  Rgb baseAlbedo(const SurfacePoint& at) const {
    const Rgb albedo = diffuse(at);
    if (!nonlinear) return albedo / (1 - internalReflectance);
    const auto escaped = [&](float a) { return a / (1 - a * internalReflectance); };
    return {escaped(albedo.x), escaped(albedo.y), escaped(albedo.z)};
  }

  // Probability of sampling the coat where it transmits `transmittance` of the light.
  float specularProbability(float transmittance) const {
    return reflectionProbability(transmittance, specularWeight);
  }

  BsdfFeatures features(const SurfacePoint& at, float transmittance, float alpha) const {
    const Rgb base = baseAlbedo(at) * (transmittance * (1 - internalReflectance));
    const Rgb coat = specular(at) * (1 - transmittance);
    return {clampUnit(base + coat), luminance(base) > luminance(coat) ? 1 : alpha};
  }
};

}  // namespace odis::render
