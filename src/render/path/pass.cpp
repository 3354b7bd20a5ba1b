#include "render/path/pass.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <xmmintrin.h>

namespace odis::render {

namespace {

// A tile's paths are traced in batches of at least this size, but for the last one. In larger ones packets of
// rays and columns are fuller at later bounces, but less of them stays in the second-level cache.
constexpr size_t kLeastPaths = 512;

// Denormal numbers are slow and mean nothing here: flushed to zero (bit 15) and taken as zero (bit 6).
void flushDenormals() {
  _mm_setcsr(_mm_getcsr() | 0x8040u);
}

// The samples of a pixel that are still to be traced.
struct PixelSamples {
  uint32_t pixel;
  Vec2i at;  // on the film
  SampleRange samples;
};

// Those of the pixels of a tile that have any.
std::vector<PixelSamples> samplesOfTile(const Pass& pass, const SampledTiles& tiles, uint32_t tile) {
  std::vector<PixelSamples> pixels;
  tiles.forEachPixel(tile, [&](uint32_t pixel) {
    if (const SampleRange samples = pass.samples(pixel); samples.count > 0)
      pixels.push_back({pixel, tiles.pixelAt(pixel), samples});
  });
  return pixels;
}

// The paths that are being traced and what a tile's samples brought; kept from tile to tile for its memory.
struct TileResult {
  std::vector<Path> paths;
  std::vector<Vec2i> places;   // of their pixels on the film
  std::vector<float> weights;  // of their samples in the image
  std::vector<FrameSample> samples;
  std::vector<PathVertex> vertices;
  RayCounts counts;
  std::vector<SplatPlace> splats;
  std::vector<float> colors, features;  // of each splat, the channels of the films

  void clear() {
    clearPaths();
    samples.clear();
    vertices.clear();
    counts = {};
    splats.clear();
    colors.clear();
    features.clear();
  }
  void clearPaths() {
    paths.clear();
    places.clear();
    weights.clear();
  }
};

// Notes what a film that splats adds of a path.
void collectSplat(const Splats& films, const Vec2i& inTile, const Path& path, float weight, const Rgb& value,
                  TileResult& result) {
  result.splats.push_back({path.place, weight, uint16_t(inTile.x), uint16_t(inTile.y)});
  appendColorChannels(value, path.identity.sample, films.colors->channels(), result.colors);
  if (films.features)
    appendFeatureChannels(path.first, path.visible ? path.visibleWeight * path.identity.sampleWeight : 0,
                          result.features);
}

// Adds what traced paths brought.
void collect(const Pass& pass, const Vec2i& corner, TileResult& result) {
  for (size_t i = 0; i < result.paths.size(); ++i) {
    const Path& path = result.paths[i];
    const auto& [pixel, sample, filterWeight] = path.identity;
    // A path that is not a number (a broken normal, an overflow) would spoil its pixel for good: it counts as
    // black.
    const Rgb value = isFinite(path.radiance) ? path.radiance * filterWeight : Rgb(0, 0, 0);
    result.samples.push_back(
        {pixel, sample, toOdis(value), uint32_t(path.counts.rays + path.counts.shadowRays)});
    result.counts.add(path.counts);
    if (pass.emitted) (*pass.emitted)[pixel] += path.emitted * filterWeight;
    if (pass.features)
      (*pass.features)[pixel].add(path.first, path.visible ? path.visibleWeight * filterWeight : 0);
    if (pass.guideFeatures) (*pass.guideFeatures)[pixel].add(path.first);
    if (pass.splats.colors)
      collectSplat(pass.splats, result.places[i] - corner, path, result.weights[i], value, result);
  }
}

// Adds the tile's samples to the films, or keeps them for them.
void splat(const Splats& films, uint32_t tile, const TileResult& result) {
  const auto addTo = [&](SplatFilm& film, std::span<const float> values) {
    if (films.keep)
      film.keep(tile, result.splats, values);
    else
      film.add(tile, result.splats, values);
  };
  if (!films.colors || result.splats.empty()) return;
  addTo(*films.colors, result.colors);
  if (films.features) addTo(*films.features, result.features);
}

// The rest of a camera's ray behind the lights that it meets first, one after another.
Ray beyondEmitters(const Scene& scene, Ray ray) {
  constexpr int kMostLights = 1000;  // so that no scene of coinciding ones takes for ever
  SurfacePoint at;
  for (int i = 0; i < kMostLights && scene.intersect(ray, at) && at.shape->emitter(); ++i) {
    const Ray rest = Scene::spawn(at, ray.direction);
    ray = {rest.origin, ray.direction, ray.tMax - dot(rest.origin - ray.origin, ray.direction), ray.time};
  }
  return ray;
}

// Camera rays of several samples, and what they are drawn by.
struct CameraSamples {
  Column u, v;  // numbers that the reconstruction filter draws the place in the pixel with
  CameraPlaces places;
  CameraRays rays;
  Column weights;  // of the filter
  FilterSamples offsets;

  Ray ray(size_t lane) const {
    return {rays.origin[lane], rays.direction[lane], rays.tMax[lane], places.time[lane]};
  }
};

void drawCameraNumbers(const Scene& scene, const SamplerBlock& samplers, CameraSamples& samples) {
  samplers.draw2D(kPixelNumber, samples.u, samples.v);
  CameraPlaces& places = samples.places;
  if (scene.sensor().readsLens()) samplers.draw2D(kLensNumber, places.lensU, places.lensV);
  if (scene.moves())
    samplers.draw1D(kTimeNumber, places.time);
  else
    places.time = {};
}

// The path of a sample of a pixel, which lies at `at` on the film; addCameraRays() gives it its ray.
inline __attribute__((always_inline)) Path pathWithoutRay(const Pass& pass, uint32_t pixel, Vec2i at,
                                                          uint32_t sample) {
  const Scene& scene = *pass.path.scene;
  const uint32_t place = samplerPixel(scene.film(), pass.film, at);
  Path path({Vec3(0, 0, 0), Vec3(0, 0, 1)}, {pass.sampler, pass.seed, place, sample, pass.redrawn});
  path.hidesEnvironment = scene.integrator().hideEmitters;
  path.visible = !pass.path.features || (!path.hidesEnvironment && !scene.environments().empty());
  path.identity = {pixel, sample, 1};
  if (!pass.pixelValues.empty()) path.pixelValue = pass.pixelValues[pixel];
  return path;
}

// Near the film's border, makes the numbers of samples draw places on it. Sets weights to what those of the
// filter are to be multiplied by.
void keepOnFilm(const FilmSettings& film, std::span<const Vec2i> pixels, CameraSamples& samples) {
  const int reach = film.sampleBorder ? 0 : film.filter->reach();
  for (size_t i = 0; i < pixels.size(); ++i) {
    samples.weights[i] = 1;
    const Vec2i& before = pixels[i];
    const Vec2i after(film.width - 1 - before.x, film.height - 1 - before.y);
    if (std::min({before.x, before.y, after.x, after.y}) >= reach) continue;
    const FilterPart x = film.filter->part(before.x, after.x), y = film.filter->part(before.y, after.y);
    samples.u[i] = x.number(samples.u[i]);
    samples.v[i] = y.number(samples.v[i]);
    samples.weights[i] = x.weight * y.weight;
  }
}

// Draws the places of samples in their pixels, from the filter or, for a film that splats, uniform in the
// pixel.
void drawPlaces(const FilmSettings& film, FilmKind kind, std::span<const Vec2i> pixels,
                CameraSamples& samples) {
  if (kind == FilmKind::pixels) {
    keepOnFilm(film, pixels, samples);
    return film.filter->sampleEach(pixels.size(), samples.u, samples.v, samples.offsets);
  }
  for (size_t i = 0; i < pixels.size(); ++i) {
    samples.offsets.x[i] = samples.u[i] - 0.5f;
    samples.offsets.y[i] = samples.v[i] - 0.5f;
    samples.offsets.weight[i] = samples.weights[i] = 1;
  }
}

// Finds the rays of samples, whose numbers are drawn and whose pixels lie there on the film.
void findCameraRays(const Scene& scene, FilmKind film, std::span<const Vec2i> pixels,
                    CameraSamples& samples) {
  const Sensor& sensor = scene.sensor();
  CameraPlaces& places = samples.places;
  const FilterSamples& offsets = samples.offsets;
  drawPlaces(scene.film(), film, pixels, samples);
  for (size_t i = 0; i < pixels.size(); ++i) {
    places.filmX[i] = float(pixels[i].x) + 0.5f + offsets.x[i];
    places.filmY[i] = float(pixels[i].y) + 0.5f + offsets.y[i];
    samples.weights[i] *= offsets.weight[i] * sensor.weight(places.film(i));
  }
  sensor.rays(pixels.size(), places, samples.rays);
}

// The same ray, behind the lights if the integrator hides them. Paths through media pass them by themselves.
Ray seen(const Scene& scene, const Ray& ray) {
  return scene.integrator().hideEmitters && !scene.volumetric() ? beyondEmitters(scene, ray) : ray;
}

// Gives paths, whose pixels lie there on the film, their camera rays, several at once.
void addCameraRays(const Scene& scene, FilmKind film, std::span<Path> paths, std::span<const Vec2i> pixels) {
  for (size_t begin = 0; begin < paths.size(); begin += SamplerBlock::kSize) {
    const auto some = paths.subspan(begin, std::min(SamplerBlock::kSize, paths.size() - begin));
    SamplerBlock samplers;
    for (const Path& path : some) samplers.add(path.sampler);
    CameraSamples samples;
    drawCameraNumbers(scene, samplers, samples);
    findCameraRays(scene, film, pixels.subspan(begin, some.size()), samples);
    for (size_t i = 0; i < some.size(); ++i) {
      some[i].ray = seen(scene, samples.ray(i));
      some[i].identity.sampleWeight = samples.weights[i];
      some[i].place = Vec2(samples.offsets.x[i], samples.offsets.y[i]);
    }
  }
}

// Traces all samples of a tile: two of each pixel at a time, or more where few pixels are left.
void renderTile(const Pass& pass, const SampledTiles& tiles, uint32_t tile, TileResult& result) {
  std::vector<PixelSamples> left = samplesOfTile(pass, tiles, tile);
  std::vector<Path>& paths = result.paths;
  while (!left.empty()) {
    for (auto& [pixel, at, samples] : left) {
      paths.push_back(pathWithoutRay(pass, pixel, at, samples.first++));
      result.places.push_back(at);
      result.weights.push_back(samples.weight);
      --samples.count;
    }
    std::erase_if(left, [](const PixelSamples& p) { return p.samples.count == 0; });
    if (!left.empty() && paths.size() < kLeastPaths) continue;
    addCameraRays(*pass.path.scene, pass.film, paths, result.places);
    if (pass.firstHitsOnly)
      traceFirstHits(pass.path, paths);
    else
      tracePaths(pass.path, paths, pass.wantsVertices ? &result.vertices : nullptr);
    collect(pass, tiles.corner(tile), result);
    result.clearPaths();
  }
  splat(pass.splats, tile, result);
}

}  // namespace

// Pixels beyond the film's border, which a film that splats may ask for, have numbers of their own.
uint32_t samplerPixel(const FilmSettings& film, FilmKind kind, const Vec2i& at) {
  const int beyond = kind == FilmKind::splat && film.sampleBorder ? film.filter->reach() : 0;
  return uint32_t(at.y + beyond) * uint32_t(film.width + 2 * beyond) + uint32_t(at.x + beyond);
}

CameraNumbers cameraNumbers(const Scene& scene, const Sampler& sampler) {
  SamplerBlock block;
  block.add(sampler);
  CameraSamples samples{};
  drawCameraNumbers(scene, block, samples);
  return {{samples.u[0], samples.v[0]}, samples.places.lens(0), samples.places.time[0]};
}

CameraRay cameraRay(const Scene& scene, FilmKind film, Vec2i pixel, const CameraNumbers& numbers) {
  CameraSamples samples{};
  samples.u[0] = numbers.pixel.x;
  samples.v[0] = numbers.pixel.y;
  samples.places.lensU[0] = numbers.lens.x;
  samples.places.lensV[0] = numbers.lens.y;
  samples.places.time[0] = numbers.time;
  findCameraRays(scene, film, {&pixel, 1}, samples);
  return {seen(scene, samples.ray(0)), samples.weights[0], Vec2(samples.offsets.x[0], samples.offsets.y[0])};
}

Path cameraPath(const Pass& pass, uint32_t pixel, uint32_t sample) {
  const Vec2i at = pass.sampledTiles().pixelAt(pixel);
  Path path = pathWithoutRay(pass, pixel, at, sample);
  addCameraRays(*pass.path.scene, pass.film, {&path, 1}, {&at, 1});
  return path;
}

RayCounts runPass(const Pass& pass, Progress& progress, const std::function<bool()>& stop) {
  const SampledTiles tiles = pass.sampledTiles();
  std::vector<RayCounts> counts(tiles.count());
  tbb::parallel_for(
      tbb::blocked_range<uint32_t>(0, tiles.count(), 1),
      [&](const tbb::blocked_range<uint32_t>& range) {
        flushDenormals();
        for (uint32_t tile = range.begin(); tile < range.end(); ++tile) {
          if (stop()) return;
          thread_local TileResult result;
          result.clear();
          renderTile(pass, tiles, tile, result);
          pass.deliver(tile, result.samples, result.vertices);
          counts[tile] = result.counts;
          progress.advance(result.samples.size());
        }
      },
      tbb::simple_partitioner());
  RayCounts total;
  for (const RayCounts& tile : counts) total.add(tile);
  return total;
}

}  // namespace odis::render
