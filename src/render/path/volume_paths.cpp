#include "render/path/volume_paths.h"

#include "render/path/emission.h"
#include "render/path/scattering.h"

namespace odis::render {

namespace {

// A path from the end of its ray to its next ray.
class Step {
 public:
  Step(const PathSettings& settings, PathRecorder* recorder, Walker& walker)
      : m_settings(settings), m_recorder(recorder), m_walker(walker), m_path(*walker.path) {}

  // Takes the step, the ray having met `hit`. Returns whether there is a next ray.
  bool take(const Hit& hit) {
    ++m_path.counts.rays;
    const Ray& ray = m_path.ray;
    const float length = hit.shape ? hit.raw.t : kInfinity;
    if (m_walker.medium) {
      const Flight flight = fly(m_settings.lights, m_walker, length);
      attenuate(flight.weight);
      m_path.visible |= flight.scattered;
      if (isBlack(m_path.throughput)) return false;
      if (flight.scattered) return meetMedium(flight.distance);
    }
    if (!hit.shape) return leaveScene();
    Vertex vertex;
    vertex.at = hit.surfacePoint(ray);
    vertex.wo = vertex.at.shading.toLocal(-ray.direction);
    return meetSurface(vertex, length);
  }

 private:
  void attenuate(const Rgb& weight) {
    m_path.throughput *= weight;
    if (m_recorder) m_recorder->attenuation(m_path.handle, toOdis(weight));
  }
  // The distance that the path has come since the last vertex.
  float travel(float distance) {
    m_path.distance += distance;
    return m_walker.travelled += distance;
  }
  bool isDeepest() const { return m_settings.maxDepth >= 0 && m_walker.depth >= m_settings.maxDepth; }

  bool leaveScene() {
    if (m_recorder) m_recorder->escape(m_path.handle);
    if (m_path.hidesEnvironment) return false;
    const Escape escape{&m_path.ray, competitor(m_path)};
    forEachEnvironment(*m_settings.scene, {&escape, 1},
                       [&](size_t, const Emission& met) { addEmission(met); });
    return false;
  }
  void addEmission(const Emission& met) {
    render::addEmission(m_settings, m_recorder, m_path, m_walker.depth, met);
  }

  bool meetMedium(float distance) {
    const float travelled = travel(distance);
    if (isDeepest()) return false;
    const Ray& ray = m_path.ray;
    const MediumPoint point{ray.origin + ray.direction * distance, -ray.direction};
    if (m_recorder) {
      MediumEvent event;
      event.position = toOdis(point.p);
      event.wo = toOdis(point.wo);
      event.distance = travelled;
      event.time = ray.time;
      m_recorder->medium(m_path.handle, event);
    }
    return scatter(m_settings, m_recorder, m_walker, {*m_walker.medium, point, ray.time});
  }

  bool meetSurface(const Vertex& vertex, float length) {
    const float travelled = travel(length);
    const SurfacePoint& at = vertex.at;
    const bool isHidden =
        m_walker.depth == 1 && at.shape->emitter() && m_settings.scene->integrator().hideEmitters;
    if (isHidden) return pass(vertex, Rgb(1.0f));
    ifShining(m_path.ray, at, competitor(m_path), [&](const Emission& met) { addEmission(met); });
    // A boundary, or a vertex that depth ends the path at: it may still pass straight through.
    if (isDeepest() || !at.shape->bsdf().traits().evaluable) {
      const VertexDraws draws(m_walker);
      const BsdfSample drawn = at.shape->bsdf().sample(at, vertex.wo, draws.lobe, draws.direction);
      if (passesStraight(vertex, drawn.lobe)) return pass(vertex, drawn.weight);
      if (isDeepest()) {
        m_path.visible = true;
        return false;
      }
    }
    if (m_recorder) {
      SurfaceEvent event;
      event.position = toOdis(at.p);
      event.normal = toOdis(facingNormal(at, vertex.wo));
      event.wo = toOdis(-m_path.ray.direction);
      event.distance = travelled;
      event.time = m_path.ray.time;
      m_recorder->surface(m_path.handle, event);
    }
    return scatter(m_settings, m_recorder, m_walker, {vertex, m_walker.medium});
  }

  // Goes on beyond a surface that is no vertex of the path.
  bool pass(const Vertex& vertex, const Rgb& weight) {
    attenuate(weight);
    const Vec3 direction = m_path.ray.direction;
    m_path.ray = Scene::spawn(vertex.at, direction);
    m_walker.medium = vertex.at.shape->mediumBeyond(vertex.at, direction, m_walker.medium);
    m_walker.nextPlace();
    return !isBlack(m_path.throughput);
  }

  const PathSettings& m_settings;
  PathRecorder* m_recorder;
  Walker& m_walker;
  Path& m_path;
};

// The walkers of a batch and what their rays met; kept from batch to batch for its memory.
struct Walkers {
  std::vector<Walker> all;
  std::vector<uint32_t> active;
  std::vector<Ray> rays;
  std::vector<Hit> hits;
};

Walkers& walkersOfThread() {
  thread_local Walkers walkers;
  return walkers;
}

// Traces the rays of all walkers, and calls step(walker, hit), which tells whether there is a next ray, until
// there is none.
template <class TakeStep>
void walk(const Scene& scene, std::span<Path> paths, const TakeStep& step) {
  auto& [all, active, rays, hits] = walkersOfThread();
  all.clear();
  active.clear();
  for (Path& path : paths) {
    active.push_back(uint32_t(all.size()));
    all.emplace_back(path, scene.sensor().medium());
  }
  while (!active.empty()) {
    rays.clear();
    for (const uint32_t index : active) rays.push_back(all[index].path->ray);
    hits.resize(std::max(hits.size(), rays.size()));
    scene.intersect(rays, hits);
    size_t left = 0;
    for (size_t i = 0; i < active.size(); ++i)
      if (step(all[active[i]], hits[i])) active[left++] = active[i];
    active.resize(left);
  }
}

}  // namespace

void traceVolumePaths(const PathSettings& settings, std::span<Path> paths, PathRecorder* recorder) {
  walk(*settings.scene, paths,
       [&](Walker& walker, const Hit& hit) { return Step(settings, recorder, walker).take(hit); });
}

namespace {

// What a camera's ray sees of media before it meets a surface, in the mean over all places where it may be
// scattered: a denoiser takes noise of its features for what is there.
struct Veil {
  Rgb albedo{0, 0, 0}, passing{1, 1, 1};

  void add(Walker& walker, float length) {
    const Ray& ray = walker.path->ray;
    const Flight flight = fly(nullptr, walker, length);
    const float place = flight.scattered ? flight.distance : length < kInfinity ? 0.5f * length : 0;
    const Rgb behind =
        passing * walker.medium->transmittance({ray.origin, ray.direction, length}, walker.random);
    albedo += (passing - behind) * walker.medium->albedo(ray.origin + ray.direction * place);
    passing = behind;
  }
  void cover(Path& path) const {
    FirstHit& first = path.first;
    if (!first.valid) {
      if (isBlack(albedo)) return;
      first.valid = true;
      first.position = path.ray.origin;
      first.normal = first.geometricNormal = Vec3(0, 0, 0);
      first.albedo = Rgb(0.0f);
      first.roughness = 1;
    }
    first.albedo = first.albedo * passing + albedo;
    first.normal *= luminance(passing);
  }
};

}  // namespace

void traceFirstVolumeHits(const PathSettings& settings, std::span<Path> paths) {
  std::vector<Veil> veils(paths.size());
  walk(*settings.scene, paths, [&](Walker& walker, const Hit& hit) {
    Path& path = *walker.path;
    const Ray ray = path.ray;
    if (walker.medium) veils[size_t(&path - paths.data())].add(walker, hit.shape ? hit.raw.t : kInfinity);
    if (!hit.shape) return false;
    Vertex vertex;
    vertex.at = hit.surfacePoint(ray);
    vertex.wo = vertex.at.shading.toLocal(-ray.direction);
    if (!passesMirror(path, vertex, walker.place)) return false;
    walker.medium = vertex.at.shape->mediumBeyond(vertex.at, path.ray.direction, walker.medium);
    walker.nextPlace();
    return walker.place != settings.maxDepth;
  });
  for (size_t i = 0; i < paths.size(); ++i) veils[i].cover(paths[i]);
}

}  // namespace odis::render
