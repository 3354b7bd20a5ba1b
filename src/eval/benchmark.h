// How fast rendering is, and what guiding adds to it.
#pragma once

#include "render/integrators/render.h"

namespace odis::eval {

struct BenchmarkSettings {
  int spp = 4;     // samples per pixel: of `path`, and of `odis` with a pilot of one
  int rounds = 5;  // the two take turns so often; medians are reported
  int maxDepth = 13, rrDepth = 5;
  render::SamplerKind sampler = render::SamplerKind::independent;
  int threads = 0;
};

// What operations cost that a guided frame decides about (settings guided-cost, built-cell-cost and
// recorded-ray-cost), in the time that a ray of an unguided path takes with all that is computed where it
// arrives.
struct OperationCosts {
  float guidedRay = 0, builtCell = 0, recordedRay = 0;
};

// Seconds are of the wall clock unless they say otherwise.
struct BenchmarkResult {
  uint64_t pixels = 0;
  double samplesPerSecond = 0, raysPerSecond = 0;  // of `path`
  double samplesPerCpuSecond = 0;                  // the same by the process's time on all cores: what a busy
                                                   // machine disturbs least
  double guidedCost = 0;                           // time of a guided sample over that of a sample of `path`
  double guidingShare = 0;    // of the time of a frame of `odis`: recording the pilot and building the guide
  double frameCost = 0;       // time of a frame of `odis` over that of `path` with as many samples
  double bytesPerVertex = 0;  // held at most while building, over the pilot's vertices
  uint64_t bytesMaps = 0;
  OperationCosts costs;  // as measured
};

// What a method renders with in a benchmark, but for the seed.
render::RenderOptions optionsOf(const BenchmarkSettings& settings, render::IntegratorKind integrator);

// Throws nothing of its own; ends early, with what there is, if progress is cancelled.
BenchmarkResult benchmark(const render::Scene& scene, const BenchmarkSettings& settings,
                          render::Progress& progress);

}  // namespace odis::eval
