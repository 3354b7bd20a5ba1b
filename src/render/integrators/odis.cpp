// odis: path tracing guided by what a pilot saw (docs/guiding.md). The library decides what is traced and
// what samples weigh.
#include "render/integrators/frame_integrator.h"
#include "render/integrators/pilot_pass.h"

namespace odis::render {

namespace {

// What a frame is asked for with a guide: with the scene's lights, and the networks that were chosen.
FrameOptions guidedFrameOptions(const RenderJob& job) {
  const RenderOptions& options = job.options();
  FrameOptions frame = frameOptions(job);
  if (options.records) frame.set("pilot-vertices=kept");
  if (options.setting("lights") != "hierarchy" && job.lights().groupCount() > 1) {
    frame.guide.lightGroups = job.lights().groupCount();
    frame.guide.lightParts = job.lights().dividedLights();
  }
  frame.guide.model = options.model;
  return frame;
}

// A vertex whose contributions are relative to its pixel's value.
PathVertex divided(PathVertex v, float pixelValue) {
  v.indirect /= pixelValue;
  v.emission /= pixelValue;
  v.light /= pixelValue;
  return v;
}

class OdisIntegrator : public FrameIntegrator {
 public:
  explicit OdisIntegrator(RenderJob& job) : FrameIntegrator(job, guidedFrameOptions(job)), m_job(job) {}

  bool hasPilot() const override { return true; }
  void render() override {
    FrameIntegrator::render();
    const FrameStatistics all = frame().statistics();
    if (!m_job.interrupted() && all.samples == all.pilotSamples)
      m_job.progress().warn(
          "nothing is guided, this is plain path tracing: all samples are the pilot's (--set pilot-spp)");
  }
  void finish(RenderResult& result) override {
    FrameIntegrator::finish(result);
    const RenderOptions& options = m_job.options();
    if (options.features && options.guideFeatures)
      for (size_t i = 0; i < m_job.crop().pixels(); ++i)
        result.image.guideSamples.push_back(float(frame().sampleCount(m_job.pixelOfCrop(i))));
    if (!options.records) return;
    result.records = recordsOfCrop();
    for (size_t i = 0; i < m_job.crop().pixels(); ++i)
      result.pilotEmitted.push_back(m_job.pilotEmitted[m_job.pixelOfCrop(i)]);
  }

 private:
  // The pilot's vertices, of the crop's pixels, which are counted in the crop.
  std::vector<PathVertex> recordsOfCrop() const {
    const Crop& crop = m_job.crop();
    std::vector<PathVertex> records;
    for (const PathVertex& v : frame().pilotVertices()) {
      const Vec2i at = m_job.tiles().pixelAt(v.pixel) - Vec2i(crop.x, crop.y);
      if (at.x < 0 || at.y < 0 || at.x >= crop.width || at.y >= crop.height) continue;
      records.push_back(divided(v, frame().pixelValues()[v.pixel]));
      records.back().pixel = uint32_t(at.y * crop.width + at.x);
    }
    return records;
  }

  RenderJob& m_job;
};

}  // namespace

std::unique_ptr<Integrator> makeOdisIntegrator(RenderJob& job) {
  return std::make_unique<OdisIntegrator>(job);
}

PilotPass renderPilot(const Scene& scene, const RenderOptions& options, Progress& progress) {
  if (options.integrator != IntegratorKind::odis)
    throw OptionError("--integrator: expected odis, others have no pilot");
  const ThreadLimit limit(options.threads);
  RenderJob job(scene, options, progress);
  FrameOptions frame = guidedFrameOptions(job);
  frame.set("pilot-vertices=kept");
  FrameIntegrator integrator(job, frame);
  integrator.tracePilot();
  const ArrayView<const PixelSums> image = integrator.frame().pilotImage();
  const ArrayView<const float> values = integrator.frame().pixelValues();
  return {{image.begin(), image.end()},
          integrator.frame().pilotVertices(),
          {values.begin(), values.end()},
          frame.guide.set(frame.settings),
          job.stop()};
}

}  // namespace odis::render
