#include "render/integrator/path.h"

namespace odis::render {

namespace {

// Next-event estimation at a vertex.
struct LightEstimate {
  Rgb radiance{0, 0, 0};  // outgoing, without MIS weight: f |cos| Le / pdf
  Vec3 wiWorld{0, 0, 1};
  float lightPdf = 0;  // 0 where MIS does not apply
  BsdfValue bsdf;
};

// What of a vertex the choice among lights depends on.
LightReference lightReference(const SurfacePoint& at, const Vec3& wo) {
  return {at.p, wo.z < 0 ? -at.shading.n : at.shading.n, at.shape->bsdf().traits().transmissive};
}

LightEstimate sampleLight(const PathSettings& settings, const SurfacePoint& at, const Vec3& wo,
                          Sampler& sampler, RayCounts& counts) {
  LightEstimate result;
  const float uChoice = sampler.get1D();
  const Vec2 u = sampler.get2D();
  const LightSampler::Choice choice = settings.lights->sample(lightReference(at, wo), uChoice);
  if (!choice.emitter) return result;
  const EmitterSample light = choice.emitter->sample(choice.part, at.p, u);
  if (!(light.pdf > 0) || isBlack(light.radiance)) return result;
  result.wiWorld = light.wi;
  result.bsdf = at.shape->bsdf().evaluate(at, wo, at.shading.toLocal(light.wi));
  if (isBlack(result.bsdf.value)) return result;
  ++counts.shadowRays;
  if (settings.scene->occluded(Scene::spawn(at, light.wi, light.distance))) return result;
  result.radiance = result.bsdf.value * light.radiance / (light.pdf * choice.probability);
  result.lightPdf = light.delta ? 0 : light.pdf * choice.probability;
  return result;
}

// The directional guide at a vertex: the cell's map times the cosine, mixed with the BSDF.
class VertexGuide {
 public:
  VertexGuide(const PathSettings& settings, int depth, const SurfacePoint& at, const Vec3& wo) {
    if (!settings.guide || (settings.guideBounces >= 0 && depth > settings.guideBounces)) return;
    const Bsdf& bsdf = at.shape->bsdf();
    m_guidable = bsdf.guidableProbability(at, wo);
    if (!(m_guidable > 0)) return;
    const Vec3 normal = wo.z < 0 ? -at.shading.n : at.shading.n;
    const Cell* cell = settings.guide->find(toOdis(at.p), toOdis(normal));
    if (!cell) return;
    m_alpha = cell->alpha[int(materialClass(bsdf.features(at, wo).roughness))];
    if (m_alpha >= 1) return;
    m_map.prepare(cell->map, toOdis(normal), bsdf.traits().transmissive ? Sides::both : Sides::reflection);
    m_active = !m_map.empty();
  }

  bool active() const { return m_active; }
  // The density of the mixture in a direction whose BSDF densities are these.
  float pdf(float bsdfPdf, float guidablePdf, const Vec3& wiWorld) const {
    if (!m_active) return bsdfPdf;
    return mixturePdf(bsdfPdf, guidablePdf, m_guidable, m_alpha, m_map.pdf(toOdis(wiWorld)));
  }

  // Samples the mixture: draws from smooth lobes are replaced by draws from the map with probability 1 -
  // alpha, all others stay as they are.
  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, Sampler& sampler) const {
    const Bsdf& bsdf = at.shape->bsdf();
    const float uLobe = sampler.get1D();
    const Vec2 u = sampler.get2D();
    if (!m_active) return bsdf.sample(at, wo, uLobe, u);
    const float uChoice = sampler.get1D();
    const bool fromMap = uChoice >= m_alpha;
    BsdfSample result;
    if (!fromMap || m_guidable < 1) {
      result = bsdf.sample(at, wo, uLobe, u);
      if (isDiscrete(result.lobe)) return result;
    }
    if (fromMap && (m_guidable >= 1 || result.lobe != Lobe::nearDelta)) {
      const Float3 wi = m_map.sample(u.x, u.y).wi;
      result.wi = at.shading.toLocal(fromOdis(wi));
      const BsdfValue value = bsdf.evaluate(at, wo, result.wi);
      result.pdf = pdf(value.pdf, value.guidablePdf, fromOdis(wi));
      result.guidablePdf = value.guidablePdf;
      result.weight = value.value / result.pdf;
      result.eta = 1;
      result.lobe = isBlack(value.value) ? Lobe::none : Lobe::smooth;
    } else if (result.lobe != Lobe::none) {
      const float mixed = pdf(result.pdf, result.guidablePdf, at.shading.toWorld(result.wi));
      result.weight *= result.pdf / mixed;
      result.pdf = mixed;
    }
    return result;
  }

 private:
  bool m_active = false;
  float m_guidable = 0, m_alpha = 1;
  VertexMap m_map;
};

void describe(FirstHit& first, const SurfacePoint& at, const Vec3& wo, float distance) {
  const BsdfFeatures features = at.shape->bsdf().features(at, wo);
  const float side = wo.z < 0 ? -1.0f : 1.0f;
  first = {true, at.p, at.shading.n * side, at.ng * side, features.albedo, distance, features.roughness};
}

// What each vertex must remember until the path is complete.
struct Pending {
  Rgb weight;             // of the vertex: f |cos| / pdf / survival
  Rgb throughput;         // up to the vertex, it excluded
  Rgb emission{0, 0, 0};  // met by the vertex's direction, without MIS weight
  float emissionWeight = 0;
  uint64_t rays = 0;  // traced when the direction was sampled
};

// Fills what only the complete path knows: radiance from there on and the contributions to the pixel, from
// the last vertex back to the first.
void completeRecords(std::vector<PilotVertex>& vertices, size_t begin, const std::vector<Pending>& pending,
                     uint64_t raysTotal) {
  Rgb beyond(0, 0, 0);  // scattered towards this vertex by the next one
  for (size_t i = vertices.size(); i-- > begin;) {
    PilotVertex& v = vertices[i];
    const Pending& p = pending[i - begin];
    const Rgb arriving = p.emission * p.emissionWeight + beyond;
    v.radiance = {arriving.x, arriving.y, arriving.z};
    v.weight = {p.weight.x, p.weight.y, p.weight.z};
    v.indirect = luminance(p.throughput * p.weight * beyond);
    v.emission = luminance(p.throughput * p.weight * p.emission);
    v.raysAfter = float(raysTotal - p.rays);
    beyond = Rgb(v.direct.x, v.direct.y, v.direct.z) + p.weight * arriving;
  }
}

}  // namespace

PathResult tracePath(const PathSettings& settings, Ray ray, Sampler& sampler, RayCounts& counts,
                     std::vector<PilotVertex>* vertices, FirstHit* first) {
  const Scene& scene = *settings.scene;
  PathResult result;
  Rgb throughput(1, 1, 1);
  float eta = 1;            // product of the relative indices passed
  bool bySampling = false;  // whether the ray's direction competes with next-event estimation
  float directionPdf = 0;   // its density, if so
  LightReference previous;  // where it started
  float distance = 0;       // from the camera
  const size_t begin = vertices ? vertices->size() : 0;
  thread_local std::vector<Pending> pending;
  pending.clear();

  for (int depth = 1;; ++depth) {
    sampler.startVertex(depth);

    // Find the next vertex.
    SurfacePoint at;
    ++counts.rays;
    const bool hit = scene.intersect(ray, at);
    if (vertices && depth > 1) vertices->back().distance = hit ? length(at.p - ray.origin) : kInfinity;

    // Add the emission that the ray met, weighted against next-event estimation where that could have found
    // it too.
    const auto addEmission = [&](const Rgb& emission, const Emitter& emitter, uint32_t part,
                                 float emitterPdf) {
      if (isBlack(emission)) return;
      const float lightPdf =
          bySampling ? emitterPdf * settings.lights->probability(previous, emitter, part) : 0;
      const float weight = bySampling ? powerHeuristic(directionPdf, lightPdf) : 1;
      result.radiance += throughput * emission * weight;
      if (depth == 1) result.emitted += emission;
      if (vertices && depth > 1) {
        PilotVertex& v = vertices->back();
        Pending& p = pending.back();
        // Several environments may be met at once; the brightest decides what the selection probability is
        // told.
        if (luminance(emission) > luminance(p.emission)) v.emissionLightPdf = lightPdf;
        p.emissionWeight = (luminance(p.emission) * p.emissionWeight + luminance(emission) * weight) /
                           (luminance(p.emission) + luminance(emission));
        p.emission += emission;
      }
    };
    if (!hit) {
      for (const EnvironmentEmitter* environment : scene.environments())
        addEmission(environment->radiance(ray.direction), *environment, 0,
                    bySampling ? environment->pdf(previous.p, ray.direction) : 0);
      break;
    }
    if (const SurfaceEmitter* emitter = at.shape->emitter())
      addEmission(emitter->radiance(at, -ray.direction), *emitter, emitter->part(at),
                  bySampling ? emitter->pdf(previous.p, at) : 0);
    if (settings.maxDepth >= 0 && depth >= settings.maxDepth) break;

    const Bsdf& bsdf = at.shape->bsdf();
    const Vec3 wo = at.shading.toLocal(-ray.direction);
    distance += length(at.p - ray.origin);
    const VertexGuide guide(settings, depth, at, wo);

    // Next-event estimation, weighted against the mixture that directions are sampled from.
    LightEstimate light;
    Rgb direct(0, 0, 0);
    if (bsdf.traits().evaluable) {
      light = sampleLight(settings, at, wo, sampler, counts);
      if (!isBlack(light.radiance)) {
        const float mixed =
            light.lightPdf > 0 ? guide.pdf(light.bsdf.pdf, light.bsdf.guidablePdf, light.wiWorld) : 0;
        direct = light.radiance * (light.lightPdf > 0 ? powerHeuristic(light.lightPdf, mixed) : 1.0f);
        result.radiance += throughput * direct;
      }
    }

    // Sample where the path goes on.
    BsdfSample next = guide.sample(at, wo, sampler);
    if (!isFinite(next.weight)) next = {};
    if (first && !first->valid && !isDiscrete(next.lobe)) describe(*first, at, wo, distance);

    // Russian roulette by throughput, as Mitsuba plays it.
    Rgb weight = next.weight;
    const float etaAfter = eta * next.eta;
    const float uSurvival = sampler.get1D();
    float survival = 1;
    bool survives = next.lobe != Lobe::none && !isBlack(weight);
    if (survives && depth >= settings.rrDepth) {
      survival = std::min(maxComponent(throughput * weight) * sqr(etaAfter), 0.95f);
      survives = uSurvival < survival;
      weight = survives ? weight / survival : Rgb(0, 0, 0);
    }

    // Record the vertex.
    if (vertices) {
      PilotVertex& v = vertices->emplace_back();
      const Vec3 wiWorld = at.shading.toWorld(next.wi);
      v.position = toOdis(at.p);
      v.normal = toOdis(wo.z < 0 ? -at.shading.n : at.shading.n);
      v.wo = toOdis(-ray.direction);
      v.wi = toOdis(wiWorld);
      v.direct = {direct.x, direct.y, direct.z};
      v.pdf = next.pdf;
      v.survival = survival;
      v.guidablePdf = next.guidablePdf;
      v.guidableProbability = bsdf.guidableProbability(at, wo);
      v.distance = kInfinity;
      v.roughness = bsdf.features(at, wo).roughness;
      v.cosine = std::abs(next.wi.z);
      v.light = luminance(throughput * light.radiance);
      v.lightDirection = toOdis(light.wiWorld);
      v.lightPdf = light.lightPdf;
      v.lightBsdfPdf = light.bsdf.pdf;
      v.lightGuidablePdf = light.bsdf.guidablePdf;
      v.depth = uint16_t(std::min(depth, 0xffff));
      v.discrete = isDiscrete(next.lobe);
      v.both = bsdf.traits().transmissive;
      pending.push_back(
          {survives ? weight : Rgb(0, 0, 0), throughput, {0, 0, 0}, 0, counts.rays + counts.shadowRays});
    }
    if (!survives) break;

    throughput *= weight;
    eta = etaAfter;
    bySampling = !isDiscrete(next.lobe);
    directionPdf = next.pdf;
    previous = lightReference(at, wo);
    ray = Scene::spawn(at, at.shading.toWorld(next.wi));
  }
  if (vertices) completeRecords(*vertices, begin, pending, counts.rays + counts.shadowRays);
  return result;
}

}  // namespace odis::render
