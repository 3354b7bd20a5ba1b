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

void accumulate(FeatureSums& sums, const FirstHit& first) {
  if (!first.valid) return;
  sums.albedo += first.albedo;
  sums.normal += first.normal;
  sums.geometricNormal += first.geometricNormal;
  sums.position += first.position;
  sums.depth += first.depth;
  sums.roughness += first.roughness;
  ++sums.hits;
}

void renderPixel(const Pass& pass, uint32_t index, std::vector<PilotVertex>& records, RayCounts& counts) {
  const Crop& crop = pass.path.scene->film().crop;
  const Vec2i pixel(crop.x + int(index) % crop.width, crop.y + int(index) / crop.width);
  const uint32_t pixelOfFullImage =
      uint32_t(pixel.y) * uint32_t(pass.path.scene->film().width) + uint32_t(pixel.x);
  const auto [first, count] = pass.samples(index);
  for (uint32_t sample = first; sample < first + count; ++sample) {
    Sampler sampler(pass.sampler, pass.seed, pixelOfFullImage, sample);
    float filterWeight;
    const Ray ray = cameraRay(*pass.path.scene, pixel, sampler, filterWeight);
    FirstHit firstHit;
    const size_t begin = records.size();
    const PathResult path = tracePath(pass.path, ray, sampler, counts, pass.records ? &records : nullptr,
                                      pass.features ? &firstHit : nullptr);
    for (size_t i = begin; i < records.size(); ++i) {
      records[i].pixel = index;
      records[i].sampleWeight = filterWeight;
    }
    // A path that is not a number (a broken normal, an overflow) would spoil its pixel for good: it counts as
    // black.
    const Rgb value = isFinite(path.radiance) ? path.radiance * filterWeight : Rgb(0, 0, 0);
    if (pass.image) {
      PixelSums& sums = (*pass.image)[index];
      const Rgbd v(value.x, value.y, value.z);
      sums.sum += v;
      sums.sumSquares += v * v;
      ++sums.count;
    }
    if (pass.emitted) (*pass.emitted)[index] += path.emitted * filterWeight;
    if (pass.features) accumulate((*pass.features)[index], firstHit);
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
  std::vector<RayCounts> counts(size_t(tilesX) * tilesY);
  const size_t firstRecords = pass.records ? pass.records->size() : 0;
  if (pass.records) pass.records->resize(firstRecords + counts.size());
  tbb::parallel_for(
      tbb::blocked_range<size_t>(0, counts.size(), 1),
      [&](const tbb::blocked_range<size_t>& range) {
        flushDenormals();
        for (size_t t = range.begin(); t < range.end(); ++t) {
          if (stop()) return;
          const int x0 = int(t % tilesX) * kTileSize, y0 = int(t / tilesX) * kTileSize;
          // Records are gathered in memory that stays warm, then stored without slack.
          thread_local std::vector<PilotVertex> records;
          records.clear();
          uint64_t done = 0;
          for (int y = y0; y < std::min(y0 + kTileSize, crop.height); ++y)
            for (int x = x0; x < std::min(x0 + kTileSize, crop.width); ++x) {
              const uint32_t index = uint32_t(y) * uint32_t(crop.width) + uint32_t(x);
              renderPixel(pass, index, records, counts[t]);
              done += pass.samples(index).second;
            }
          if (pass.records) (*pass.records)[firstRecords + t].assign(records.begin(), records.end());
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
