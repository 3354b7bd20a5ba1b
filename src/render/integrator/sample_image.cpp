#include "render/integrator/sample_image.h"

namespace odis::render {

SampleImage renderSampleImage(Pass pass, uint32_t sample, Purposes redrawn, Progress& progress,
                              const std::function<bool()>& stop) {
  const Crop& crop = pass.path.scene->film().crop;
  std::vector<PixelSums> sums(size_t(crop.width) * size_t(crop.height));
  SampleImage image;
  image.emitted.assign(sums.size(), Rgb(0, 0, 0));
  pass.sampler = SamplerKind::independent;
  pass.redrawn = redrawn;
  pass.samples = [sample](uint32_t) { return std::pair(sample, 1u); };
  pass.image = &sums;
  pass.emitted = &image.emitted;
  const RayCounts counts = runPass(pass, progress, stop);
  image.rays = counts.rays + counts.shadowRays;
  image.value.reserve(sums.size());
  for (const PixelSums& s : sums) image.value.emplace_back(float(s.sum.x), float(s.sum.y), float(s.sum.z));
  return image;
}

}  // namespace odis::render
