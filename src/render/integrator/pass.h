// A pass over the image: so many samples for every pixel, in parallel over tiles.
#pragma once

#include <atomic>
#include <functional>

#include "render/integrator/path.h"
#include "render/integrator/render.h"

namespace odis::render {

// Sums over the samples of each pixel. 56 bytes a pixel.
struct PixelSums {
  Rgbd sum{0, 0, 0};
  Rgbd sumSquares{0, 0, 0};
  uint32_t count = 0;
  uint32_t rays = 0;  // of them all, shadow rays included

  void add(const Rgb& value, uint64_t raysOfSample) {
    const Rgbd v(value.x, value.y, value.z);
    add({v, v * v, 1, uint32_t(raysOfSample)});
  }
  void add(const PixelSums& other) {
    sum += other.sum;
    sumSquares += other.sumSquares;
    count += other.count;
    rays += other.rays;
  }
};

// Pilot vertices, an array for each tile.
using Records = std::vector<std::vector<PilotVertex>>;

struct Pass {
  PathSettings path;
  SamplerKind sampler = SamplerKind::sobol;
  uint64_t seed = 0;
  // The samples [first, first + count) of a pixel, given its index; must not depend on what samples of that pixel brought.
  std::function<std::pair<uint32_t, uint32_t>(uint32_t pixel)> samples;
  Purposes redrawn = 0;  // independent numbers for these are others than without it

  std::span<const float> pixelValues;  // about what each pixel's luminance is; for learned roulette only

  // Where results go; images have one entry a pixel of the crop. Null: not wanted.
  std::vector<PixelSums>* image = nullptr;
  std::vector<FeatureSums>* features = nullptr;
  Records* records = nullptr;  // one array a tile is appended
  // The same, but only what this builder takes of the vertices is kept.
  const GuideBuilder* learner = nullptr;
  std::vector<PilotDigest>* digests = nullptr;
  std::vector<Rgb>* emitted = nullptr;
};

// Runs the pass; tiles that had not begun when `stop` first answered true are left out. Returns the rays
// traced.
RayCounts runPass(const Pass& pass, Progress& progress, const std::function<bool()>& stop);

// The camera ray of a sample: its position in the pixel drawn from the reconstruction filter, whose weight is
// returned.
Ray cameraRay(const Scene& scene, Vec2i pixel, Sampler& sampler, float& filterWeight);

}  // namespace odis::render
