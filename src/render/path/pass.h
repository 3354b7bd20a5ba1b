// A pass over the image: some samples of every pixel, in parallel over tiles.
#pragma once

#include <odis/odis.hpp>

#include <functional>

#include "render/film/splat_film.h"
#include "render/path/path.h"
#include "render/path/progress.h"
#include "render/sampler/sampler_block.h"

namespace odis::render {

// Path vertices, an array for each tile.
using TileVertices = std::vector<std::vector<PathVertex>>;

// What a film that splats gathers of a pass. Places are uniform in pixels then.
struct Splats {
  SplatFilm* colors = nullptr;    // with the channels of colorChannels()
  SplatFilm* features = nullptr;  // with those of kFeatureChannels; null: not wanted
  bool keep = false;              // whether weights are not known before the pass has ended
};
// R, G, B and 1 of all samples, and with `halves` the same of every other sample of a pixel.
inline SplatChannels colorChannels(bool halves) {
  const int count = halves ? 8 : 4;
  return {count, count};
}
// Appends the channels of a pixel's sample number `sample`.
inline void appendColorChannels(const Rgb& value, uint32_t sample, int count, std::vector<float>& channels) {
  const float all[4] = {value.x, value.y, value.z, 1};
  const size_t at = channels.size();
  channels.resize(at + size_t(count));  // zeros
  std::copy(all, all + 4, &channels[at]);
  if (count > 4 && sample % 2) std::copy(all, all + 4, &channels[at + 4]);
}

struct Pass {
  PathSettings path;
  // The pixels that are traced; those of the film's crop unless told otherwise. Pixels are counted in these.
  std::optional<SampledTiles> tiles;
  SamplerKind sampler = SamplerKind::sobol;
  uint64_t seed = 0;
  FilmKind film = FilmKind::pixels;
  Splats splats;  // of a film that splats; without films nothing is splatted
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
  std::vector<GuideFeatureSums>* guideFeatures = nullptr;
  std::vector<Rgb>* emitted = nullptr;

  SampledTiles sampledTiles() const { return tiles ? *tiles : SampledTiles(path.scene->film().crop, film); }
};

// Runs the pass; tiles that had not begun when `stop` first answered true are left out. Returns the rays
// traced.
RayCounts runPass(const Pass& pass, Progress& progress, const std::function<bool()>& stop);

// The path of a sample of a pixel, before it is traced. For a film whose pixels are independent the position
// in the pixel is drawn from the reconstruction filter, whose weight is the path's.
Path cameraPath(const Pass& pass, uint32_t pixel, uint32_t sample);

// The random numbers of a camera ray, uniform in [0, 1).
struct CameraNumbers {
  Vec2 pixel, lens;  // where in the pixel; through which point of the lens, if the sensor reads that
  float time = 0;    // when, where something moves; else 0
};
CameraNumbers cameraNumbers(const Scene& scene, const Sampler& sampler);
// The camera ray of a sample of a pixel of the full image.
struct CameraRay {
  Ray ray;
  float weight;  // of the filter and the sensor
  Vec2 place;    // on the film, from the centre of the pixel
};
CameraRay cameraRay(const Scene& scene, FilmKind film, Vec2i pixel, const CameraNumbers& numbers);
// The number that a sampler knows a pixel of the full image by.
uint32_t samplerPixel(const FilmSettings& film, FilmKind kind, const Vec2i& at);

}  // namespace odis::render
