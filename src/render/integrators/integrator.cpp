#include "render/integrators/integrator.h"

#include <algorithm>

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

MeanOfSamples meanOfParts(ArrayView<const WeightedSums> parts) {
  MeanOfSamples result{weightedMean(parts)};
  for (const WeightedSums& part : parts)
    if (part.weight > 0) result.samples += part.sums->count;
  return result;
}

void fillPixels(RenderResult& result, const RenderOptions& options,
                const std::function<MeanOfSamples(uint32_t pixel)>& mean) {
  RenderedImage& image = result.image;
  const auto pixels = uint32_t(image.width * image.height);
  uint32_t& fewest = result.stats.fewestSamples = ~uint32_t(0);
  for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
    const auto [value, samples] = mean(pixel);
    fewest = std::min(fewest, samples);
    image.color.push_back(toRgb(value.color));
    if (options.variance) image.variance.push_back(toRgb(value.variance));
  }
}

void fillPixels(RenderResult& result, const SplatFilm& film) {
  fillPixels(result, film.sums(), film.channels());
}

void fillPixels(RenderResult& result, std::span<const float> sums, int channels) {
  uint32_t& fewest = result.stats.fewestSamples = 2;
  for (const float* pixel = sums.data(); pixel < sums.data() + sums.size(); pixel += channels) {
    const Rgb all(pixel[0], pixel[1], pixel[2]);
    const float weight = pixel[3];
    if (weight == 0) fewest = 0;
    result.image.color.push_back(weight != 0 ? all / weight : Rgb(0, 0, 0));
    if (channels == 4) continue;
    const Rgb half(pixel[4], pixel[5], pixel[6]);
    const float halfWeight = pixel[7], otherWeight = weight - halfWeight;
    const bool known = halfWeight > 0 && otherWeight > 0;
    if (!known) fewest = std::min(fewest, 1u);
    const Rgb difference = known ? half / halfWeight - (all - half) / otherWeight : Rgb(0, 0, 0);
    result.image.variance.push_back(difference * difference * (halfWeight * otherWeight / sqr(weight)));
  }
}

}  // namespace odis::render
