// Emission that rays meet, and its density under next-event estimation where the ray started.
#pragma once

#include "render/emitter/moving_light.h"
#include "render/path/path.h"

namespace odis::render {

struct Emission {
  Rgb radiance;
  const Emitter& emitter;
  uint32_t part;
  float emitterPdf;  // solid-angle density with which the emitter would have been sampled, once it is chosen
};

// Calls use(emission) for each emitter that a ray met: that of the surface at `at`, or the environments where
// the ray left the scene (null). `from` is where the ray started if next-event estimation competes with its
// direction, else null: the densities are then 0.
template <class Use>
void forEachEmission(const Scene& scene, const Ray& ray, const SurfacePoint* at, const LightReference* from,
                     const Use& use) {
  if (!at) {
    for (const EnvironmentEmitter* e : scene.environments()) {
      const auto [radiance, pdf] =
          from ? radianceAndPdfAt(ray.time, *e, from->p, ray.direction)
               : EnvironmentEmitter::RadianceAndPdf{radianceAt(ray.time, *e, ray.direction), 0};
      use(Emission{radiance, *e, 0, pdf});
    }
  } else if (const SurfaceEmitter* e = at->shape->emitter()) {
    use(Emission{e->radiance(*at, -ray.direction), *e, e->part(*at), from ? pdfAt(*e, from->p, *at) : 0});
  }
}

// The density with which next-event estimation at `from` gives a direction towards the emission; 0 if it
// can't.
inline float lightPdf(const LightSampler& lights, const LightReference& from, const Vec3& wi,
                      const Emission& met) {
  return met.emitterPdf > 0 ? met.emitterPdf * lights.probability(from, met.emitter, met.part, wi) : 0;
}

}  // namespace odis::render
