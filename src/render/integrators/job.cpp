#include "render/integrators/job.h"

#include <tbb/info.h>

namespace odis::render {

RenderJob::RenderJob(const Scene& scene, const RenderOptions& options, Progress& progress)
    : m_scene(scene),
      m_options(options),
      m_progress(progress),
      m_lights(scene.emitters()),
      m_start(std::chrono::steady_clock::now()) {
  if (options.features) features.resize(pixelCount());
  if (options.records) pilotEmitted.assign(pixelCount(), Rgb(0, 0, 0));
}

uint32_t RenderJob::pixelIndex(Vec2i pixel) const {
  return uint32_t(pixel.y - crop().y) * uint32_t(crop().width) + uint32_t(pixel.x - crop().x);
}

Pass RenderJob::pass() {
  Pass pass;
  pass.path.scene = &m_scene;
  pass.path.lights = &m_lights;
  pass.path.maxDepth = m_options.maxDepth;
  pass.path.rrDepth = m_options.rrDepth;
  pass.path.guideBounces = m_options.guideBounces;
  pass.path.features = m_options.features;
  pass.path.guideFeatures = m_options.guideFeatures;
  pass.sampler = m_options.sampler;
  pass.seed = m_options.seed;
  pass.features = m_options.features ? &features : nullptr;
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
