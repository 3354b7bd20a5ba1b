#include "render/integrators/integrator.h"

namespace odis::render {

namespace {

Rgb toRgb(const Float3& c) {
  return {c.x, c.y, c.z};
}

}  // namespace

std::unique_ptr<Integrator> makeIntegrator(RenderJob& job) {
  switch (job.options().integrator) {
    case IntegratorKind::path:
      return makePathIntegrator(job);
    case IntegratorKind::ppg:
      return makePpgIntegrator(job);
    case IntegratorKind::openpgl:
      return makeOpenPglIntegrator(job);
    case IntegratorKind::restir:
      return makeRestirIntegrator(job);
    case IntegratorKind::odis:
      break;
  }
  return makeOdisIntegrator(job);
}

void fillPixels(RenderResult& result, const RenderOptions& options,
                const std::function<PixelMean(uint32_t pixel)>& mean) {
  RenderedImage& image = result.image;
  const auto pixels = uint32_t(image.width * image.height);
  for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
    const PixelMean value = mean(pixel);
    image.color.push_back(toRgb(value.color));
    if (options.variance) image.variance.push_back(toRgb(value.variance));
  }
}

}  // namespace odis::render
