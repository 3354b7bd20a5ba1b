#include "render/integrators/render.h"

#include <fmt/format.h>

#include "render/integrators/integrator.h"
#include "render/integrators/sample_image.h"
#include "render/path/path_text.h"

namespace odis::render {

bool isGuiding(const RenderOptions& options) {
  return options.integrator == IntegratorKind::odis &&
         (options.settingNumber("cells") > 0 || options.setting("pixel-maps") != "none");
}

bool isCaching(const RenderOptions& options) {
  return options.integrator == IntegratorKind::odis && options.setting("cached") == "on" &&
         options.settingNumber("cells") > 0 &&
         (options.maxDepth < 0 || options.maxDepth >= ODIS_LEAST_CACHED_MAX_DEPTH);
}

// Fills in the features of the crop's pixels.
static void writeFeatures(const RenderJob& job, bool hasPilot, RenderedImage& image) {
  for (const FeatureSums& sums : job.features) writeFeatures(sums, image);
  if (job.featureFilm) {
    const std::vector<float> sums = job.featureFilm->sums();
    const auto channels = size_t(job.featureFilm->channels());
    for (size_t i = 0; i < sums.size(); i += channels)
      writeFeatures(featureSumsOf({&sums[i], channels}), image);
  }
  if (!job.options().guideFeatures || !hasPilot) return;
  for (size_t i = 0; i < job.crop().pixels(); ++i)
    writeGuideFeatures(job.guideFeatures[job.pixelOfCrop(i)], image);
}

RenderResult render(const Scene& scene, const RenderOptions& options, Progress& progress) {
  const ThreadLimit limit(options.threads);
  RenderJob job(scene, options, progress);
  const std::unique_ptr<Integrator> integrator = makeIntegrator(job);
  integrator->render();

  RenderResult result;
  result.stats = job.stats;
  RenderedImage& image = result.image;
  image.x = job.crop().x;
  image.y = job.crop().y;
  image.width = job.crop().width;
  image.height = job.crop().height;
  if (options.features) writeFeatures(job, integrator->hasPilot(), image);
  integrator->finish(result);
  RenderStats& stats = result.stats;
  stats.spp = double(stats.samples) / double(std::max<size_t>(job.pixelCount(), 1));
  stats.bytesLights = job.lights().bytes();
  stats.interrupted = job.interrupted();
  return result;
}

void renderSamples(const Scene& scene, const RenderOptions& options, Progress& progress,
                   const std::function<void(const SampleRenderer&)>& use) {
  const ThreadLimit limit(options.threads);
  RenderJob job(scene, options, progress);
  const std::unique_ptr<Integrator> integrator = makeIntegrator(job);
  if (integrator->hasPilot() && options.settingNumber("pilot-spp") >= options.spp)
    throw OptionError("--set pilot-spp: all samples are the pilot's, expected fewer");
  Pass pass = integrator->passBefore(0, uint32_t(options.spp) - 1);
  use([&](uint32_t sample, Purposes redrawn) {
    return renderSampleImage(pass, sample, redrawn, progress, job.stopFunction());
  });
}

std::string replay(const Scene& scene, const RenderOptions& options, Vec2i pixel, int sample) {
  const ThreadLimit limit(options.threads);
  Progress quiet;
  RenderJob job(scene, options, quiet);
  const std::unique_ptr<Integrator> integrator = makeIntegrator(job);
  const uint32_t index = job.pixelIndex(pixel);
  const Pass pass = integrator->passBefore(index, uint32_t(sample));
  std::vector<PathVertex> vertices;
  Path path = cameraPath(pass, index, uint32_t(sample));
  tracePaths(pass.path, std::span(&path, 1), &vertices);
  return fmt::format("pixel {},{} sample {}: ", pixel.x, pixel.y, sample) + pathText(path, vertices);
}

}  // namespace odis::render
