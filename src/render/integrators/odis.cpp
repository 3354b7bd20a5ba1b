// odis: path tracing guided by what a pilot saw (docs/guiding.md). The library decides what is traced and
// what samples weigh; here it is told of the scene's lights and of the options.
#include <algorithm>
#include <cmath>

#include "render/integrators/frame_integrator.h"
#include "render/integrators/pilot_pass.h"

namespace odis::render {

namespace {

// A pixel's noise falls with the root of its number of samples, and so does how far off cached radiance may
// be.
float cachedError(const RenderOptions& options) {
  if (!isCaching(options)) return 0;
  if (options.guideOptions.cachedError > 0) return options.guideOptions.cachedError;
  constexpr float kOfOneSample = 0.6f;
  return kOfOneSample / std::sqrt(float(options.spp));
}

// What guides are built with: the scene's lights, and the networks where they are asked for.
GuideOptions guideOptions(const RenderJob& job) {
  const RenderOptions& options = job.options();
  GuideOptions guide = options.guideOptions;
  if (options.lights != LightChoiceKind::hierarchy && job.lights().groupCount() > 1) {
    guide.lightGroups = job.lights().groupCount();
    guide.lightParts = job.lights().dividedLights();
  }
  guide.cachedError = cachedError(options);
  guide.maxDepth = uint32_t(std::max(options.maxDepth, 0));
  guide.model = options.model;
  if (options.guide != GuideKind::network) guide.model = guide.model.withDirectionFormula();
  if (options.lights != LightChoiceKind::network) guide.model = guide.model.withLightFormula();
  if (guide.pixelMaps == ODIS_PIXEL_MAPS_NETWORK && !options.pixelNetwork.empty())
    guide.model = guide.model.withPixelNetwork(options.pixelNetwork);
  return guide;
}

FrameOptions guidedFrameOptions(const RenderJob& job) {
  const RenderOptions& options = job.options();
  FrameOptions frame = frameOptions(job);
  frame.guided = true;
  frame.adaptive = options.samples != SampleSpread::even;
  frame.pilotSamplesPerPixel = options.pilotSpp;
  frame.pilotWeight = float(options.pilotWeight);
  frame.guidedCost = options.costs.guidedRay;
  frame.builtCellCost = options.costs.builtCell;
  frame.recordedRayCost = options.costs.recordedRay;
  frame.refinementSamples = uint32_t(options.refineSpp);
  const bool oracle =
      options.guide == GuideKind::oracle || options.guideOptions.pixelMaps == ODIS_PIXEL_MAPS_ORACLE;
  frame.oracleSamples = oracle ? uint32_t(options.oracleSpp) : 0;
  frame.keepPilotVertices = options.records;
  frame.guide = guideOptions(job);
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
  frame.keepPilotVertices = true;
  FrameIntegrator integrator(job, frame);
  integrator.tracePilot();
  const ArrayView<const PixelSums> image = integrator.frame().pilotImage();
  const ArrayView<const float> values = integrator.frame().pixelValues();
  return {{image.begin(), image.end()},
          integrator.frame().pilotVertices(),
          {values.begin(), values.end()},
          frame.guide,
          job.stop()};
}

}  // namespace odis::render
