#include "render/rivals/restir.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "render/math/warp.h"
#include "render/rivals/restir_trace.h"

namespace odis::render {

namespace {

// Streams of random numbers beside the camera paths'.
constexpr uint64_t kBeyondSeed = 0x6265796f6e64ull, kReuseSeed = 0x7265757365ull, kTimeSeed = 0x74696d65ull;
// Neighbours whose surface faces elsewhere by more than that are not asked: their samples seldom fit.
constexpr float kLeastCosine = 0.9f;

struct FramePixel {
  RestirPath path;
  Contribution own;  // of its sample, to itself
  float filterWeight = 1;
  Vec2 place;  // on the film, from the pixel's centre
};

class ReusedFrame {
 public:
  ReusedFrame(const Pass& pass, const RestirOptions& options, uint32_t sample)
      : m_pass(pass),
        m_scene(*pass.path.scene),
        m_options(options),
        m_sample(sample),
        m_tiles(pass.sampledTiles()),
        m_time(m_scene.moves() ? samplerOf(0, kTimeSeed).get1D() : 0),
        m_pixels(m_tiles.sampled().pixels()) {}

  size_t pixelCount() const { return m_pixels.size(); }

  // The pixel's own path.
  void trace(size_t index) {
    FramePixel& pixel = m_pixels[index];
    const Sampler sampler = samplerOf(index, 0);
    CameraNumbers numbers = cameraNumbers(m_scene, sampler);
    numbers.time = m_time;
    const CameraRay camera = cameraRay(m_scene, m_pass.film, m_tiles.pixelAt(uint32_t(index)), numbers);
    pixel.filterWeight = camera.weight;
    pixel.place = camera.place;
    pixel.path = traceRestirPath(m_pass.path, camera.ray, sampler, samplerOf(index, kBeyondSeed));
    if (pixel.path.sample.valid) pixel.own = contributionOf(pixel.path.sample, pixel.path.point);
  }

  // Its radiance, with what resampling gives; traces shadow rays.
  Rgb gather(size_t index, RayCounts& counts) const {
    const FramePixel& pixel = m_pixels[index];
    Rgb radiance = pixel.path.radiance;
    if (pixel.path.point.valid) radiance += resample(index, counts);
    return isFinite(radiance) ? radiance * pixel.filterWeight : Rgb(0, 0, 0);
  }
  const RayCounts& counts(size_t index) const { return m_pixels[index].path.counts; }

  // Adds the values of a tile's pixels to a film that splats.
  void splat(uint32_t tile, std::span<const Rgb> values, SplatFilm& film) const {
    std::vector<SplatPlace> places;
    std::vector<float> colors;
    m_tiles.forEachPixel(tile, [&](uint32_t pixel) {
      const Vec2i inTile = m_tiles.pixelAt(pixel) - m_tiles.corner(tile);
      places.push_back({m_pixels[pixel].place, 1, uint16_t(inTile.x), uint16_t(inTile.y)});
      appendColorChannels(values[pixel], m_sample, film.channels(), colors);
    });
    film.add(tile, places, colors);
  }
  uint32_t tileCount() const { return m_tiles.count(); }

 private:
  Sampler samplerOf(size_t index, uint64_t stream) const {
    const uint32_t pixel = samplerPixel(m_scene.film(), m_pass.film, m_tiles.pixelAt(uint32_t(index)));
    return {m_pass.sampler, m_pass.seed ^ stream, pixel, m_sample};
  }

  // What another pixel's sample would contribute; nothing if the two don't see each other.
  Contribution visibleContribution(const SecondaryPoint& sample, const VisiblePoint& point,
                                   RayCounts& counts) const {
    Contribution contribution = contributionOf(sample, point);
    if (!(contribution.target() > 0)) return {};
    ++counts.shadowRays;
    if (m_scene.occluded(Scene::spawn(point.at, contribution.direction, contribution.distance))) return {};
    return contribution;
  }

  // Pixels in a disk around this one that see a surface alike. The choice depends on x1 of each alone,
  // never on samples.
  void findNeighbours(size_t index, Sampler& random, std::vector<const FramePixel*>& found) const {
    found.clear();
    const int width = m_tiles.sampled().width, height = m_tiles.sampled().height;
    const VisiblePoint& point = m_pixels[index].path.point;
    for (int i = 0; i < m_options.neighbours; ++i) {
      const Vec2 offset = squareToDisk(random.get2D()) * m_options.radius;
      const int x = int(index) % width + int(std::lround(offset.x)),
                y = int(index) / width + int(std::lround(offset.y));
      if (x < 0 || y < 0 || x >= width || y >= height) continue;
      const size_t other = size_t(y) * size_t(width) + size_t(x);
      const VisiblePoint& its = m_pixels[other].path.point;
      // Paths of another length may go on for longer or shorter: their samples are others.
      if (other == index || !its.valid || its.depth != point.depth) continue;
      if (dot(its.at.shading.n, point.at.shading.n) < kLeastCosine) continue;
      found.push_back(&m_pixels[other]);
    }
  }

  // Chooses among the pixel's sample and its neighbours' in proportion to weight = MIS weight *
  // contribution / density, and gives the chosen one the sum of the weights.
  Rgb resample(size_t index, RayCounts& counts) const {
    const FramePixel& pixel = m_pixels[index];
    const VisiblePoint& point = pixel.path.point;
    thread_local std::vector<const FramePixel*> neighbours;
    Sampler random = samplerOf(index, kReuseSeed);
    random.startVertex(0);
    findNeighbours(index, random, neighbours);
    const float others = float(neighbours.size()), all = others + 1;

    float sum = 0;
    Rgb chosen(0, 0, 0);  // its value, over its target
    const auto offer = [&](const Contribution& contribution, float weight) {
      if (!(weight > 0) || !std::isfinite(weight)) return;
      sum += weight;
      if (random.get1D() * sum < weight) chosen = contribution.value / contribution.target();
    };

    // A sample of a neighbour, against the pixel's own way to find it. Targets stand for densities; all are
    // per area, so that no Jacobian is left.
    for (const FramePixel* other : neighbours) {
      if (!(other->own.target() > 0)) continue;
      const Contribution here = visibleContribution(other->path.sample, point, counts);
      const float there = other->own.target(), density = other->path.sample.pdf * other->own.geometry;
      const float mis = others * there / (others * there + here.target()) / all;
      offer(here, mis * here.target() / density);
    }
    // The pixel's own, against each neighbour's way to find it.
    if (pixel.own.target() > 0) {
      float mis = 1;
      for (const FramePixel* other : neighbours) {
        const float there = visibleContribution(pixel.path.sample, other->path.point, counts).target();
        mis += pixel.own.target() / (others * there + pixel.own.target());
      }
      offer(pixel.own, mis / all * pixel.own.target() / (pixel.path.sample.pdf * pixel.own.geometry));
    }
    return chosen * sum;
  }

  const Pass& m_pass;
  const Scene& m_scene;
  RestirOptions m_options;
  uint32_t m_sample;
  SampledTiles m_tiles;
  // The same for all pixels: a neighbour's sample that was found at another time would not be one of here.
  float m_time;
  std::vector<FramePixel> m_pixels;
};

}  // namespace

RayCounts renderRestirFrame(const RestirSetting& setting, uint32_t sample, Progress& progress,
                            const std::function<bool()>& stop) {
  constexpr size_t kGrain = 64;
  ReusedFrame frame(setting.pass, setting.options, sample);
  const tbb::blocked_range<size_t> all(0, frame.pixelCount(), kGrain);
  tbb::parallel_for(all, [&](const tbb::blocked_range<size_t>& range) {
    if (stop()) return;
    for (size_t i = range.begin(); i < range.end(); ++i) frame.trace(i);
    progress.advance(range.size());
  });
  RayCounts total;
  if (stop()) return total;

  std::vector<RayCounts> counts(frame.pixelCount());
  std::vector<Rgb> values(frame.pixelCount());
  tbb::parallel_for(all, [&](const tbb::blocked_range<size_t>& range) {
    for (size_t i = range.begin(); i < range.end(); ++i) {
      counts[i] = frame.counts(i);
      values[i] = frame.gather(i, counts[i]);
      addSample(setting.image[i], toOdis(values[i]), uint32_t(counts[i].rays + counts[i].shadowRays));
    }
  });
  if (setting.film)
    tbb::parallel_for(uint32_t(0), frame.tileCount(),
                      [&](uint32_t tile) { frame.splat(tile, values, *setting.film); });
  for (const RayCounts& pixel : counts) {
    total.rays += pixel.rays;
    total.shadowRays += pixel.shadowRays;
  }
  return total;
}

}  // namespace odis::render
