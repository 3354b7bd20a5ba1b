// The interface of participating media: how far light gets, and where it is scattered.
//
// Extinction may differ between red, green and blue. Each decision (scattered here or not) is drawn by the
// mean of the channels' probabilities, weighted by the path's throughput, and each channel is divided by that
// mean: the balance heuristic over channels, so that the mean of the throughput never grows (Kutz et al.
// 2017, "Spectral and Decomposition Tracking for Rendering Heterogeneous Volumes", section 4.2).
#pragma once

#include <memory>

#include "render/bsdf/bsdf.h"
#include "render/medium/phase_function.h"
#include "render/sampler/random_stream.h"

namespace odis::render {

// A part of a ray that lies in one medium, from its origin.
struct MediumSegment {
  Vec3 origin, direction;  // world space, unit direction
  float length = 0;        // may be infinite

  Vec3 at(float distance) const { return origin + direction * distance; }
};

// What becomes of a path on a segment.
struct Flight {
  bool scattered = false;  // within the medium; else it arrives at the segment's end
  float distance = 0;      // to where it is scattered
  // What the throughput is multiplied by: transmittance, times the scattering coefficient where it is
  // scattered, over the probability (density) of what happened.
  Rgb weight{1, 1, 1};
};

class Medium {
 public:
  virtual ~Medium() = default;

  // Draws what becomes of a path with this throughput. `u` in [0, 1) is the first random number that is
  // needed; others come from the stream.
  virtual Flight fly(const MediumSegment& segment, const Rgb& throughput, float u,
                     RandomStream& random) const = 0;
  // How far a path gets on average, where that is the same everywhere; 0 elsewhere.
  virtual float meanFreePath() const { return 0; }
  // The same as fly(), with distances drawn so that light of a lamp at that place is found as well (Kulla and
  // Fajardo 2012, "Importance Sampling Techniques for Path Tracing in Participating Media"), where there is a
  // mean free path.
  virtual Flight flyPast(const Vec3& /*lamp*/, const MediumSegment& /*segment*/, const Rgb& /*throughput*/,
                         float /*u*/) const {
    return {};
  }
  // An unbiased estimate of the segment's transmittance.
  virtual Rgb transmittance(const MediumSegment& segment, RandomStream& random) const = 0;
  // The albedo of single scattering at a point, in [0, 1].
  virtual Rgb albedo(const Vec3& p) const = 0;

  const PhaseFunction& phase() const { return *m_phase; }
  // The same as a BSDF for whom vertices in the medium are like those on surfaces. Its shading frame are the
  // axes of the world, and there is no cosine. It is evaluable if light is sampled by next-event estimation
  // from within.
  const Bsdf& bsdf() const { return *m_bsdf; }
  // Whether its density or its albedo vary from place to place in world space.
  virtual bool varies() const = 0;
  virtual uint64_t bytes() const { return 0; }

 protected:
  Medium(PhaseFunctionPtr phase, bool samplesEmitters);

 private:
  PhaseFunctionPtr m_phase;
  std::unique_ptr<const Bsdf> m_bsdf;
};

using MediumPtr = std::shared_ptr<const Medium>;

}  // namespace odis::render
