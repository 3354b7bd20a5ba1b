#include "learn/data/targets.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "learn/scenes/random.h"
#include "odis/cells/samples.h"

namespace odis::learn {

using render::Path;
using render::Ray;
using render::Rgb;
using render::Sampler;
using render::SamplerKind;
using render::Vec2;
using render::Vec3;

namespace {

// At how many vertices of a cell samples start, at most.
constexpr size_t kMostStarts = 256;

// A vertex found again as a point on its surface, and a ray that ends there as its path's did.
struct Start {
  render::SurfacePoint at;
  Vec3 wo;  // in the shading frame
  render::LightReference reference;
  Ray towards;
};

// Nothing lies between a vertex and the one before it, or the camera: a ray from the middle finds it.
std::optional<Start> findAgain(const render::Scene& scene, const PilotVertex& v, float fromPrevious) {
  const Vec3 wo = render::fromOdis(v.wo), position = render::fromOdis(v.position);
  Start start;
  start.towards = Ray{position + wo * (fromPrevious / 2), -wo, render::kInfinity};
  if (!scene.intersect(start.towards, start.at)) return std::nullopt;
  if (render::length(start.at.p - position) > 1e-3f * fromPrevious) return std::nullopt;
  start.wo = start.at.shading.toLocal(wo);
  start.reference = render::lightReference(start.at, start.wo);
  return start;
}

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

class Tracer {
 public:
  Tracer(const render::Scene& scene, const render::LightSampler& lights, const TargetSettings& settings,
         uint64_t seed)
      : m_scene(scene), m_lights(lights), m_settings(settings), m_seed(seed) {
    m_path.scene = &scene;
    m_path.lights = &lights;
    m_path.maxDepth = kDeepestPath;
  }

  void trace(std::span<const Start> starts, Target& target) {
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
    traceOutgoing(starts, target);
    traceLights(starts, target);
    ++m_target;
  }

 private:
  enum Stream : uint64_t { arriving, outgoing, direct };
  // Independent numbers; `index` tells the samples of a stream apart.
  Sampler sampler(Stream stream, uint32_t index, uint32_t sample) const {
    return {SamplerKind::independent, m_seed + 4 * m_target + stream, index, sample};
  }
  static const Start& pick(std::span<const Start> starts, float u) {
    return starts[std::min(size_t(u * float(starts.size())), starts.size() - 1)];
  }

  // The light that arrives: stratified over all directions, those that the vertex scatters from are traced.
  void traceArriving(std::span<const Start> starts, Target& target) {
    std::vector<Path> paths;
    std::vector<int> texels;
    // Once all texels had their turns, some have another one until there are as many samples as half of the texels make.
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

  // What comes back along the paths that the vertices were met by.
  void traceOutgoing(std::span<const Start> starts, Target& target) {
    std::vector<Path> paths;
    for (int i = 0; i < m_settings.outgoing; ++i)
      paths.emplace_back(starts[size_t(i) % starts.size()].towards, sampler(outgoing, uint32_t(i), 0));
    render::tracePaths(m_path, paths);
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

  // Next-event estimation from each group.
  void traceLights(std::span<const Start> starts, Target& target) {
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
        const render::EmitterSample light = choice.emitter->sample(choice.part, start.at.p, choice.u);
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

  const render::Scene& m_scene;
  const render::LightSampler& m_lights;
  const TargetSettings& m_settings;
  uint64_t m_seed, m_target = 0;
  render::PathSettings m_path;
};

// All vertices of a view, with how far each is from what its path met before.
class Vertices {
 public:
  Vertices(const render::Scene& scene, std::span<const Pilot> pilots) : m_scene(scene), m_pilots(pilots) {}

  // Calls use(index, vertex) with every vertex; the index counts through all pilots.
  template <class Use>
  void forEach(const Use& use) const {
    uint32_t index = 0;
    for (const Pilot& pilot : m_pilots)
      for (const PilotVertex& v : pilot.vertices) use(index++, v);
  }
  std::optional<Start> find(uint32_t index) const {
    const Pilot* pilot = m_pilots.data();
    for (; index >= pilot->vertices.size(); ++pilot) index -= uint32_t(pilot->vertices.size());
    const PilotVertex& v = pilot->vertices[index];
    const float before = v.depth > 1 ? pilot->vertices[index - 1].distance : fromCamera(v);
    return findAgain(m_scene, v, before);
  }

 private:
  float fromCamera(const PilotVertex& v) const {
    const render::Crop& crop = m_scene.film().crop;
    const int x = crop.x + int(v.pixel) % crop.width, y = crop.y + int(v.pixel) / crop.width;
    const Vec2 pixel(float(x) + 0.5f, float(y) + 0.5f);
    return render::length(render::fromOdis(v.position) -
                          m_scene.sensor().ray(pixel, Vec2(0.5f, 0.5f)).origin);
  }

  const render::Scene& m_scene;
  std::span<const Pilot> m_pilots;
};

// Puts the keys of a weighted draw without replacement in front, the first drawn first (Efraimidis and Spirakis 2006).
template <class Item>
void drawInOrder(std::vector<std::pair<double, Item>>& weighted, Random& random) {
  for (auto& [weight, item] : weighted) weight = std::log(std::max(random.unit(), 1e-300)) / weight;
  std::stable_sort(weighted.begin(), weighted.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
}

}  // namespace

std::vector<Target> traceTargets(const render::Scene& scene, const render::LightSampler& lights,
                                 std::span<const Pilot> pilots, const ViewFrame& frame,
                                 const TargetSettings& settings, uint64_t seed) {
  const Vertices vertices(scene, pilots);
  const CellGrid grid(frame.origin, frame.edge);
  struct Members {
    std::vector<uint32_t> vertices;
    bool scatter = false;  // whether any does: there is nothing to decide on black surfaces
  };
  std::map<uint64_t, Members> cells;
  std::vector<std::pair<double, uint32_t>> pixels;  // the first usable vertex of each path
  uint64_t lastPath = ~0ull, path = 0;
  vertices.forEach([&](uint32_t index, const PilotVertex& v) {
    if (v.depth == 1) ++path;
    if (!isUsable(v)) return;
    Members& members =
        cells[grid.key(positionOf(stepsOf(v.position, frame), frame), unpacked(packed(v.normal)), 0)];
    members.vertices.push_back(index);
    members.scatter |= luminance(v.weight) > 0;
    if (path != lastPath) pixels.emplace_back(1, index);
    lastPath = path;
  });

  Random random(seed);
  Tracer tracer(scene, lights, settings, seed);
  std::vector<Target> targets;
  std::vector<Start> starts;
  std::vector<std::pair<double, const std::vector<uint32_t>*>> weighted;
  for (const auto& [key, members] : cells)
    if (members.scatter) weighted.emplace_back(std::sqrt(double(members.vertices.size())), &members.vertices);
  drawInOrder(weighted, random);
  const auto wanted = size_t(settings.cells);
  for (size_t i = 0; i < weighted.size() && targets.size() < wanted; ++i) {
    std::vector<std::pair<double, uint32_t>> members;
    for (const uint32_t index : *weighted[i].second) members.emplace_back(1, index);
    drawInOrder(members, random);
    starts.clear();
    for (size_t m = 0; m < members.size() && starts.size() < kMostStarts; ++m)
      if (const auto start = vertices.find(members[m].second)) starts.push_back(*start);
    if (starts.empty()) continue;
    Target& target = targets.emplace_back();
    target.vertex = members.front().second;
    target.cellVertices = uint32_t(members.size());
    tracer.trace(starts, target);
  }

  drawInOrder(pixels, random);
  size_t left = size_t(settings.pixels);
  for (size_t i = 0; i < pixels.size() && left > 0; ++i) {
    const auto start = vertices.find(pixels[i].second);
    if (!start) continue;
    Target& target = targets.emplace_back();
    target.pixel = true;
    target.vertex = pixels[i].second;
    target.cellVertices = 1;
    tracer.trace(std::span(&*start, 1), target);
    --left;
  }
  return targets;
}

}  // namespace odis::learn
