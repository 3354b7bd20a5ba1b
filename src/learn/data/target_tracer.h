// Traces the samples of targets.
#pragma once

#include "learn/data/starts.h"
#include "learn/data/targets.h"

namespace odis::learn {

class TargetTracer {
 public:
  // Of the same numbers for the same seed, others for each target. `maxDepth` is that of paths that leave a
  // vertex, in segments.
  TargetTracer(const render::Scene& scene, const render::LightSampler& lights, const TargetSettings& settings,
               uint64_t seed, int maxDepth = kDeepestPath);

  // Fills in what is measured, from samples that start at these vertices; there must be one.
  void trace(std::span<const Start> starts, Target& target);

 private:
  enum Stream : uint64_t { arriving, outgoing, direct };
  // Independent numbers; `index` tells the samples of a stream apart.
  render::Sampler sampler(Stream stream, uint32_t index, uint32_t sample) const;
  // The light that arrives: stratified over all directions, those that the vertex scatters from are traced.
  void traceArriving(std::span<const Start> starts, Target& target);
  // What comes back along the paths that the vertices were met by.
  void traceOutgoing(std::span<const Start> starts, Target& target);
  // Next-event estimation from each group.
  void traceLights(std::span<const Start> starts, Target& target);

  const render::Scene& m_scene;
  const render::LightSampler& m_lights;
  const TargetSettings& m_settings;
  uint64_t m_seed, m_target = 0;
  render::PathSettings m_path;
};

}  // namespace odis::learn
