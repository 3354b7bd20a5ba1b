// A path tracer that is guided through Open PGL's interface as Cycles is: half of the directions from the
// distribution, half from the BSDF, roulette on the way to a vertex, samples handed over path by path.
#pragma once

#include <openpgl/cpp/OpenPGL.h>

#include <optional>

#include "frame/toy_host.h"

namespace odis::test {

namespace pgl = openpgl::cpp;

inline pgl_vec3f toPgl(const Float3& v) {
  return {v.x, v.y, v.z};
}
inline Float3 fromPgl(const pgl_vec3f& v) {
  return {v.x, v.y, v.z};
}

// Those of the path with this seed.
inline ToyNumbers numbersOf(uint64_t seed) {
  return ToyNumbers(seed, 0, 0);
}

// Hands a path over as Cycles does.
inline void handOver(pgl::PathSegmentStorage& path, pgl::SampleStorage& samples) {
  path.PrepareSamples();
  size_t count = 0;
  const pgl::SampleData* made = path.GetSamples(count);
  samples.AddSamples(made, count);
}

class PglHost {
 public:
  static constexpr int kMaxDepth = 6;
  static constexpr float kGuidedShare = 0.5f, kSurvival = 0.8f;

  explicit PglHost(const ToyRoom& room) : m_room(room) {}

  // Traces a path from the camera and records it; returns what it brought. Without a field, or before that
  // knows anything, directions are those of the BSDF.
  float trace(const pgl::Field* field, pgl::PathSegmentStorage& path, ToyNumbers numbers) const {
    path.Clear();
    float radiance = 0, throughput = 1;
    Float3 origin{0.5f, 0.01f, 0.5f}, direction{numbers.next() - 0.5f, 0.6f, 0.5f - numbers.next()};
    direction = direction / lengthOf(direction);
    pgl::PathSegment* before = nullptr;
    for (int depth = 1; depth <= kMaxDepth; ++depth) {
      if (before && depth > 2) pgl::SetRussianRouletteProbability(before, kSurvival);
      const bool ends = depth > 2 && numbers.next() >= kSurvival;
      const ToyRoom::Hit hit = m_room.intersect(origin, direction);
      pgl::PathSegment* segment = path.NextSegment();
      pgl::SetPosition(segment, toPgl(hit.position));
      pgl::SetNormal(segment, toPgl(hit.normal));
      pgl::SetDirectionOut(segment, toPgl(direction * -1.0f));
      // No next-event estimation: whatever is met counts in full.
      pgl::SetDirectContribution(segment, toPgl(hit.emission));
      radiance += throughput * hit.emission.x;
      if (ends || depth == kMaxDepth) break;
      if (depth > 2) throughput /= kSurvival;

      float pdf = 0;
      const Float3 wi = sampleDirection(field, hit, numbers, pdf);
      const float cosine = dot(wi, hit.normal);
      if (!(cosine > 0) || !(pdf > 0)) break;
      const float weight = m_room.albedo * cosine / kPi / pdf;
      pgl::SetDirectionIn(segment, toPgl(wi));
      pgl::SetPDFDirectionIn(segment, pdf);
      pgl::SetScatteringWeight(segment, toPgl(gray(weight)));
      pgl::SetRoughness(segment, 1);
      throughput *= weight;
      origin = hit.position;
      direction = wi;
      before = segment;
    }
    return radiance;
  }

  // Traces paths with the seeds from `first` on and hands them over; returns the sum of what they brought.
  double traceAndAdd(const pgl::Field* field, pgl::SampleStorage& samples, uint64_t first,
                     uint64_t count) const {
    pgl::PathSegmentStorage path;
    double sum = 0;
    for (uint64_t seed = first; seed < first + count; ++seed) {
      sum += trace(field, path, numbersOf(seed));
      handOver(path, samples);
    }
    return sum;
  }

 private:
  Float3 sampleDirection(const pgl::Field* field, const ToyRoom::Hit& hit, ToyNumbers& numbers,
                         float& pdf) const {
    const float choice = numbers.next(), u = numbers.next(), v = numbers.next();
    float unused = 0;
    bool guided = false;
    std::optional<pgl::SurfaceSamplingDistribution> distribution;
    if (field) {
      distribution.emplace(field);
      guided = distribution->Init(field, toPgl(hit.position), unused);
      if (guided) distribution->ApplyCosineProduct(toPgl(hit.normal));
    }
    Float3 wi;
    if (guided && choice < kGuidedShare) {
      pgl_vec3f sampled;
      distribution->SamplePDF({u, v}, sampled);
      wi = fromPgl(sampled);
    } else {
      wi = ToyBsdf{hit.normal, m_room.albedo}.sampleBsdf(u, v).wi;
    }
    const float ofBsdf = std::max(dot(wi, hit.normal), 0.0f) / kPi;
    pdf = guided ? kGuidedShare * distribution->PDF(toPgl(wi)) + (1 - kGuidedShare) * ofBsdf : ofBsdf;
    return wi;
  }

  ToyRoom m_room;
};

}  // namespace odis::test
