#include "render/integrator/pass.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <xmmintrin.h>

namespace odis::render {

namespace {

constexpr int kTileSize = 16;

// Denormal numbers are slow and mean nothing here: flushed to zero (bit 15) and taken as zero (bit 6).
void flushDenormals() {
  _mm_setcsr(_mm_getcsr() | 0x8040u);
}

// The pixels of a tile in blocks of 4 x 4, so that neighbours in the list are neighbours in the image.
std::vector<uint32_t> pixelsOfTile(const Crop& crop, int x0, int y0) {
  constexpr int kBlock = 4;
  std::vector<uint32_t> pixels;
  for (int i = 0; i < kTileSize * kTileSize; ++i) {
    const int block = i / (kBlock * kBlock), within = i % (kBlock * kBlock);
    const int x = x0 + block % (kTileSize / kBlock) * kBlock + within % kBlock;
    const int y = y0 + block / (kTileSize / kBlock) * kBlock + within / kBlock;
    if (x < crop.width && y < crop.height) pixels.push_back(uint32_t(y) * uint32_t(crop.width) + uint32_t(x));
  }
  return pixels;
}

// Adds what a path brought to its pixel.
void deliver(const Pass& pass, const Path& path, uint32_t pixel, float filterWeight) {
  // A path that is not a number (a broken normal, an overflow) would spoil its pixel for good: it counts as
  // black.
  const Rgb value = isFinite(path.radiance) ? path.radiance * filterWeight : Rgb(0, 0, 0);
  if (pass.image) (*pass.image)[pixel].add(value, path.counts.rays + path.counts.shadowRays);
  if (pass.emitted) (*pass.emitted)[pixel] += path.emitted * filterWeight;
  if (pass.features) (*pass.features)[pixel].add(path.first);
}

// All samples of a tile, one of each pixel at a time, or several where few pixels are left that have one; appends their vertices
// to `records` if it is given.
// Returns how many samples they were.
uint64_t renderTile(const Pass& pass, const PathSettings& settings, int x0, int y0,
                    std::vector<PilotVertex>* records, RayCounts& counts) {
  const FilmSettings& film = settings.scene->film();
  const std::vector<uint32_t> pixels = pixelsOfTile(film.crop, x0, y0);
  uint64_t done = 0;
  std::vector<Path> paths;
  std::vector<std::pair<uint32_t, float>> targets;  // pixel and weight of each path
  for (uint32_t round = 0;; ++round) {
    const size_t before = paths.size();
    for (const uint32_t index : pixels) {
      const auto [first, count] = pass.samples(index);
      if (round >= count) continue;
      const Vec2i pixel(film.crop.x + int(index) % film.crop.width,
                        film.crop.y + int(index) / film.crop.width);
      Sampler sampler(pass.sampler, pass.seed, uint32_t(pixel.y) * uint32_t(film.width) + uint32_t(pixel.x),
                      first + round, pass.redrawn);
      float filterWeight;
      const Ray ray = cameraRay(*settings.scene, pixel, sampler, filterWeight);
      paths.emplace_back(ray, sampler);
      if (!pass.pixelValues.empty()) paths.back().pixelValue = pass.pixelValues[index];
      targets.emplace_back(index, filterWeight);
    }
    const bool last = paths.size() == before;
    if (!last && paths.size() < pixels.size()) continue;
    size_t vertex = records ? records->size() : 0;
    tracePaths(settings, paths, records);
    for (size_t i = 0; i < paths.size(); ++i) {
      const auto [pixel, filterWeight] = targets[i];
      deliver(pass, paths[i], pixel, filterWeight);
      counts.rays += paths[i].counts.rays;
      counts.shadowRays += paths[i].counts.shadowRays;
      for (uint32_t v = 0; v < paths[i].recorded; ++v, ++vertex) {
        (*records)[vertex].pixel = pixel;
        (*records)[vertex].sampleWeight = filterWeight;
      }
    }
    done += paths.size();
    if (last) return done;
    paths.clear();
    targets.clear();
  }
}

}  // namespace

Ray cameraRay(const Scene& scene, Vec2i pixel, Sampler& sampler, float& filterWeight) {
  const FilterSample offset = scene.film().filter->sample(sampler.get2D());
  filterWeight = offset.weight;
  return scene.sensor().ray(Vec2(pixel.x + 0.5f, pixel.y + 0.5f) + offset.offset, sampler.get2D());
}

RayCounts runPass(const Pass& pass, Progress& progress, const std::function<bool()>& stop) {
  const Crop& crop = pass.path.scene->film().crop;
  const int tilesX = (crop.width + kTileSize - 1) / kTileSize,
            tilesY = (crop.height + kTileSize - 1) / kTileSize;
  PathSettings settings = pass.path;
  settings.features = pass.features != nullptr;
  std::vector<RayCounts> counts(size_t(tilesX) * tilesY);
  const size_t firstRecords = pass.records ? pass.records->size() : 0;
  if (pass.records) pass.records->resize(firstRecords + counts.size());
  if (pass.learner) pass.digests->resize(counts.size());
  tbb::parallel_for(
      tbb::blocked_range<size_t>(0, counts.size(), 1),
      [&](const tbb::blocked_range<size_t>& range) {
        flushDenormals();
        for (size_t t = range.begin(); t < range.end(); ++t) {
          if (stop()) return;
          // Records are gathered in memory that stays warm, then stored without slack.
          thread_local std::vector<PilotVertex> records;
          records.clear();
          const uint64_t done = renderTile(pass, settings, int(t % size_t(tilesX)) * kTileSize,
                                           int(t / size_t(tilesX)) * kTileSize,
                                           pass.records || pass.learner ? &records : nullptr, counts[t]);
          if (pass.records) (*pass.records)[firstRecords + t].assign(records.begin(), records.end());
          if (pass.learner) (*pass.digests)[t] = pass.learner->digest(records);
          progress.advance(done);
        }
      },
      tbb::simple_partitioner());

  RayCounts total;
  for (const RayCounts& tile : counts) {
    total.rays += tile.rays;
    total.shadowRays += tile.shadowRays;
  }
  return total;
}

}  // namespace odis::render
