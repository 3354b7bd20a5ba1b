// A pass over the image: some samples of every pixel, in parallel over tiles.
#pragma once

#include <odis/odis.hpp>

#include <functional>

#include "render/path/path.h"
#include "render/path/progress.h"
#include "render/sampler/sampler_block.h"

namespace odis::render {

// Path vertices, an array for each tile.
using TileVertices = std::vector<std::vector<PathVertex>>;

struct Pass {
  PathSettings path;
  SamplerKind sampler = SamplerKind::sobol;
  uint64_t seed = 0;
  // The samples of a pixel, given its index; they must not depend on what samples of that pixel brought.
  std::function<SampleRange(uint32_t pixel)> samples;
  Purposes redrawn = 0;  // independent numbers for these purposes are others than without it

  ArrayView<const float> pixelValues;  // estimates of each pixel's luminance, for roulette; empty: 1

  // Takes what a tile brought: all its samples, and their vertices if they are wanted. Called by many
  // threads.
  std::function<void(uint32_t tile, ArrayView<const FrameSample>, ArrayView<const PathVertex>)> deliver;
  bool wantsVertices = false;
  bool firstHitsOnly = false;  // traceFirstHits() in place of tracePaths(): for `features`, samples are black
  // Further sums, with one entry a pixel of the crop. Null: not wanted.
  std::vector<FeatureSums>* features = nullptr;
  std::vector<Rgb>* emitted = nullptr;
};

// Runs the pass; tiles that had not begun when `stop` first answered true are left out. Returns the rays
// traced.
RayCounts runPass(const Pass& pass, Progress& progress, const std::function<bool()>& stop);

// The number of a crop's tiles.
uint32_t tileCount(const Crop& crop);

// The path of a sample of a pixel, before it is traced. The position in the pixel is drawn from the
// reconstruction filter, whose weight is the path's.
Path cameraPath(const Pass& pass, uint32_t pixel, uint32_t sample);

// The random numbers of a camera ray, uniform in [0, 1).
struct CameraNumbers {
  Vec2 pixel, lens;  // where in the pixel; through which point of the lens, if the sensor reads that
  float time = 0;    // when, where something moves; else 0
};
CameraNumbers cameraNumbers(const Scene& scene, const Sampler& sampler);
// The camera ray of a sample; the filter's weight is returned.
Ray cameraRay(const Scene& scene, Vec2i pixel, const CameraNumbers& numbers, float& filterWeight);

}  // namespace odis::render
