#include "learn/data/target_tracer.h"

#include <odis/mixture.h>

#include <algorithm>
#include <cmath>

#include "render/emitter/moving_light.h"

namespace odis::learn {

using render::Path;
using render::Ray;
using render::Rgb;
using render::Sampler;
using render::SamplerKind;
using render::Vec2;
using render::Vec3;

namespace {

// Sums of a number and of its squares.
struct Moments {
  double sum = 0, squares = 0;
  void add(double x) {
    sum += x;
    squares += x * x;
  }
  float mean(double count) const { return count > 0 ? float(sum / count) : 0; }
  float rms(double count) const { return count > 0 ? float(std::sqrt(squares / count)) : 0; }
};

float usableLuminance(const Rgb& color) {
  const float value = render::luminance(color);
  return std::isfinite(value) ? std::max(value, 0.0f) : 0.0f;
}

const Start& pick(std::span<const Start> starts, float u) {
  return starts[std::min(size_t(u * float(starts.size())), starts.size() - 1)];
}

}  // namespace

TargetTracer::TargetTracer(const render::Scene& scene, const render::LightSampler& lights,
                           const TargetSettings& settings, uint64_t seed, int maxDepth)
    : m_scene(scene), m_lights(lights), m_settings(settings), m_seed(seed) {
  m_path.scene = &scene;
  m_path.lights = &lights;
  m_path.maxDepth = maxDepth;
}

Sampler TargetTracer::sampler(Stream stream, uint32_t index, uint32_t sample) const {
  return {SamplerKind::independent, m_seed + 4 * m_target + stream, index, sample};
}

void TargetTracer::trace(std::span<const Start> starts, Target& target) {
  target.starts = uint32_t(starts.size());
  Vec3 position(0, 0, 0), normal(0, 0, 0);
  for (const Start& start : starts) {
    position += start.at.p;
    normal += start.reference.n;
  }
  target.position = render::toOdis(position / float(starts.size()));
  const float length = render::length(normal);
  target.normal = render::toOdis(length > 0 ? normal / length : starts.front().reference.n);
  traceArriving(starts, target);
  if (m_settings.outgoing > 0) traceOutgoing(starts, target);
  if (m_settings.lights > 0) traceLights(starts, target);
  ++m_target;
}

void TargetTracer::traceArriving(std::span<const Start> starts, Target& target) {
  std::vector<Path> paths;
  std::vector<int> texels;
  // Once all texels had their turns, some have another one until there are as many samples as half of the
  // texels make.
  const int turns = m_settings.perTexel * kTargetTexels;
  const auto enough = size_t(turns / 2);
  for (int turn = 0; turn < turns || (paths.size() < enough && turn < 2 * turns); ++turn) {
    // A stride that visits every texel, so that additional turns are spread evenly.
    constexpr int kStride = 389;
    const int texel = turn * kStride % kTargetTexels;
    Sampler numbers = sampler(arriving, uint32_t(texel), uint32_t(turn / kTargetTexels));
    const Start& start = pick(starts, numbers.get1D());
    const Vec2 u = numbers.get2D();
    const Vec3 wi = render::fromOdis(directionInTexel(texel, {u.x, u.y}));
    if (!start.reference.both && render::dot(wi, start.reference.n) <= 0) continue;
    Path& path = paths.emplace_back(render::Scene::spawn(start.at, wi), numbers);
    // Emission met directly counts whole, and tells how next-event estimation would have found it.
    path.bySampling = true;
    path.directionPdf = INFINITY;
    path.previous = start.reference;
    texels.push_back(texel);
  }
  render::tracePaths(m_path, paths);

  std::vector<Moments> indirect(kTargetTexels), emission(kTargetTexels);
  std::vector<float> found(kTargetTexels), foundPdf(kTargetTexels);
  target.rays.assign(kTargetTexels, 0);
  target.samples.assign(kTargetTexels, 0);
  for (size_t i = 0; i < paths.size(); ++i) {
    const Path& path = paths[i];
    const auto texel = size_t(texels[i]);
    ++target.samples[texel];
    indirect[texel].add(usableLuminance(path.radiance - path.emitted));
    emission[texel].add(usableLuminance(path.emitted));
    target.rays[texel] += float(path.counts.rays + path.counts.shadowRays);
    if (path.emissions == 0) continue;
    ++found[texel];
    foundPdf[texel] += path.emittedPdf;
  }
  for (size_t t = 0; t < kTargetTexels; ++t) {
    const float count = target.samples[t];
    target.indirect.push_back(indirect[t].mean(count));
    target.indirectRms.push_back(indirect[t].rms(count));
    target.emission.push_back(emission[t].mean(count));
    target.emissionRms.push_back(emission[t].rms(count));
    target.lightPdf.push_back(found[t] > 0 ? foundPdf[t] / found[t] : 0);
    if (count > 0) target.rays[t] /= count;
  }
}

void TargetTracer::traceOutgoing(std::span<const Start> starts, Target& target) {
  std::vector<Path> paths;
  for (int i = 0; i < m_settings.outgoing; ++i)
    paths.emplace_back(starts[size_t(i) % starts.size()].towards, sampler(outgoing, uint32_t(i), 0));
  // The segment that ends at the vertex comes on top.
  render::PathSettings settings = m_path;
  settings.maxDepth = std::min(m_path.maxDepth + 1, kDeepestPath);
  render::tracePaths(settings, paths);
  Moments luminance;
  double rays = 0;
  Vec3 sum(0, 0, 0);
  for (const Path& path : paths) {
    const Rgb scattered = path.radiance - path.emitted;
    luminance.add(usableLuminance(scattered));
    if (render::isFinite(scattered)) sum += scattered;
    rays += double(path.counts.rays + path.counts.shadowRays) - 1;
  }
  const auto count = float(std::max<size_t>(paths.size(), 1));
  target.outgoing = render::toOdis(sum / count);
  target.outgoingRms = luminance.rms(count);
  target.outgoingRays = float(rays) / count;
}

void TargetTracer::traceLights(std::span<const Start> starts, Target& target) {
  const uint32_t groups = m_lights.groupCount();
  constexpr int kFewest = 32, kMost = 256;
  const int each = groups > 0 ? std::clamp(m_settings.lights / int(groups), kFewest, kMost) : 0;
  struct Errand {
    uint32_t group;
    float value, misWeight;
  };
  std::vector<Errand> errands;
  std::vector<Ray> rays;
  target.lights.assign(groups, {});
  for (uint32_t group = 0; group < groups; ++group)
    for (int i = 0; i < each; ++i) {
      Sampler numbers = sampler(direct, group, uint32_t(i));
      const Start& start = pick(starts, numbers.get1D());
      const float uChoice = numbers.get1D();
      const Vec2 u = numbers.get2D();
      const float ofGroup = m_lights.groupProbability(start.reference, group);
      target.lights[group].probability += ofGroup / float(each);
      if (!start.at.shape->bsdf().traits().evaluable) continue;
      const auto choice = m_lights.sampleGroup(start.reference, group, uChoice, u);
      if (!choice.emitter) continue;
      const render::EmitterSample light =
          render::sampleLightAt(start.at.time, *choice.emitter, choice.part, start.at.p, choice.u);
      if (!(light.pdf > 0)) continue;
      const render::BsdfValue bsdf =
          start.at.shape->bsdf().evaluate(start.at, start.wo, start.at.shading.toLocal(light.wi));
      const float within = light.pdf * choice.probability;
      const float value = usableLuminance(bsdf.value * light.radiance) / within;
      if (!(value > 0)) continue;
      errands.push_back({group, value, light.delta ? 1 : powerHeuristic(within * ofGroup, bsdf.pdf)});
      rays.push_back(render::Scene::spawn(start.at, light.wi, light.distance));
    }
  std::vector<uint8_t> hidden(rays.size());
  m_scene.occluded(rays, hidden);
  std::vector<Moments> whole(groups), weighted(groups);
  for (size_t i = 0; i < errands.size(); ++i) {
    if (hidden[i]) continue;
    whole[errands[i].group].add(errands[i].value);
    weighted[errands[i].group].add(errands[i].value * errands[i].misWeight);
  }
  for (uint32_t group = 0; group < groups; ++group) {
    LightMoments& moments = target.lights[group];
    moments.mean = whole[group].mean(each);
    moments.rms = whole[group].rms(each);
    moments.misMean = weighted[group].mean(each);
    moments.misRms = weighted[group].rms(each);
  }
}

}  // namespace odis::learn
