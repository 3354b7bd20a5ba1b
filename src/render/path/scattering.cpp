#include "render/path/scattering.h"

#include <odis/guided_vertex.h>

#include <optional>

#include "render/emitter/moving_light.h"
#include "render/path/emission.h"
#include "render/path/guided_bsdf.h"
#include "render/scene/spawn.h"

namespace odis::render {

// Places up to this one draw from the path's sampler, whose points are stratified over the samples of a
// pixel. Paths that go on in media are longer than what that is good for, and independent numbers are
// cheaper.
constexpr int kStratifiedPlaces = 6;

VertexDraws::VertexDraws(Walker& walker) {
  const auto drawAll = [this](auto& numbers) {
    lightChoice = numbers.get1D();
    lightPoint = numbers.get2D();
    lobe = numbers.get1D();
    direction = numbers.get2D();
    survival = numbers.get1D();
    shadowRay = numbers.get1D();
  };
  if (walker.place > kStratifiedPlaces) {
    drawAll(walker.random);
  } else {
    walker.path->sampler.startVertex(walker.place);
    drawAll(walker.path->sampler);
  }
}

namespace {

// Rays that lead to vertices of this depth at most draw distances towards lamps, too: the camera's alone.
// What later ones would gain by it is less than what it costs (docs/experiments/0064-media.md).
constexpr int kDeepestPastLamps = 1;

// Draws a lamp that may light a segment of a ray, and a point of it. Nothing if a light infinitely far away
// is drawn. The choice depends on the ray alone.
std::optional<Vec3> drawLamp(const LightSampler& lights, const MediumSegment& segment, float time,
                             float reach, RandomStream& random) {
  LightReference middle{segment.at(std::min(0.5f * segment.length, reach)), Vec3(0, 0, 0), true};
  lights.prepare({&middle, 1});
  const float uChoice = random.get1D();
  const LightSampler::Choice choice = lights.sample(middle, uChoice, random.get2D());
  if (!choice.emitter || choice.emitter->partCount() == 0) return {};
  const EmitterSample light = sampleLightAt(time, *choice.emitter, choice.part, middle.p, choice.u);
  if (!(light.pdf > 0) || !(light.distance < kInfinity)) return {};
  return middle.p + light.wi * light.distance;
}

}  // namespace

Flight fly(const LightSampler* lights, Walker& walker, float length) {
  Path& path = *walker.path;
  const MediumSegment segment{path.ray.origin, path.ray.direction, length};
  float u;
  if (walker.place > kStratifiedPlaces) {
    u = walker.random.get1D();
  } else {
    path.sampler.startFlight(walker.place);
    u = path.sampler.get1D();
  }
  const Medium& medium = *walker.medium;
  const float reach = medium.meanFreePath();
  if (lights && walker.depth <= kDeepestPastLamps && reach > 0 && medium.samplesEmitters())
    if (const auto lamp = drawLamp(*lights, segment, path.ray.time, reach, walker.random))
      return medium.flyPast(*lamp, segment, path.throughput, u);
  return medium.fly(segment, path.throughput, u, walker.random);
}

bool passesStraight(const Vertex& vertex, Lobe lobe) {
  return lobe == Lobe::null && vertex.at.shape->bsdf().traits().passesStraight;
}

Rgb transmittanceTo(const Scene& scene, const ScatteringPoint& from, const Vec3& wi, float distance,
                    Walker& walker) {
  Rgb result(1.0f);
  const Medium* medium = from.mediumTowards(wi);
  Ray ray = from.spawn(wi, distance);
  float left = distance;
  while (true) {
    ++walker.path->counts.shadowRays;
    Hit hit;
    const bool met = scene.intersect(ray, hit);
    // Where something hides the light nothing else matters.
    if (met && !hit.shape->bsdf().traits().passesStraight) return Rgb(0.0f);
    SurfacePoint at;
    float length = left;
    if (met) {
      at = hit.surfacePoint(ray);
      length = render::length(at.p - ray.origin);
      result *= at.shape->bsdf().nullTransmission(at, at.shading.toLocal(-ray.direction));
      if (isBlack(result)) return result;
    }
    if (medium) result *= medium->transmittance({ray.origin, ray.direction, length}, walker.random);
    if (!met || isBlack(result)) return result;
    medium = at.shape->mediumBeyond(at, ray.direction, medium);
    left -= length;
    ray = Scene::spawn(at, ray.direction, left);
  }
}

namespace {

// A point as odis::Mixture asks for it.
struct PointHost {
  using Sample = BsdfSample;

  const ScatteringPoint& point;
  float uLobe;

  Sample sampleBsdf(float u, float v) const { return point.sample(uLobe, Vec2(u, v)); }
  bool isDiscrete(const Sample& sample) const { return odis::render::isDiscrete(sample.lobe); }
  bool isSharp(const Sample& sample) const { return sample.lobe == Lobe::nearDelta; }
  bool failed(const Sample& sample) const { return sample.lobe == Lobe::none; }

  template <class PdfOf>
  Sample evaluate(const Float3& wi, const PdfOf& pdfOf) const {
    const BsdfValue value = point.evaluate(fromOdis(wi));
    const float pdf = pdfOf(value.pdf, value.guidablePdf);
    return {fromOdis(wi),
            value.value / pdf,
            pdf,
            value.guidablePdf,
            1,
            isBlack(value.value) ? Lobe::none : Lobe::smooth};
  }
  template <class PdfOf>
  void reweigh(Sample& sample, const PdfOf& pdfOf) const {
    const float mixed = pdfOf(sample.pdf, sample.guidablePdf, toOdis(sample.wi));
    sample.weight *= sample.pdf / mixed;
    sample.pdf = mixed;
  }
};

const DirectionSampler* askRival(const DirectionGuide& rival, const ScatteringPoint& point) {
  if (point.surface()) return rival.at(point.position(), point.normal(), point.scattersBothSides());
  return rival.inMedium(point.position(), point.wo(), point.medium()->phase().meanCosine());
}

// What a scattering needs to know on its way.
class Scattering {
 public:
  Scattering(const PathSettings& settings, PathRecorder* recorder, Walker& walker,
             const ScatteringPoint& point)
      : m_settings(settings), m_recorder(recorder), m_walker(walker), m_path(*walker.path), m_point(point) {}

  bool take() {
    lookUp();
    if (endsInCache() || !survivesArrival()) return false;
    m_draws = VertexDraws(m_walker);
    prepareDirections();
    addDirectLight();
    sampleDirection();
    describeFirstHit();
    playOnDeparture();
    record();
    return depart();
  }

 private:
  float throughput() const { return luminance(m_path.throughput); }

  // Finds what the guide knows of the place.
  void lookUp() {
    m_reference = m_point.lightReference();
    if (!m_settings.guide || !guidesAt(m_settings, m_path)) return;
    const Place place{toOdis(m_point.position()),
                      toOdis(m_point.normal()),
                      m_path.identity.pixel,
                      m_path.identity.sample,
                      m_path.guidable == 0,
                      uint32_t(m_walker.depth),
                      m_point.surface() && !m_point.evaluable()};
    m_guided = GuidedVertex(*m_settings.guide, place, m_path.pixelValue);
    if (m_settings.learnedLights && m_guided.isKnown())
      m_reference.learned = learnedLights(*m_settings.guide, m_guided.cell());
  }

  // Ends the path with the cached radiance of the place, if the guide may.
  bool endsInCache() {
    if (!m_settings.guide || !m_settings.guide->cached || m_walker.depth == 1) return false;
    if (m_path.bySampling) {
      const Vertex* surface = m_point.surface();
      const float cosine = surface ? absDot(surface->at.shading.n, m_path.ray.direction) : 1;
      m_path.footprint += segmentFootprint(m_walker.travelled, m_path.directionPdf, cosine);
    }
    Float3 radiance;
    if (!m_guided.cachedRadiance(throughput(), m_path.footprint, radiance)) return false;
    if (m_point.surface() ? !scattersEvenly(*m_point.surface()) : m_point.roughness() < kLeastCachedRoughness)
      return false;
    m_path.radiance += m_path.throughput * Rgb(radiance.x, radiance.y, radiance.z);
    if (m_recorder) m_recorder->cached(m_path.handle, radiance);
    return true;
  }

  // Plays roulette by what is known to come back from here. Paths that end add the cell's mean outgoing
  // radiance, a control variate.
  bool survivesArrival() {
    if (!m_settings.learnedRoulette || !m_guided.isKnown() || m_walker.depth == 1) return true;
    const float survival = m_guided.survivalProbability(throughput(), 1);
    const bool survives = m_path.uSurvival < survival;
    const Float3 standIn = m_guided.standIn(survival, survives);
    m_path.radiance += m_path.throughput * Rgb(standIn.x, standIn.y, standIn.z);
    if (!survives) return false;
    m_path.throughput *= 1 / survival;
    if (!m_path.visible) m_path.visibleWeight /= survival;
    if (m_recorder) m_recorder->survived(m_path.handle, survival);
    return true;
  }

  // Finds out what directions are drawn from.
  void prepareDirections() {
    if (!m_settings.guide && !m_settings.rival && !m_recorder) return;
    m_guidable = m_point.guidableProbability();
    if (m_settings.rival && m_guidable > 0 && guidesAt(m_settings, m_path)) {
      m_rival = askRival(*m_settings.rival, m_point);
      if (m_rival) m_mixture = Mixture<float>(m_rival->bsdfFraction(), m_guidable);
    } else if (m_guided.isKnown()) {
      m_guided.prepare(m_point.roughness(), m_guidable);
    }
    m_path.guidable += m_guidable > 0;
  }
  // The density that directions are drawn with.
  float mixedPdf(const Vec3& wi, const BsdfValue& value) const {
    if (m_rival) return m_mixture.pdf(value.pdf, value.guidablePdf, m_rival->pdf(wi));
    return m_guided.pdf(toOdis(wi), value.pdf, value.guidablePdf);
  }

  // Next-event estimation.
  void addDirectLight() {
    if (!m_point.evaluable()) return;
    m_settings.lights->prepare({&m_reference, 1});
    const LightSampler::Choice choice =
        m_settings.lights->sample(m_reference, m_draws.lightChoice, m_draws.lightPoint);
    if (!choice.emitter) return;
    const EmitterSample light =
        sampleLightAt(m_point.time(), *choice.emitter, choice.part, m_point.position(), choice.u);
    if (!(light.pdf > 0) || isBlack(light.radiance)) return;
    const BsdfValue value = m_point.evaluate(light.wi);
    if (isBlack(value.value)) return;
    const float pdf = light.pdf * choice.probability;
    const Rgb radiance = value.value * light.radiance / pdf;
    const float weight = light.delta ? 1 : powerHeuristic(pdf, mixedPdf(light.wi, value));
    float asked = 1;
    if (m_settings.shadowRoulette && m_guided.isKnown()) {
      asked = m_guided.shadowRayProbability(luminance(m_path.throughput * radiance * weight));
      if (!(m_draws.shadowRay < asked)) return;
    }
    const Rgb seen = transmittanceTo(*m_settings.scene, m_point, light.wi, light.distance, m_walker) / asked;
    m_path.radiance += m_path.throughput * radiance * seen * weight;
    if (!m_recorder) return;
    LightEvent event;
    event.unweighted = toOdis(radiance * seen);
    event.weighted = toOdis(radiance * seen * weight);
    event.wi = toOdis(light.wi);
    event.pdf = light.delta ? 0 : pdf;
    event.bsdfPdf = value.pdf;
    event.guidablePdf = value.guidablePdf;
    event.group = choice.group;
    event.groupProbability = asked * choice.groupProbability();
    m_recorder->light(m_path.handle, event);
    if (isBlack(seen)) m_recorder->lightHidden(m_path.handle);
  }

  void sampleDirection() {
    const PointHost host{m_point, m_draws.lobe};
    const Vec2& u = m_draws.direction;
    m_next = m_rival ? m_mixture.sample(RivalMap{*m_rival}, u.x, u.y, host) : m_guided.sample(u.x, u.y, host);
    if (!isFinite(m_next.weight)) m_next = {};
    m_passes = m_point.surface() && passesStraight(*m_point.surface(), m_next.lobe);
  }

  void describeFirstHit() {
    if (!m_settings.features) return;
    m_path.visible |= !m_passes;
    if (m_path.first.valid || isDiscrete(m_next.lobe)) return;
    m_path.first = m_point.features(m_path.distance);
    if (!m_settings.guideFeatures || !m_guided.isKnown()) return;
    m_path.first.cell = m_guided.cell();
    m_path.first.map = SamplingMap<float>(m_settings.guide->maps, int32_t(m_guided.cell()));
    m_path.first.bsdfFraction = m_guided.bsdfFraction();
    if (m_settings.learnedRoulette) m_path.first.survival = m_guided.survivalProbability(throughput(), 1);
  }

  // Ends paths by their throughput where nothing was learned.
  void playOnDeparture() {
    m_survives = m_next.lobe != Lobe::none && !isBlack(m_next.weight);
    m_path.eta *= m_next.eta;
    m_path.uSurvival = m_draws.survival;
    const bool learned = m_settings.learnedRoulette && m_guided.isKnown();
    if (!m_survives) m_next.weight = Rgb(0.0f);
    if (m_walker.depth < m_settings.rrDepth || !m_survives || learned) return;
    m_survival = std::min(maxComponent(m_path.throughput * m_next.weight) * sqr(m_path.eta), 0.95f);
    if (m_settings.learnedRoulette) m_survival = std::max(m_survival, m_settings.guide->rules.leastSurvival);
    m_survives = m_path.uSurvival < m_survival;
    m_path.uSurvival /= m_survival;  // as good as new, should the path survive
    m_next.weight = m_survives ? m_next.weight / m_survival : Rgb(0.0f);
  }

  void record() {
    if (!m_recorder) return;
    BounceEvent event;
    event.wi = toOdis(m_next.wi);
    event.weight = toOdis(m_next.weight);
    event.pdf = m_next.pdf;
    event.guidablePdf = m_next.guidablePdf;
    event.guidableProbability = m_guidable;
    event.survival = m_survival;
    event.cosine = m_point.surface() ? absDot(m_next.wi, m_point.normal()) : 1;
    event.roughness = m_point.roughness();
    event.discrete = isDiscrete(m_next.lobe);
    event.scattersBothSides = m_point.scattersBothSides();
    m_recorder->bounce(m_path.handle, event);
  }

  bool depart() {
    if (!m_survives) return false;
    m_path.throughput *= m_next.weight;
    if (!m_path.visible) m_path.visibleWeight /= m_survival;
    m_path.ray = m_point.spawn(m_next.wi);
    m_walker.medium = m_point.mediumTowards(m_next.wi);
    m_walker.nextPlace();
    m_walker.travelled = 0;
    if (m_passes) return true;  // next-event estimation at the vertex before still competes
    ++m_walker.depth;
    m_path.hidesEnvironment = false;
    m_path.bySampling = !isDiscrete(m_next.lobe) && m_point.evaluable();
    m_path.directionPdf = m_next.pdf;
    m_path.previous = m_reference;
    return true;
  }

  const PathSettings& m_settings;
  PathRecorder* m_recorder;
  Walker& m_walker;
  Path& m_path;
  const ScatteringPoint& m_point;

  GuidedVertex m_guided;
  LightReference m_reference;
  VertexDraws m_draws;
  float m_guidable = 0;
  const DirectionSampler* m_rival = nullptr;
  Mixture<float> m_mixture;  // with the rival
  BsdfSample m_next;         // its direction in world space
  float m_survival = 1;      // probability with which roulette by throughput lets the path go on
  bool m_survives = true, m_passes = false;
};

}  // namespace

bool scatter(const PathSettings& settings, PathRecorder* recorder, Walker& walker,
             const ScatteringPoint& point) {
  return Scattering(settings, recorder, walker, point).take();
}

}  // namespace odis::render
