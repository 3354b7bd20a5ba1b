// Emission that rays meet, and its density under next-event estimation where the ray started.
#pragma once

#include "render/emitter/moving_light.h"
#include "render/math/columns.h"
#include "render/path/path.h"

namespace odis::render {

struct Emission {
  Rgb radiance;
  const Emitter& emitter;
  uint32_t part;
  float emitterPdf;  // solid-angle density with which the emitter would have been sampled, once it is chosen
  Vec2 u;            // of environments: the numbers that it would have been sampled with
};

// A ray that left the scene. `from` is where it started if next-event estimation competes with its direction,
// else null: densities are then 0.
struct Escape {
  const Ray* ray;
  const LightReference* from;
};

// Calls use(i, emission) for each environment that one of up to kLanes rays meets.
template <class Use>
void forEachEnvironment(const Scene& scene, std::span<const Escape> escapes, const Use& use) {
  std::array<EnvironmentView, kLanes> views;
  for (const EnvironmentEmitter* e : scene.environments()) {
    for (size_t i = 0; i < escapes.size(); ++i) {
      const auto& [ray, from] = escapes[i];
      views[i] = {.wi = ray->direction,
                  .asksPdf = from != nullptr,
                  .asksNumbers = from && from->learned.fraction > 0};
      if (e->motion()) viewMoving(ray->time, *e, views[i]);
    }
    if (!e->motion()) e->view({views.data(), escapes.size()});
    for (size_t i = 0; i < escapes.size(); ++i)
      use(i, Emission{views[i].radiance, *e, 0, views[i].pdf, views[i].u});
  }
}

// Calls use(emission) if the surface that a ray met shines. `from` as in an Escape.
template <class Use>
void ifShining(const Ray& ray, const SurfacePoint& at, const LightReference* from, const Use& use) {
  if (const SurfaceEmitter* e = at.shape->emitter())
    use(Emission{e->radiance(at, -ray.direction), *e, e->part(at), from ? pdfAt(*e, from->p, at) : 0, {}});
}

// The density with which next-event estimation at `from` gives the direction of the emission; 0 if it can't.
inline float lightPdf(const LightSampler& lights, const LightReference& from, const Emission& met) {
  return met.emitterPdf > 0 ? met.emitterPdf * lights.probability(from, met.emitter, met.part, met.u) : 0;
}

// Where the path's ray started, if next-event estimation competes with its direction; else null.
const LightReference* competitor(const Path& path);
// Adds emission that the path's ray met, weighted against next-event estimation where that could have found
// it too. `recorder` may be null.
void addEmission(const PathSettings& settings, PathRecorder* recorder, Path& path, const Emission& met);

// Smoother surfaces and phase functions of narrower peaks end no paths with cached radiance: what they
// scatter depends too much on the direction. The same is true of surfaces that scatter mostly by lobes that
// may not be guided.
inline constexpr float kLeastCachedRoughness = 0.3f, kLeastCachedGuidable = 0.5f;
// Whether paths may end on a surface.
bool scattersEvenly(const Vertex& vertex);

}  // namespace odis::render
