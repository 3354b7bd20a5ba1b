#include "render/integrator/path.h"

#include <new>
#include <numeric>

namespace odis::render {

namespace {

// Next-event estimation at a vertex, before it is known whether something hides the light.
struct LightEstimate {
  Rgb radiance{0, 0, 0};  // outgoing, without MIS weight: f |cos| Le / pdf
  Vec3 wi{0, 0, 1};       // world space
  float distance = 0;     // to the light
  float pdf = 0;          // 0 where MIS does not apply
  BsdfValue bsdf;
  uint32_t group = 0;  // of lights, that it was drawn from
};

// The shading normal on the side that the path came from; `wo` in the shading frame.
Vec3 facing(const SurfacePoint& at, const Vec3& wo) {
  return wo.z < 0 ? -at.shading.n : at.shading.n;
}

// How many numbers sampleLight() draws.
constexpr uint32_t kLightNumbers = 2;

LightEstimate sampleLight(const PathSettings& settings, const SurfacePoint& at, const Vec3& wo,
                          const LightReference& reference, Sampler& sampler) {
  LightEstimate result;
  const float uChoice = sampler.get1D();
  const Vec2 u = sampler.get2D();
  const LightSampler::Choice choice = settings.lights->sample(reference, uChoice, u);
  if (!choice.emitter) return result;
  const EmitterSample light = choice.emitter->sample(choice.part, at.p, choice.u);
  if (!(light.pdf > 0) || isBlack(light.radiance)) return result;
  result.group = choice.group;
  result.wi = light.wi;
  result.distance = light.distance;
  result.bsdf = at.shape->bsdf().evaluate(at, wo, at.shading.toLocal(light.wi));
  if (isBlack(result.bsdf.value)) return result;
  result.radiance = result.bsdf.value * light.radiance / (light.pdf * choice.probability);
  result.pdf = light.delta ? 0 : light.pdf * choice.probability;
  return result;
}

// Whether the directions of vertices this deep are guided at all.
bool guides(const PathSettings& settings, int depth) {
  return (settings.guide || settings.rival) && (settings.guideBounces < 0 || depth <= settings.guideBounces);
}

// The directional guide at a vertex, mixed with the BSDF: the cell's map times the cosine, or a rival's.
class VertexGuide {
 public:
  VertexGuide(const PathSettings& settings, int depth, const SurfacePoint& at, const Vec3& wo,
              const Cell* cell) {
    if (!guides(settings, depth) || (!settings.rival && (!cell || !cell->guidesAny()))) return;
    const Bsdf& bsdf = at.shape->bsdf();
    m_guidable = bsdf.guidableProbability(at, wo);
    if (!(m_guidable > 0)) return;
    const Vec3 normal = facing(at, wo);
    const Sides sides = bsdf.traits().transmissive ? Sides::both : Sides::reflection;
    if (settings.rival) {
      m_rival = settings.rival->at(at.p, normal, sides);
      if (m_rival) m_alpha = m_rival->bsdfShare();
      m_active = m_alpha < 1;
      return;
    }
    m_alpha = cell->alpha[int(materialClass(bsdf.roughness(at, wo)))];
    if (m_alpha >= 1) return;
    m_map.prepare(cell->map, toOdis(normal), sides);
    m_active = !m_map.empty();
  }

  float bsdfShare() const { return m_active ? m_alpha : 1; }
  // The density of the mixture in a direction whose BSDF densities are these.
  float pdf(float bsdfPdf, float guidablePdf, const Vec3& wiWorld) const {
    if (!m_active) return bsdfPdf;
    const float guidePdf = m_rival ? m_rival->pdf(wiWorld) : m_map.pdf(toOdis(wiWorld));
    return mixturePdf(bsdfPdf, guidablePdf, m_guidable, m_alpha, guidePdf);
  }

  // Samples the mixture: draws from smooth lobes are replaced by draws from the map with probability 1 -
  // alpha, all others stay as they are. One number decides and, stretched again, draws: the parts of a
  // stratified set stay stratified.
  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, Sampler& sampler) const {
    const Bsdf& bsdf = at.shape->bsdf();
    const float uLobe = sampler.get1D();
    Vec2 u = sampler.get2D();
    if (!m_active) return bsdf.sample(at, wo, uLobe, u);
    const bool fromMap = u.x >= m_alpha;
    u.x = fromMap ? std::min((u.x - m_alpha) / (1 - m_alpha), 0x1.fffffep-1f) : u.x / m_alpha;
    BsdfSample result;
    if (!fromMap || m_guidable < 1) {
      result = bsdf.sample(at, wo, uLobe, u);
      if (isDiscrete(result.lobe)) return result;
    }
    if (fromMap && (m_guidable >= 1 || result.lobe != Lobe::nearDelta)) {
      const VertexMap::Sample sample = m_rival ? m_rival->sample(u) : m_map.sample(u.x, u.y);
      result.wi = at.shading.toLocal(fromOdis(sample.wi));
      const BsdfValue value = bsdf.evaluate(at, wo, result.wi);
      result.pdf = mixturePdf(value.pdf, value.guidablePdf, m_guidable, m_alpha, sample.pdf);
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
  const DirectionSampler* m_rival = nullptr;
  VertexMap m_map;
};

void describe(FirstHit& first, const SurfacePoint& at, const Vec3& wo, float distance) {
  const BsdfFeatures features = at.shape->bsdf().features(at, wo);
  const float side = wo.z < 0 ? -1.0f : 1.0f;
  first.valid = true;
  first.position = at.p;
  first.normal = at.shading.n * side;
  first.geometricNormal = at.ng * side;
  first.albedo = features.albedo;
  first.depth = distance;
  first.roughness = features.roughness;
}

// What the guide decides in the cell; `throughput` relative to the pixel's value.
void describe(FirstHit& first, const PathSettings& settings, const Cell& cell, float bsdfShare,
              float throughput) {
  first.cell = &cell;
  first.cellIndex = settings.guide->indexOf(cell);
  first.bsdfShare = bsdfShare;
  first.survival = settings.learnedRoulette ? survivalProbability(cell, throughput) : 1;
}

// A recorded vertex, with what it must remember until its path is complete.
struct PendingRecord {
  PilotVertex vertex;
  uint32_t previous = 0;    // of the same path
  Rgb weight{0, 0, 0};      // of the vertex: f |cos| / pdf / survival
  Rgb throughput{0, 0, 0};  // up to the vertex, it excluded
  Rgb emission{0, 0, 0};    // met by the vertex's direction, without MIS weight
  float emissionWeight = 0;
  float survival = 1;  // with which roulette let the path go on when it arrived here
  uint64_t rays = 0;   // traced when the direction was sampled
};

// A shadow ray's errand: what to add to which path if nothing is in the way.
struct Errand {
  uint32_t path;
  Rgb radiance;
};

// Where a path's ray met a surface, if it did (else there is no shape).
struct Vertex {
  SurfacePoint at;
  Vec3 wo;  // towards where the path came from, in the shading frame
};

// What the paths of a batch share while they are traced; kept from batch to batch for its memory. 48 + 28 +
// 216 bytes a path and 28 + 16 a shadow ray.
struct Batch {
  std::vector<uint32_t> active;  // paths that have a ray to trace
  std::vector<Ray> rays;         // theirs
  std::vector<Hit> hits;         // what those met
  std::vector<Vertex> vertices;  // the same as points on surfaces
  std::vector<Place> places;     // and for the guide
  std::vector<const Cell*> cells;
  std::vector<Errand> errands;
  std::vector<Ray> shadowRays;
  std::vector<uint8_t> hidden;
  bool recording = false;
  std::vector<PendingRecord> records;  // of all paths, as they come
};

// Adds emission that the path's ray met, weighted against next-event estimation where that could have found
// it too. `emitterPdf` is the density with which the emitter would have been sampled there.
void addEmission(const PathSettings& settings, Path& path, Batch& batch, int depth, const Rgb& emission,
                 const Emitter& emitter, uint32_t part, float emitterPdf) {
  if (isBlack(emission)) return;
  const float lightPdf =
      path.bySampling && emitterPdf > 0
          ? emitterPdf * settings.lights->probability(path.previous, emitter, part, path.ray.direction)
          : 0;
  const float weight = path.bySampling ? powerHeuristic(path.directionPdf, lightPdf) : 1;
  path.radiance += path.throughput * emission * weight;
  if (depth == 1) {
    path.emitted += emission;
    path.emittedPdf = lightPdf;
    ++path.emissions;
  }
  if (!batch.recording || depth == 1) return;
  PendingRecord& p = batch.records[path.lastRecord];
  // Several environments may be met at once; the brightest decides what the selection probability is told.
  if (luminance(emission) > luminance(p.emission)) p.vertex.emissionLightPdf = lightPdf;
  p.emissionWeight = (luminance(p.emission) * p.emissionWeight + luminance(emission) * weight) /
                     (luminance(p.emission) + luminance(emission));
  p.emission += emission;
}

// Records the vertex, but for what only the complete path knows.
void record(const PathSettings& settings, Path& path, Batch& batch, const SurfacePoint& at, const Vec3& wo,
            const BsdfSample& next, const Rgb& weight, float arrival, float survival,
            const LightReference& reference, const LightEstimate& light, const Rgb& direct, float asked,
            int depth) {
  const Bsdf& bsdf = at.shape->bsdf();
  PendingRecord& p = batch.records.emplace_back();
  p.previous = path.lastRecord;
  p.weight = weight;
  p.throughput = path.throughput;
  p.survival = arrival;
  p.rays = path.counts.rays + path.counts.shadowRays;
  path.lastRecord = uint32_t(batch.records.size() - 1);
  ++path.recorded;
  PilotVertex& v = p.vertex;
  v.position = toOdis(at.p);
  v.normal = toOdis(facing(at, wo));
  v.wo = toOdis(-path.ray.direction);
  v.wi = toOdis(at.shading.toWorld(next.wi));
  v.direct = {direct.x, direct.y, direct.z};
  v.pdf = next.pdf;
  v.survival = survival;
  v.guidablePdf = next.guidablePdf;
  v.guidableProbability = bsdf.guidableProbability(at, wo);
  v.distance = kInfinity;
  v.roughness = bsdf.roughness(at, wo);
  v.cosine = std::abs(next.wi.z);
  v.light = luminance(path.throughput * light.radiance);
  if (!isBlack(direct)) {
    v.lightGroup = light.group;
    v.lightGroupProbability = asked * settings.lights->groupProbability(reference, light.group);
  }
  v.lightDirection = toOdis(light.wi);
  v.lightPdf = light.pdf;
  v.lightBsdfPdf = light.bsdf.pdf;
  v.lightGuidablePdf = light.bsdf.guidablePdf;
  v.depth = uint16_t(std::min(depth, 0xffff));
  v.discrete = isDiscrete(next.lobe);
  v.both = bsdf.traits().transmissive;
}

// Turns this bounce's hits into vertices, and finds the cells that guide them.
void findVertices(const PathSettings& settings, int depth, Batch& batch) {
  batch.vertices.resize(batch.hits.size());
  for (size_t i = 0; i < batch.hits.size(); ++i) {
    const Hit& hit = batch.hits[i];
    Vertex& vertex = batch.vertices[i];
    vertex.at.shape = hit.shape;
    if (!hit.shape) continue;
    new (&vertex.at) SurfacePoint(hit.shape->surfacePoint(batch.rays[i], hit.raw));  // without a copy
    vertex.wo = vertex.at.shading.toLocal(-batch.rays[i].direction);
  }

  batch.cells.assign(batch.hits.size(), nullptr);
  if (!settings.guide || !guides(settings, depth)) return;
  batch.places.clear();
  for (const Vertex& vertex : batch.vertices)
    batch.places.push_back(vertex.at.shape ? Place{toOdis(vertex.at.p), toOdis(facing(vertex.at, vertex.wo))}
                                           : Place{});
  settings.guide->find(batch.places, batch.cells);
}

// Takes a path to its next vertex: emission, next-event estimation, direction, roulette. Says whether there
// is a ray to go on with, which is then path.ray; what next-event estimation would add becomes an errand.
bool extend(const PathSettings& settings, Path& path, uint32_t index, const Vertex& vertex, const Cell* cell,
            int depth, Batch& batch) {
  Sampler& sampler = path.sampler;
  sampler.startVertex(depth);
  ++path.counts.rays;

  // A ray that leaves the scene meets the environment.
  const auto& [at, wo] = vertex;
  if (!at.shape) {
    for (const EnvironmentEmitter* environment : settings.scene->environments())
      addEmission(settings, path, batch, depth, environment->radiance(path.ray.direction), *environment, 0,
                  path.bySampling ? environment->pdf(path.previous.p, path.ray.direction) : 0);
    return false;
  }

  // Others meet a surface, which may emit.
  const float length = odis::render::length(at.p - path.ray.origin);
  if (batch.recording && depth > 1) batch.records[path.lastRecord].vertex.distance = length;
  if (const SurfaceEmitter* emitter = at.shape->emitter())
    addEmission(settings, path, batch, depth, emitter->radiance(at, -path.ray.direction), *emitter,
                emitter->part(at), path.bySampling ? emitter->pdf(path.previous.p, at) : 0);
  if (settings.maxDepth >= 0 && depth >= settings.maxDepth) return false;

  const Bsdf& bsdf = at.shape->bsdf();
  path.distance += length;

  // Learned Russian roulette asks what comes back from here, and has an answer for paths that end without one (a control
  // variate); the numbers are those of the vertex before.
  const bool learned = settings.learnedRoulette && cell;
  float arrival = 1;
  if (learned && depth > 1) {
    arrival = survivalProbability(*cell, luminance(path.throughput) / path.pixelValue);
    const Rgb expected = path.throughput * Rgb(cell->expected.x, cell->expected.y, cell->expected.z);
    if (path.uSurvival >= arrival) {
      path.radiance += expected;
      return false;
    }
    path.radiance += expected * (1 - 1 / arrival);
    path.throughput /= arrival;
  }
  const VertexGuide guide(settings, depth, at, wo, cell);

  // Next-event estimation, weighted against the mixture that directions are sampled from.
  LightReference reference = lightReference(at, wo);
  if (settings.learnedLights && cell) reference.learned = settings.guide->lights(*cell);
  LightEstimate light;
  Rgb direct(0, 0, 0);
  if (bsdf.traits().evaluable) {
    light = sampleLight(settings, at, wo, reference, sampler);
    if (!isBlack(light.radiance)) {
      const float mixed = light.pdf > 0 ? guide.pdf(light.bsdf.pdf, light.bsdf.guidablePdf, light.wi) : 0;
      direct = light.radiance * (light.pdf > 0 ? powerHeuristic(light.pdf, mixed) : 1.0f);
    }
  } else {
    sampler.skip(kLightNumbers);
  }

  // Sample where the path goes on.
  BsdfSample next = guide.sample(at, wo, sampler);
  if (!isFinite(next.weight)) next = {};
  if (settings.features && !path.first.valid && !isDiscrete(next.lobe)) {
    describe(path.first, at, wo, path.distance);
    if (cell && settings.guideFeatures)
      describe(path.first, settings, *cell, guide.bsdfShare(), luminance(path.throughput) / path.pixelValue);
  }

  // Where nothing was learned: Russian roulette by throughput, as Mitsuba plays it.
  Rgb weight = next.weight;
  const float eta = path.eta * next.eta;
  path.uSurvival = sampler.get1D();
  float survival = 1;
  bool survives = next.lobe != Lobe::none && !isBlack(weight);
  if (survives && depth >= settings.rrDepth && !learned) {
    survival = std::min(maxComponent(path.throughput * weight) * sqr(eta), 0.95f);
    survives = path.uSurvival < survival;
    path.uSurvival /= survival;  // as good as new, should the path survive
    weight /= survival;
  }

  // A shadow ray, though not always where the light would add little to the pixel.
  float asked = 1;
  if (!isBlack(direct)) {
    if (settings.shadowRoulette && cell)
      asked = shadowRayProbability(luminance(path.throughput * direct) / path.pixelValue);
    if (asked == 1 || sampler.get1D() < asked) {
      direct /= asked;
      light.radiance /= asked;
      ++path.counts.shadowRays;
      batch.errands.push_back({index, path.throughput * direct});
      batch.shadowRays.push_back(Scene::spawn(at, light.wi, light.distance));
    } else {
      direct = light.radiance = Rgb(0, 0, 0);
    }
  }

  if (!survives) weight = Rgb(0, 0, 0);
  if (batch.recording)
    record(settings, path, batch, at, wo, next, weight, arrival, survival, reference, light, direct, asked,
           depth);
  if (!survives) return false;

  path.throughput *= weight;
  path.eta = eta;
  path.bySampling = !isDiscrete(next.lobe);
  path.directionPdf = next.pdf;
  path.previous = reference;
  path.ray = Scene::spawn(at, at.shading.toWorld(next.wi));
  return true;
}

// Runs the errands of this bounce: adds the light that nothing hides, and tells records of what is hidden.
void addDirectLight(const Scene& scene, std::span<Path> paths, Batch& batch) {
  batch.hidden.resize(batch.errands.size());
  scene.occluded(batch.shadowRays, batch.hidden);
  for (size_t i = 0; i < batch.errands.size(); ++i) {
    Path& path = paths[batch.errands[i].path];
    if (!batch.hidden[i]) {
      path.radiance += batch.errands[i].radiance;
    } else if (batch.recording) {
      PilotVertex& v = batch.records[path.lastRecord].vertex;
      v.direct = {};
      v.light = v.lightPdf = 0;
    }
  }
  batch.errands.clear();
  batch.shadowRays.clear();
}

// Appends the vertices of a path, with what only the complete path knows: radiance from there on and the
// contributions to the pixel, from the last vertex back to the first.
void completeRecords(const Path& path, const Batch& batch, std::vector<PilotVertex>& records) {
  Rgb beyond(0, 0, 0);  // scattered towards this vertex by the next one
  const size_t first = records.size();
  records.resize(first + path.recorded);
  uint32_t from = path.lastRecord;
  for (size_t i = records.size(); i-- > first;) {
    const PendingRecord& p = batch.records[from];
    from = p.previous;
    PilotVertex& v = records[i] = p.vertex;
    const Rgb arriving = p.emission * p.emissionWeight + beyond;
    v.radiance = {arriving.x, arriving.y, arriving.z};
    v.weight = {p.weight.x, p.weight.y, p.weight.z};
    v.indirect = luminance(p.throughput * p.weight * beyond);
    v.emission = luminance(p.throughput * p.weight * p.emission);
    v.raysAfter = float(path.counts.rays + path.counts.shadowRays - p.rays);
    beyond = (Rgb(v.direct.x, v.direct.y, v.direct.z) + p.weight * arriving) / p.survival;
  }
}

}  // namespace

LightReference lightReference(const SurfacePoint& at, const Vec3& wo) {
  return {at.p, facing(at, wo), at.shape->bsdf().traits().transmissive};
}

// How many vertices before it is needed a cell is asked for: a few hundred nanoseconds each.
constexpr size_t kCellsAhead = 6;

void tracePaths(const PathSettings& settings, std::span<Path> paths, std::vector<PilotVertex>* records) {
  thread_local Batch batch;
  batch.recording = records != nullptr;
  batch.records.clear();
  batch.active.resize(paths.size());
  std::iota(batch.active.begin(), batch.active.end(), 0u);

  for (int depth = 1; !batch.active.empty(); ++depth) {
    batch.rays.clear();
    for (const uint32_t index : batch.active) batch.rays.push_back(paths[index].ray);
    batch.hits.resize(batch.rays.size());
    settings.scene->intersect(batch.rays, batch.hits);
    findVertices(settings, depth, batch);

    size_t left = 0;
    for (size_t i = 0; i < batch.active.size(); ++i) {
      if (const size_t ahead = i + kCellsAhead; ahead < batch.cells.size() && batch.cells[ahead])
        settings.guide->prefetch(*batch.cells[ahead]);
      const uint32_t index = batch.active[i];
      if (extend(settings, paths[index], index, batch.vertices[i], batch.cells[i], depth, batch))
        batch.active[left++] = index;
    }
    batch.active.resize(left);
    addDirectLight(*settings.scene, paths, batch);
  }
  if (records)
    for (const Path& path : paths) completeRecords(path, batch, *records);
}

}  // namespace odis::render
