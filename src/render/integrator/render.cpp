#include "render/integrator/render.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <chrono>

#include "render/integrator/pass.h"

namespace odis::render {

namespace {

using Clock = std::chrono::steady_clock;
double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Seeds of passes that are no part of the image.
constexpr uint64_t kOracleSeed = 0x6f7261636c65ull;
// How many samples per pixel a pass takes at most, so that there is progress and an end in sight.
constexpr uint32_t kSamplesPerPass = 8;
// The oracle's selection probabilities come from this many of its passes.
constexpr int kOracleSelectionPasses = 2;

class Renderer {
 public:
  Renderer(const Scene& scene, const RenderOptions& options, Progress& progress)
      : m_scene(scene),
        m_options(options),
        m_progress(progress),
        m_lights(scene.emitters()),
        m_start(Clock::now()),
        m_pixels(size_t(scene.film().crop.width) * scene.film().crop.height),
        m_pilot(m_pixels),
        m_guided(m_pixels) {
    if (options.features) m_features.resize(m_pixels);
    if (options.records) m_emitted.assign(m_pixels, Rgb(0, 0, 0));
  }

  RenderResult run() {
    if (m_options.integrator == IntegratorKind::odis) {
      runPilot();
      buildGuide();
    }
    runRemaining();
    RenderResult result;
    result.frame = combine();
    result.stats = m_stats;
    result.stats.bytesLights = m_lights.bytes();
    result.stats.interrupted = m_stopped;
    if (m_options.records) {
      const std::vector<float> estimates = pixelEstimates();
      for (const std::vector<PilotVertex>& tile : m_records)
        for (PilotVertex v : tile) result.records.push_back(divided(v, estimates[v.pixel]));
      result.pilotEmitted = std::move(m_emitted);
    }
    return result;
  }

  // Everything up to the guided passes, then one path.
  Path trace(Vec2i pixel, uint32_t sample, std::vector<PilotVertex>& vertices) {
    const Crop& crop = m_scene.film().crop;
    const uint32_t index = uint32_t(pixel.y - crop.y) * uint32_t(crop.width) + uint32_t(pixel.x - crop.x);
    PathSettings settings = pathSettings();
    if (m_options.integrator == IntegratorKind::odis && sample >= pilotCount(index)) {
      runPilot();
      buildGuide();
      settings.guide = &m_guide;
    }
    Sampler sampler(m_options.sampler, m_options.seed,
                    uint32_t(pixel.y) * uint32_t(m_scene.film().width) + uint32_t(pixel.x), sample);
    float filterWeight;
    const Ray ray = cameraRay(m_scene, pixel, sampler, filterWeight);
    Path path(ray, sampler);
    tracePaths(settings, std::span(&path, 1), &vertices);
    return path;
  }

 private:
  PathSettings pathSettings() const {
    PathSettings settings;
    settings.scene = &m_scene;
    settings.lights = &m_lights;
    settings.maxDepth = m_options.maxDepth;
    settings.rrDepth = m_options.rrDepth;
    settings.guideBounces = m_options.guideBounces;
    return settings;
  }
  Pass basicPass() {
    Pass pass;
    pass.path = pathSettings();
    pass.sampler = m_options.sampler;
    pass.seed = m_options.seed;
    pass.features = m_options.features ? &m_features : nullptr;
    return pass;
  }
  bool stop() {
    if (m_progress.cancelled() || (m_options.timeLimit > 0 && secondsSince(m_start) > m_options.timeLimit))
      m_stopped = true;
    return m_stopped;
  }
  void run(const Pass& pass) {
    const RayCounts counts = runPass(pass, m_progress, [this] { return stop(); });
    m_stats.rays += counts.rays;
    m_stats.shadowRays += counts.shadowRays;
  }

  // How many of the pixel's samples belong to the pilot: n for every pixel, or one pixel of each block,
  // chosen by hash.
  uint32_t pilotCount(uint32_t pixel) const {
    if (m_options.integrator == IntegratorKind::path) return 0;
    const uint32_t spp = uint32_t(m_options.spp);
    if (m_options.pilotSpp >= 1) return std::min(spp, uint32_t(std::lround(m_options.pilotSpp)));
    const uint32_t block = uint32_t(std::lround(1 / std::sqrt(m_options.pilotSpp)));
    const uint32_t width = uint32_t(m_scene.film().crop.width), x = pixel % width, y = pixel / width;
    const uint64_t hash = mixBits(m_options.seed ^ (uint64_t(y / block) << 32 | (x / block)));
    return x % block == hash % block && y % block == (hash >> 32) % block ? 1 : 0;
  }

  void runPilot() {
    const Clock::time_point start = Clock::now();
    Pass pass = basicPass();
    pass.samples = [this](uint32_t pixel) { return std::pair(0u, pilotCount(pixel)); };
    pass.image = &m_pilot;
    pass.records = &m_records;
    pass.emitted = m_options.records ? &m_emitted : nullptr;
    m_progress.begin("pilot",
                     uint64_t(double(m_pixels) * std::min(double(m_options.spp), m_options.pilotSpp)));
    run(pass);
    m_progress.end();
    m_stats.secondsPilot = secondsSince(start);
    m_stats.pilotVertices = countVertices();
    m_stats.bytesBuild = m_stats.pilotVertices * sizeof(PilotVertex);
  }

  uint64_t countVertices() const {
    uint64_t count = 0;
    for (const std::vector<PilotVertex>& tile : m_records) count += tile.size();
    return count;
  }

  // An estimate of each pixel's luminance, to measure contributions by: the mean over its block of the pilot,
  // with a little of the image's mean so that nothing is divided by almost nothing.
  std::vector<float> pixelEstimates() const {
    constexpr int kBlock = 8;
    const int width = m_scene.film().crop.width, height = m_scene.film().crop.height;
    const int blocksX = (width + kBlock - 1) / kBlock, blocksY = (height + kBlock - 1) / kBlock;
    std::vector<double> sum(size_t(blocksX) * blocksY, 0.0), count(sum.size(), 0.0);
    double total = 0, samples = 0;
    const auto blockOf = [&](size_t pixel) {
      return (pixel / width / kBlock) * size_t(blocksX) + pixel % width / kBlock;
    };
    for (size_t pixel = 0; pixel < m_pixels; ++pixel) {
      const Rgbd& s = m_pilot[pixel].sum;
      const double value = luminance(Rgb(float(s.x), float(s.y), float(s.z)));
      sum[blockOf(pixel)] += value;
      count[blockOf(pixel)] += m_pilot[pixel].count;
      total += value;
      samples += m_pilot[pixel].count;
    }
    const double mean = samples > 0 ? total / samples : 1;
    std::vector<float> result(m_pixels);
    for (size_t pixel = 0; pixel < m_pixels; ++pixel) {
      const size_t block = blockOf(pixel);
      const double value = count[block] > 0 ? sum[block] / count[block] : mean;
      result[pixel] = float(std::max(value + 0.1 * mean, 1e-20));
    }
    return result;
  }

  // A record whose contributions are relative to its pixel's value.
  static PilotVertex divided(PilotVertex v, float estimate) {
    v.indirect /= estimate;
    v.emission /= estimate;
    v.light /= estimate;
    return v;
  }

  static std::vector<std::span<const PilotVertex>> partsOf(const Records& records) {
    return {records.begin(), records.end()};
  }

  void buildGuide() {
    if (m_stopped) return;
    const Clock::time_point start = Clock::now();
    const std::vector<float> estimates = pixelEstimates();
    GuideBuilder builder(m_options.guideOptions);
    if (m_options.guide == GuideKind::oracle) {
      m_progress.begin("oracle", m_pixels * uint64_t(m_options.oracleSpp));
      Records selection;
      for (int i = 0; i < m_options.oracleSpp && !stop(); ++i) {
        Pass pass = basicPass();
        pass.features = nullptr;
        pass.seed = m_options.seed ^ kOracleSeed;
        pass.samples = [i](uint32_t) { return std::pair(uint32_t(i), 1u); };
        Records records;
        pass.records = &records;
        run(pass);
        builder.add(partsOf(records));
        if (i < kOracleSelectionPasses)
          std::move(records.begin(), records.end(), std::back_inserter(selection));
      }
      m_guide = builder.build(partsOf(selection), estimates);
      m_progress.end();
    } else {
      builder.add(partsOf(m_records));
      m_guide = builder.build(partsOf(m_records), estimates);
    }
    m_stats.bytesBuild += builder.bytes();
    if (!m_options.records) m_records = {};
    m_stats.secondsBuild = secondsSince(start);
    m_stats.cells = m_guide.cellCount();
    m_stats.bytesMaps = m_guide.bytes();
  }

  // The samples that the pilot left: all of them for the path tracer.
  void runRemaining() {
    const Clock::time_point start = Clock::now();
    const bool guided = m_options.integrator == IntegratorKind::odis;
    const uint32_t spp = uint32_t(m_options.spp);
    const uint32_t most = spp - (m_options.pilotSpp >= 1 ? pilotCount(0) : 0);
    m_progress.begin(guided ? "guided" : "path", m_pixels * uint64_t(most));
    for (uint32_t done = 0; done < most && !stop(); done += kSamplesPerPass) {
      Pass pass = basicPass();
      if (guided) pass.path.guide = &m_guide;
      pass.samples = [this, done, spp](uint32_t pixel) {
        const uint32_t first = std::min(pilotCount(pixel) + done, spp);
        return std::pair(first, std::min(spp - first, kSamplesPerPass));
      };
      pass.image = &m_guided;
      run(pass);
    }
    m_progress.end();
    m_stats.secondsGuided = secondsSince(start);
  }

  // What a pilot sample weighs in each pixel, a guided one weighing 1. It does not look at the pixel's own
  // values, so the mean stays unbiased.
  std::vector<float> pilotWeights() const {
    if (m_options.pilotWeight >= 0) return std::vector<float>(m_pixels, float(m_options.pilotWeight));
    if (m_guide.predictions().empty()) return std::vector<float>(m_pixels, 1);
    return odis::pilotWeights(m_guide.predictions(), m_scene.film().crop.width);
  }

  Frame2D combine() {
    const Crop& crop = m_scene.film().crop;
    Frame2D frame;
    frame.x = crop.x;
    frame.y = crop.y;
    frame.width = crop.width;
    frame.height = crop.height;
    frame.color.resize(m_pixels);
    if (m_options.variance) frame.variance.resize(m_pixels);
    const std::vector<float> ratios = pilotWeights();
    for (size_t pixel = 0; pixel < m_pixels; ++pixel) {
      const double ratio = ratios[pixel];
      const PixelSums &pilot = m_pilot[pixel], &guided = m_guided[pixel];
      m_stats.samples += pilot.count + guided.count;
      m_stats.pilotSamples += pilot.count;
      const double weight = pilot.count * ratio + guided.count;
      if (!(weight > 0)) {
        frame.color[pixel] = Rgb(0, 0, 0);
        continue;
      }
      const Rgbd mean = (pilot.sum * ratio + guided.sum) / weight;
      frame.color[pixel] = Rgb(float(mean.x), float(mean.y), float(mean.z));
      if (m_options.variance) frame.variance[pixel] = varianceOfMean(pilot, guided, ratio);
    }
    m_stats.pilotWeight = pilotShare(ratios);
    m_stats.spp = double(m_stats.samples) / double(std::max<size_t>(m_pixels, 1));
    if (m_options.features) writeFeatures(frame);
    return frame;
  }

  double pilotShare(std::span<const float> ratios) const {
    double pilot = 0, all = 0;
    for (size_t pixel = 0; pixel < m_pixels; ++pixel) {
      const double weight = m_pilot[pixel].count * double(ratios[pixel]);
      pilot += weight;
      all += weight + m_guided[pixel].count;
    }
    return all > 0 ? pilot / all : 0;
  }

  // With s2 the variance of a guided sample, a pilot sample has s2 / ratio, and the mean's variance is
  // s2 (ratio n_p + n_g) / (ratio n_p + n_g)^2. s2 is pooled from deviations within either set and, weighted
  // alike, between the two.
  static Rgb varianceOfMean(const PixelSums& pilot, const PixelSums& guided, double ratio) {
    const double weight = ratio * pilot.count + guided.count;
    const uint32_t samples = pilot.count + guided.count;
    if (samples < 2 || !(ratio > 0)) return Rgb(0, 0, 0);
    const Rgbd mean = (pilot.sum * ratio + guided.sum) / weight;
    const Rgbd squares = pilot.sumSquares * ratio + guided.sumSquares - mean * mean * weight;
    const Rgbd variance = squares / double(samples - 1) / weight;
    return Rgb(float(std::max(variance.x, 0.0)), float(std::max(variance.y, 0.0)),
               float(std::max(variance.z, 0.0)));
  }

  void writeFeatures(Frame2D& frame) const {
    for (const FeatureSums& sums : m_features) {
      const float scale = sums.hits > 0 ? 1.0f / float(sums.hits) : 0.0f;
      const auto unit = [](const Vec3& v) { return lengthSquared(v) > 0 ? normalize(v) : Vec3(0, 0, 0); };
      frame.albedo.push_back(sums.albedo * scale);
      frame.normal.push_back(unit(sums.normal));
      frame.geometricNormal.push_back(unit(sums.geometricNormal));
      frame.position.push_back(sums.position * scale);
      frame.depth.push_back(sums.depth * scale);
      frame.roughness.push_back(sums.roughness * scale);
    }
  }

  const Scene& m_scene;
  const RenderOptions& m_options;
  Progress& m_progress;
  LightSampler m_lights;
  Clock::time_point m_start;
  size_t m_pixels;
  std::vector<PixelSums> m_pilot, m_guided;
  std::vector<FeatureSums> m_features;
  Records m_records;
  std::vector<Rgb> m_emitted;
  Guide m_guide;
  RenderStats m_stats;
  std::atomic<bool> m_stopped{false};
};

tbb::global_control limitThreads(int threads) {
  const int count = threads > 0 ? threads : tbb::info::default_concurrency();
  return tbb::global_control(tbb::global_control::max_allowed_parallelism, size_t(count));
}

}  // namespace

RenderResult render(const Scene& scene, const RenderOptions& options, Progress& progress) {
  const tbb::global_control limit = limitThreads(options.threads);
  return Renderer(scene, options, progress).run();
}

std::string replay(const Scene& scene, const RenderOptions& options, Vec2i pixel, int sample) {
  const tbb::global_control limit = limitThreads(options.threads);
  Progress quiet;
  std::vector<PilotVertex> vertices;
  const Path path = Renderer(scene, options, quiet).trace(pixel, uint32_t(sample), vertices);
  std::string text = fmt::format("pixel {},{} sample {}: radiance {:.6g} {:.6g} {:.6g}\n", pixel.x, pixel.y,
                                 sample, path.radiance.x, path.radiance.y, path.radiance.z);
  for (const PilotVertex& v : vertices)
    text += fmt::format(
        "  vertex {}: p ({:.5g} {:.5g} {:.5g}) n ({:.3f} {:.3f} {:.3f}) wi ({:.3f} {:.3f} {:.3f}){} pdf "
        "{:.4g} weight "
        "({:.4g} {:.4g} {:.4g}) direct ({:.4g} {:.4g} {:.4g}) arriving ({:.4g} {:.4g} {:.4g}) roughness "
        "{:.3g} next at "
        "{:.5g}\n",
        v.depth, v.position.x, v.position.y, v.position.z, v.normal.x, v.normal.y, v.normal.z, v.wi.x, v.wi.y,
        v.wi.z, v.discrete ? " (delta)" : "", v.pdf, v.weight.x, v.weight.y, v.weight.z, v.direct.x,
        v.direct.y, v.direct.z, v.radiance.x, v.radiance.y, v.radiance.z, v.roughness, v.distance);
  return text;
}

}  // namespace odis::render
