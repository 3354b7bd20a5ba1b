// What really arrives at the vertices of a cell: the samples of a target (learn/data/targets.h), many times
// over.
#pragma once

#include <functional>

#include "learn/data/starts.h"
#include "learn/data/targets.h"
#include "render/path/progress.h"

namespace odis::learn {

// Sums over samples, kTargetTexels of them for directions. Luminance.
class Converged {
 public:
  struct Texel {
    double samples = 0, indirect = 0, indirectSquares = 0, emission = 0, emissionSquares = 0;
    double lit = 0,
           lightPdf = 0;  // in how many targets a light was met there, and the sum of their densities
  };

  void add(const Target& target);
  void add(const Converged& other);

  // Means, zeros where there are no samples.
  Texel texel(size_t index) const;
  uint64_t paths() const;
  Float3 outgoing() const;
  float outgoingRms() const;
  float outgoingRays() const;
  LightMoments lights(size_t group) const;

 private:
  std::vector<Texel> m_texels{kTargetTexels};
  double m_targets = 0, m_outgoing[3] = {}, m_outgoingSquares = 0, m_outgoingRays = 0;
  std::vector<LightMoments> m_lights;  // sums; of squares in the place of roots
};

struct ConvergedSettings {
  int paths = 0;     // about so many
  int maxDepth = 0;  // in segments
  uint64_t seed = 0;
};

// Traces paths from these vertices, in two independent halves. The same for any number of threads. Stops
// early if progress is cancelled.
std::array<Converged, 2> traceConverged(const render::Scene& scene, const render::LightSampler& lights,
                                        std::span<const Start> starts, const ConvergedSettings& settings,
                                        render::Progress& progress);

}  // namespace odis::learn
