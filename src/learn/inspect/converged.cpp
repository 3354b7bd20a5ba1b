#include "learn/inspect/converged.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "learn/data/target_tracer.h"

namespace odis::learn {

namespace {

double sqr(double x) {
  return x * x;
}

// A target's samples of a texel must be countable in eight bits; about half of the directions are traced.
constexpr int kPerTexel = 8, kPathsOfTarget = kPerTexel * kTargetTexels / 2;
// Tells these samples from the pilot's.
constexpr uint64_t kConvergedSeed = 0x636f6e7665726765ull;

}  // namespace

void Converged::add(const Target& target) {
  Converged one;
  for (size_t t = 0; t < one.m_texels.size(); ++t) {
    const double count = target.samples[t];
    one.m_texels[t] = {count,
                       count * target.indirect[t],
                       count * sqr(target.indirectRms[t]),
                       count * target.emission[t],
                       count * sqr(target.emissionRms[t]),
                       target.lightPdf[t] > 0 ? 1.0 : 0.0,
                       target.lightPdf[t]};
  }
  one.m_targets = 1;
  one.m_outgoing[0] = target.outgoing.x;
  one.m_outgoing[1] = target.outgoing.y;
  one.m_outgoing[2] = target.outgoing.z;
  one.m_outgoingSquares = sqr(target.outgoingRms);
  one.m_outgoingRays = target.outgoingRays;
  one.m_lights = target.lights;
  for (LightMoments& m : one.m_lights) {
    m.rms *= m.rms;
    m.misRms *= m.misRms;
  }
  add(one);
}

void Converged::add(const Converged& other) {
  for (size_t t = 0; t < m_texels.size(); ++t) {
    Texel& sum = m_texels[t];
    const Texel& more = other.m_texels[t];
    sum.samples += more.samples;
    sum.indirect += more.indirect;
    sum.indirectSquares += more.indirectSquares;
    sum.emission += more.emission;
    sum.emissionSquares += more.emissionSquares;
    sum.lit += more.lit;
    sum.lightPdf += more.lightPdf;
  }
  m_targets += other.m_targets;
  for (size_t i = 0; i < 3; ++i) m_outgoing[i] += other.m_outgoing[i];
  m_outgoingSquares += other.m_outgoingSquares;
  m_outgoingRays += other.m_outgoingRays;
  m_lights.resize(std::max(m_lights.size(), other.m_lights.size()));
  for (size_t g = 0; g < other.m_lights.size(); ++g) {
    m_lights[g].mean += other.m_lights[g].mean;
    m_lights[g].rms += other.m_lights[g].rms;
    m_lights[g].misMean += other.m_lights[g].misMean;
    m_lights[g].misRms += other.m_lights[g].misRms;
    m_lights[g].probability += other.m_lights[g].probability;
  }
}

Converged::Texel Converged::texel(size_t index) const {
  Texel t = m_texels[index];
  if (t.lit > 0) t.lightPdf /= t.lit;
  if (!(t.samples > 0)) return t;
  for (double* sum : {&t.indirect, &t.indirectSquares, &t.emission, &t.emissionSquares}) *sum /= t.samples;
  return t;
}

uint64_t Converged::paths() const {
  double sum = 0;
  for (const Texel& t : m_texels) sum += t.samples;
  return uint64_t(sum);
}

Float3 Converged::outgoing() const {
  const double scale = 1 / std::max(m_targets, 1.0);
  return {float(m_outgoing[0] * scale), float(m_outgoing[1] * scale), float(m_outgoing[2] * scale)};
}
float Converged::outgoingRms() const {
  return float(std::sqrt(m_outgoingSquares / std::max(m_targets, 1.0)));
}
float Converged::outgoingRays() const {
  return float(m_outgoingRays / std::max(m_targets, 1.0));
}
LightMoments Converged::lights(size_t group) const {
  if (group >= m_lights.size()) return {};
  const float scale = 1 / float(std::max(m_targets, 1.0));
  const LightMoments& sum = m_lights[group];
  return {sum.mean * scale, std::sqrt(sum.rms * scale), sum.misMean * scale, std::sqrt(sum.misRms * scale),
          sum.probability * scale};
}

std::array<Converged, 2> traceConverged(const render::Scene& scene, const render::LightSampler& lights,
                                        std::span<const Start> starts, const ConvergedSettings& settings,
                                        render::Progress& progress) {
  TargetSettings target;
  target.perTexel = kPerTexel;
  const auto rounds = size_t(std::max(2, settings.paths / kPathsOfTarget));
  progress.begin("converged", rounds);
  std::vector<Target> targets(rounds);
  tbb::parallel_for(size_t(0), rounds, [&](size_t round) {
    if (progress.cancelled()) return;
    // Each round has numbers of its own: a tracer takes a few consecutive seeds.
    constexpr uint64_t kSeedsOfTracer = 16;
    TargetTracer tracer(scene, lights, target,
                        render::mixBits(settings.seed ^ kConvergedSeed) + kSeedsOfTracer * round,
                        settings.maxDepth);
    tracer.trace(starts, targets[round]);
    progress.advance(1);
  });
  progress.end();
  std::array<Converged, 2> halves;
  for (size_t round = 0; round < rounds; ++round)
    if (!targets[round].samples.empty()) halves[round % 2].add(targets[round]);
  return halves;
}

}  // namespace odis::learn
