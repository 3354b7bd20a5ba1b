#include "render/integrators/sample_image.h"

namespace odis::render {

namespace {

// Makes the seed of numbers that no sample of the image draws.
constexpr uint64_t kSampleImageSeed = 0x73616d706c65ull;

}  // namespace

SampleImage renderSampleImage(Pass pass, uint32_t sample, Purposes redrawn, Progress& progress,
                              const std::function<bool()>& stop) {
  const size_t pixels = pass.sampledTiles().sampled().pixels();
  SampleImage image;
  image.emitted.assign(pixels, Rgb(0, 0, 0));
  image.value.assign(pixels, Rgb(0, 0, 0));
  pass.sampler = SamplerKind::independent;
  pass.redrawn = redrawn;
  pass.seed ^= kSampleImageSeed;
  pass.samples = [sample](uint32_t) { return SampleRange{sample, 1}; };
  pass.wantsVertices = false;
  pass.features = nullptr;
  pass.guideFeatures = nullptr;
  pass.splats = {};
  pass.path.features = false;
  pass.emitted = &image.emitted;
  pass.deliver = [&](uint32_t, ArrayView<const FrameSample> samples, ArrayView<const PathVertex>) {
    for (const FrameSample& s : samples) image.value[s.pixel] = Rgb(s.value.x, s.value.y, s.value.z);
  };
  const RayCounts counts = runPass(pass, progress, stop);
  image.rays = counts.rays + counts.shadowRays;
  return image;
}

}  // namespace odis::render
