#include "render/rivals/restir_trace.h"

#include "render/emitter/moving_light.h"
#include "render/path/emission.h"

namespace odis::render {

namespace {

// Light drawn for a vertex: radiance / pdf, black if there is none or something hides it.
struct DrawnLight {
  Vec3 wi{0, 0, 1};
  Rgb radiance{0, 0, 0};
  float pdf = 0;  // 0 where MIS does not apply
};

DrawnLight drawLight(const PathSettings& settings, const SurfacePoint& at, const Vec3& wo, Sampler& sampler,
                     RayCounts& counts) {
  DrawnLight result;
  const float uChoice = sampler.get1D();
  const Vec2 u = sampler.get2D();
  if (!at.shape->bsdf().traits().evaluable) return result;
  const LightSampler::Choice choice = settings.lights->sample(lightReference(at, wo), uChoice, u);
  if (!choice.emitter) return result;
  const EmitterSample light = sampleLightAt(at.time, *choice.emitter, choice.part, at.p, choice.u);
  if (!(light.pdf > 0) || isBlack(light.radiance)) return result;
  ++counts.shadowRays;
  if (settings.scene->occluded(Scene::spawn(at, light.wi, light.distance))) return result;
  result.wi = light.wi;
  result.radiance = light.radiance / (light.pdf * choice.probability);
  result.pdf = light.delta ? 0 : light.pdf * choice.probability;
  return result;
}

// What of it the vertex scatters, weighted against sampling its BSDF.
Rgb scatteredLight(const SurfacePoint& at, const Vec3& wo, const DrawnLight& light) {
  if (isBlack(light.radiance)) return {0, 0, 0};
  const BsdfValue bsdf = at.shape->bsdf().evaluate(at, wo, at.shading.toLocal(light.wi));
  return bsdf.value * light.radiance * (light.pdf > 0 ? powerHeuristic(light.pdf, bsdf.pdf) : 1.0f);
}

// The path that a vertex starts in a sampled direction, of throughput one.
Path pathBeyond(const SurfacePoint& at, const Vec3& wo, const BsdfSample& next, const Sampler& numbers) {
  Path path(Scene::spawn(at, at.shading.toWorld(next.wi)), numbers);
  path.bySampling = !isDiscrete(next.lobe);
  path.directionPdf = next.pdf;
  path.previous = lightReference(at, wo);
  return path;
}

// Traces a path from a vertex on, as the path tracer does, as a function of nothing but where it starts:
// so it can be shared. The path's ray, and what competes with its direction, are set.
void traceBeyond(const PathSettings& settings, int depth, Path& path, RayCounts& counts) {
  PathSettings rest = settings;
  if (rest.maxDepth >= 0) rest.maxDepth -= depth;
  rest.rrDepth = std::max(1, rest.rrDepth - depth);
  tracePaths(rest, std::span(&path, 1));
  counts.rays += path.counts.rays;
  counts.shadowRays += path.counts.shadowRays;
}

// What competes with a ray's direction: next-event estimation where it started.
struct DirectionOrigin {
  bool bySampling = false;
  float pdf = 0;
  LightReference from;
  bool hidesEnvironment = false;
};

// Emission that a ray met (`at`: a surface, null: none), weighted against next-event estimation at its start.
Rgb emissionMet(const PathSettings& settings, const DirectionOrigin& origin, const Ray& ray,
                const SurfacePoint* at) {
  Rgb sum(0, 0, 0);
  if (!at && origin.hidesEnvironment) return sum;
  const LightReference* from = origin.bySampling ? &origin.from : nullptr;
  const auto add = [&](const Emission& met) {
    if (isBlack(met.radiance)) return;
    sum += met.radiance * (from ? powerHeuristic(origin.pdf, lightPdf(*settings.lights, *from, met)) : 1.0f);
  };
  if (at) {
    ifShining(ray, *at, from, add);
  } else {
    const Escape escape{&ray, from};
    forEachEnvironment(*settings.scene, {&escape, 1}, [&](size_t, const Emission& met) { add(met); });
  }
  return sum;
}

// Follows a direction that was drawn at x1 from a lobe that may be guided. Emission met there belongs to the
// pixel's direct light.
void findSample(const PathSettings& settings, const BsdfSample& drawn, Sampler& sampler,
                const Sampler& further, RestirPath& path) {
  const VisiblePoint& point = path.point;
  const int depth = point.depth + 1;
  const Rgb weight = point.throughput * drawn.weight;
  const Ray ray = Scene::spawn(point.at, point.at.shading.toWorld(drawn.wi));
  SecondaryPoint s;
  ++path.counts.rays;
  const bool hit = settings.scene->intersect(ray, s.at);
  const DirectionOrigin origin{true, drawn.pdf, lightReference(point.at, point.wo), false};
  path.radiance += weight * emissionMet(settings, origin, ray, hit ? &s.at : nullptr);
  if (!hit || (settings.maxDepth >= 0 && depth >= settings.maxDepth)) return;

  // Next-event estimation and a direction at x2; no roulette, whose chances would differ from pixel to pixel.
  sampler.startVertex(depth);
  const Bsdf& bsdf = s.at.shape->bsdf();
  const Vec3 wo = s.at.shading.toLocal(-ray.direction);
  const DrawnLight light = drawLight(settings, s.at, wo, sampler, path.counts);
  const float uLobe = sampler.get1D();
  BsdfSample next = bsdf.sample(s.at, wo, uLobe, sampler.get2D());
  if (!isFinite(next.weight)) next = {};
  const bool discrete = isDiscrete(next.lobe);
  s.wi = s.at.shading.toWorld(next.wi);
  Path beyond(ray, further);
  if (next.lobe != Lobe::none && !isBlack(next.weight)) {
    beyond = pathBeyond(s.at, wo, next, further);
    traceBeyond(settings, depth, beyond, path.counts);
  }

  // A direction that was not drawn from a density can't be taken over, nor one that met several emitters at
  // once, whose weights would have to be told apart.
  if (next.lobe == Lobe::none || discrete || !(next.pdf > 0) || beyond.emissions > 1) {
    path.radiance += weight * (scatteredLight(s.at, wo, light) + next.weight * beyond.radiance);
    return;
  }
  s.valid = true;
  s.back = wo.z < 0;
  s.lightDirection = light.wi;
  s.light = light.radiance;
  s.lightPdf = light.pdf;
  s.emission = beyond.emitted;
  s.emissionPdf = beyond.emittedPdf;
  const Rgb rest = beyond.radiance - beyond.emitted * powerHeuristic(next.pdf, beyond.emittedPdf);
  s.beyond = Rgb(std::max(rest.x, 0.0f), std::max(rest.y, 0.0f), std::max(rest.z, 0.0f));
  s.pdf = drawn.guidablePdf * next.pdf;
  path.sample = s;
}

}  // namespace

RestirPath traceRestirPath(const PathSettings& settings, const Ray& cameraRay, Sampler sampler,
                           const Sampler& further) {
  RestirPath path;
  Ray ray = cameraRay;
  Rgb throughput(1, 1, 1);
  float eta = 1;
  DirectionOrigin origin;
  origin.hidesEnvironment = settings.scene->integrator().hideEmitters;
  for (int depth = 1;; ++depth) {
    sampler.startVertex(depth);
    ++path.counts.rays;
    SurfacePoint at;
    const bool hit = settings.scene->intersect(ray, at);
    path.radiance += throughput * emissionMet(settings, origin, ray, hit ? &at : nullptr);
    if (!hit || (settings.maxDepth >= 0 && depth >= settings.maxDepth)) return path;

    const Bsdf& bsdf = at.shape->bsdf();
    const Vec3 wo = at.shading.toLocal(-ray.direction);
    const DrawnLight light = drawLight(settings, at, wo, sampler, path.counts);
    path.radiance += throughput * scatteredLight(at, wo, light);
    const float uLobe = sampler.get1D();
    BsdfSample next = bsdf.sample(at, wo, uLobe, sampler.get2D());
    if (!isFinite(next.weight)) next = {};
    const bool isFirst = bsdf.guidableProbability(at, wo) > 0;
    if (isFirst) path.point = {true, at, wo, throughput, depth};
    if (next.lobe == Lobe::none || isBlack(next.weight)) return path;

    // At x1, what smooth lobes scatter is up for sharing; all else goes on by itself.
    const LightReference from = lightReference(at, wo);
    if (isFirst) {
      if (next.lobe == Lobe::smooth) {
        findSample(settings, next, sampler, further, path);
      } else {
        Path beyond = pathBeyond(at, wo, next, further);
        beyond.hidesEnvironment = origin.hidesEnvironment && next.lobe == Lobe::null;
        traceBeyond(settings, depth, beyond, path.counts);
        path.radiance += throughput * next.weight * beyond.radiance;
      }
      return path;
    }

    // Russian roulette on the way to x1, as the path tracer plays it.
    const float uSurvival = sampler.get1D();
    throughput *= next.weight;
    eta *= next.eta;
    if (depth >= settings.rrDepth) {
      const float survival = std::min(maxComponent(throughput) * sqr(eta), 0.95f);
      if (!(uSurvival < survival)) return path;
      throughput /= survival;
    }
    origin = {!isDiscrete(next.lobe), next.pdf, from, origin.hidesEnvironment && next.lobe == Lobe::null};
    ray = Scene::spawn(at, at.shading.toWorld(next.wi));
  }
}

}  // namespace odis::render
