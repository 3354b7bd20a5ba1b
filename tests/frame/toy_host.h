// A host of odis::Frame in a hundred lines: a path tracer with next-event estimation, multiple importance
// sampling and everything that a guide decides.
#pragma once

#include <odis/odis.hpp>

#include "frame/toy_room.h"
#include "odis/events.h"

namespace odis::test {

// Independent random numbers: a function of (seed, pixel, sample) and of how many were drawn.
class ToyNumbers {
 public:
  ToyNumbers(uint64_t seed, uint32_t pixel, uint32_t sample)
      : m_state(mix(mix(seed * 0x9e3779b97f4a7c15ull + pixel) + sample)) {}
  float next() {
    m_state += 0x9e3779b97f4a7c15ull;
    return float(mix(m_state) >> 40) * 0x1p-24f;
  }

 private:
  static uint64_t mix(uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
  }
  uint64_t m_state;
};

// A diffuse BSDF or, where the normal is zero, an isotropic phase function, as Mixture asks for it. World
// space.
struct ToyBsdf {
  struct Sample {
    Float3 wi;
    float pdf = 0, weight = 0;  // weight: albedo * cos / pi / pdf, 1 / (4 pi) / pdf in fog
  };
  Float3 normal;
  float albedo;

  bool isPhase() const { return isZero(normal); }
  float density(const Float3& wi) const {
    return isPhase() ? 1 / (4 * kPi) : std::max(dot(wi, normal), 0.0f) / kPi;
  }
  Sample sampleBsdf(float u, float v) const {
    if (isPhase()) {
      const float z = 1 - 2 * u, r = std::sqrt(std::max(1 - z * z, 0.0f));
      const Float3 wi{r * std::cos(2 * kPi * v), r * std::sin(2 * kPi * v), z};
      return {wi, density(wi), albedo};
    }
    const Float3 tangent = std::abs(normal.x) > 0.5f ? Float3{0, 1, 0} : Float3{1, 0, 0};
    Float3 s = tangent - normal * dot(tangent, normal);
    s = s / lengthOf(s);
    const Float3 t{normal.y * s.z - normal.z * s.y, normal.z * s.x - normal.x * s.z,
                   normal.x * s.y - normal.y * s.x};
    const float r = std::sqrt(u), phi = 2 * kPi * v;
    const Float3 wi =
        s * (r * std::cos(phi)) + t * (r * std::sin(phi)) + normal * std::sqrt(std::max(1 - u, 1e-6f));
    return {wi, density(wi), albedo};
  }
  bool isDiscrete(const Sample&) const { return false; }
  bool isSharp(const Sample&) const { return false; }
  bool failed(const Sample& sample) const { return !(sample.weight > 0); }
  template <class PdfOf>
  Sample evaluate(const Float3& wi, const PdfOf& pdfOf) const {
    const float bsdf = density(wi), pdf = pdfOf(bsdf, bsdf);
    return {wi, pdf, albedo * bsdf / pdf};
  }
  template <class PdfOf>
  void reweigh(Sample& sample, const PdfOf& pdfOf) const {
    const float pdf = pdfOf(sample.pdf, sample.pdf, sample.wi);
    sample.weight *= sample.pdf / pdf;
    sample.pdf = pdf;
  }
};

// What a sample has beside its value, for a film with AOVs and groups of lights.
struct ToySight {
  float x = 0, y = 0;                    // its place in the image, in pixels
  float distance = 0;                    // to the first surface
  Float3 normal;                         // there
  float byLamp[2] = {}, otherLight = 0;  // parts of the value
};

class ToyHost {
 public:
  static constexpr uint32_t kMaxDepth = 5;

  ToyHost(const ToyRoom& room, uint32_t width, uint32_t height)
      : m_room(room), m_width(width), m_height(height) {}

  // Traces one sample of the pass and records its vertices; `sight`, if it is given, receives the rest.
  FrameSample trace(const FramePass& pass, uint32_t pixel, uint32_t sample, PathRecorder& recorder,
                    ToySight* sight = nullptr) const {
    State s{pass,  recorder, ToyNumbers(pass.seed, pixel, sample), recorder.begin({pixel, sample}),
            pixel, sample};
    s.sight.x = float(pixel % m_width) + s.numbers.next();
    s.sight.y = float(pixel / m_width) + s.numbers.next();
    const float x = s.sight.x / float(m_width) - 0.5f, y = 0.5f - s.sight.y / float(m_height);
    s.origin = {0.5f, 0.01f, 0.5f};
    s.direction = Float3{x, 0.6f, y} / lengthOf({x, 0.6f, y});
    for (s.depth = 1; s.depth <= kMaxDepth && extend(s); ++s.depth) {
    }
    if (sight) *sight = s.sight;
    return {pixel, sample, gray(s.radiance), s.rays};
  }

 private:
  struct State {
    const FramePass& pass;
    PathRecorder& recorder;
    ToyNumbers numbers;
    uint32_t path, pixel, sample;
    float throughput = 1, radiance = 0;
    float pdf = 0;        // of the ray's direction
    GuidedVertex vertex;  // that the ray left
    Float3 origin, direction;
    uint32_t depth = 1;
    uint32_t rays = 0;
    ToySight sight;
  };
  // Adds to a sample's value what a lamp brings, or anything else (-1).
  static void bring(State& s, float radiance, int lamp = -1) {
    s.radiance += radiance;
    (lamp < 0 ? s.sight.otherLight : s.sight.byLamp[lamp]) += radiance;
  }
  // The density, with respect to solid angle, of a point on a lamp.
  float lampPdf(const Float3& to) const {
    return dot(to, to) * lengthOf(to) / (m_room.lampSize * m_room.lampSize * std::max(to.z, 1e-6f));
  }

  // Lets fog scatter the path before it hits: distances are drawn too far, so that there is a weight. The hit
  // is in the fog then, without a normal and without emission.
  void fly(State& s, ToyRoom::Hit& hit) const {
    const float rate = 0.75f * m_room.extinction;
    const float distance = -std::log(1 - s.numbers.next()) / rate;
    const bool scattered = distance < hit.distance;
    if (scattered) {
      hit = {};
      hit.position = s.origin + s.direction * distance;
      hit.distance = distance;
    }
    const float longer = m_room.transmittance(hit.distance) / std::exp(-rate * hit.distance);
    const float weight = scattered ? longer * m_room.fogAlbedo * m_room.extinction / rate : longer;
    s.throughput *= weight;
    s.recorder.attenuation(s.path, gray(weight));
  }

  // One bounce; false where the path ends.
  bool extend(State& s) const {
    ToyRoom::Hit hit = m_room.intersect(s.origin, s.direction);
    ++s.rays;
    if (m_room.extinction > 0) fly(s, hit);
    const bool inFog = isZero(hit.normal);
    if (s.depth == 1) s.sight.distance = hit.distance, s.sight.normal = hit.normal;
    if (inFog)
      s.recorder.medium(s.path, mediumEvent(hit.position, s.direction * -1.0f, hit.distance));
    else
      s.recorder.surface(s.path, surfaceEvent(hit.position, hit.normal, s.direction * -1.0f, hit.distance));
    if (hit.emission.x > 0) {
      const float lightPdf =
          s.depth > 1 && hit.lamp >= 0
              ? lampPdf(hit.position - s.origin) * s.vertex.lightProbability(uint32_t(hit.lamp), 0.5f)
              : 0;
      const float weight = s.depth > 1 ? powerHeuristic(s.pdf, lightPdf) : 1;
      bring(s, s.throughput * hit.emission.x * weight, hit.lamp);
      s.recorder.emission(s.path, emissionEvent(hit.emission, weight, lightPdf));
    }
    if (s.depth == kMaxDepth) return false;
    s.vertex = GuidedVertex(s.pass, {hit.position, hit.normal, s.pixel, s.sample, false, s.depth});
    if (!playRoulette(s)) return false;
    s.vertex.prepare(1);
    const ToyBsdf bsdf{hit.normal, inFog ? 1 : m_room.albedo};
    estimateDirectLight(s, hit, bsdf);
    const float u = s.numbers.next(), v = s.numbers.next();
    const ToyBsdf::Sample next = s.vertex.sample(u, v, bsdf);
    if (!(next.weight > 0)) return false;
    BounceEvent bounce = bounceEvent(next.wi, gray(next.weight), next.pdf);
    bounce.guidablePdf = bsdf.density(next.wi);
    bounce.guidableProbability = 1;
    s.recorder.bounce(s.path, bounce);
    s.throughput *= next.weight;
    s.pdf = next.pdf;
    s.origin = hit.position;
    s.direction = next.wi;
    return true;
  }

  bool playRoulette(State& s) const {
    const float survival = s.vertex.survivalProbability(s.throughput, 1);
    if (survival == 1) return true;
    const bool survives = s.numbers.next() < survival;
    bring(s, s.throughput * s.vertex.standIn(survival, survives).x);
    if (!survives) return false;
    s.throughput /= survival;
    s.recorder.survived(s.path, survival);
    return true;
  }

  // Chooses one of the two lamps, as often one as the other where nothing is known.
  static int chooseLamp(const GuidedVertex& vertex, float u) {
    const uint32_t group = vertex.drawLightGroup(u);
    return group != kNoLightGroup ? int(group) : u < 0.5f ? 0 : 1;
  }

  void estimateDirectLight(State& s, const ToyRoom::Hit& hit, const ToyBsdf& bsdf) const {
    const int lamp = chooseLamp(s.vertex, s.numbers.next());
    const float lampProbability = s.vertex.lightProbability(uint32_t(lamp), 0.5f);
    const float u = s.numbers.next(), v = s.numbers.next(), uShadow = s.numbers.next();
    const Float3 point{m_room.lampLeft(lamp) + u * m_room.lampSize, 0.4f + v * m_room.lampSize, 1};
    const Float3 to = point - hit.position, wi = to / lengthOf(to);
    const float bsdfPdf = bsdf.density(wi);
    if (!(bsdfPdf > 0) || !(wi.z > 1e-4f)) return;
    const float pdf = lampPdf(to) * lampProbability;
    const float unweighted =
        bsdf.albedo * bsdfPdf * m_room.lampRadiance[lamp] * m_room.transmittance(lengthOf(to)) / pdf;
    const float weighted = unweighted * powerHeuristic(pdf, s.vertex.pdf(wi, bsdfPdf, bsdfPdf));
    const float traced = s.vertex.shadowRayProbability(s.throughput * weighted);
    if (!(uShadow < traced)) return;
    ++s.rays;
    s.recorder.light(s.path, lightEvent(gray(unweighted / traced), gray(weighted / traced), wi,
                                        {pdf, bsdfPdf, bsdfPdf, uint32_t(lamp), traced * lampProbability}));
    if (m_room.isHidden(hit.position, point))
      s.recorder.lightHidden(s.path);
    else
      bring(s, s.throughput * weighted / traced, lamp);
  }

  ToyRoom m_room;
  uint32_t m_width, m_height;
};

}  // namespace odis::test
