#include "render/integrators/job.h"

#include <tbb/info.h>

namespace odis::render {

RenderJob::RenderJob(const Scene& scene, const RenderOptions& options, Progress& progress)
    : m_scene(scene),
      m_options(options),
      m_film(filmKindFor(*scene.film().filter, options.film)),
      m_tiles(sampledPixels(scene.film(), m_film), m_film),
      m_progress(progress),
      m_lights(scene.emitters()),
      m_start(std::chrono::steady_clock::now()) {
  if (options.features && m_film == FilmKind::splat)
    featureFilm = std::make_unique<SplatFilm>(scene.film(), m_tiles, kFeatureChannels);
  else if (options.features)
    features.resize(pixelCount());
  if (options.features && options.guideFeatures) guideFeatures.resize(pixelCount());
  if (options.records) pilotEmitted.assign(pixelCount(), Rgb(0, 0, 0));
}

uint32_t RenderJob::pixelOfCrop(size_t index) const {
  const int x = int(index) % crop().width, y = int(index) / crop().width;
  return pixelIndex(Vec2i(crop().x + x, crop().y + y));
}

std::unique_ptr<SplatFilm> RenderJob::newColorFilm() const {
  if (m_film == FilmKind::pixels) return nullptr;
  return std::make_unique<SplatFilm>(m_scene.film(), m_tiles, colorChannels(m_options.variance));
}

Pass RenderJob::pass() {
  Pass pass;
  pass.path.scene = &m_scene;
  pass.path.lights = &m_lights;
  pass.path.maxDepth = m_options.maxDepth;
  pass.path.rrDepth = m_options.rrDepth;
  pass.path.guideBounces = int(m_options.settingNumber("guide-bounces"));
  pass.path.features = m_options.features;
  pass.path.guideFeatures = m_options.guideFeatures;
  pass.sampler = m_options.sampler;
  pass.seed = m_options.seed;
  pass.tiles = m_tiles;
  pass.film = m_film;
  pass.features = features.empty() ? nullptr : &features;
  pass.guideFeatures = guideFeatures.empty() ? nullptr : &guideFeatures;
  pass.splats.features = featureFilm.get();
  return pass;
}

void RenderJob::run(const Pass& pass) {
  count(runPass(pass, m_progress, stopFunction()));
}

void RenderJob::count(const RayCounts& counts) {
  stats.rays += counts.rays;
  stats.shadowRays += counts.shadowRays;
}

bool RenderJob::stop() {
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - m_start;
  if (m_progress.cancelled() || (m_options.timeLimit > 0 && elapsed.count() > m_options.timeLimit))
    m_stopped = true;
  return m_stopped;
}

std::function<bool()> RenderJob::stopFunction() {
  return [this] { return stop(); };
}

ThreadLimit::ThreadLimit(int threads)
    : m_control(tbb::global_control::max_allowed_parallelism,
                size_t(threads > 0 ? threads : tbb::info::default_concurrency())) {}

}  // namespace odis::render
