#include "render/integrator/render.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <chrono>
#include <limits>
#include <memory>

#include "render/integrator/combine.h"
#include "render/integrator/path_text.h"
#include "render/integrator/pilot_pass.h"
#include "render/integrator/sample_image.h"
#include "render/integrator/schedule.h"
#include "render/rivals/inverse_variance.h"
#include "render/rivals/open_pgl.h"
#include "render/rivals/ppg.h"
#include "render/rivals/restir.h"

namespace odis::render {

namespace {

using Clock = std::chrono::steady_clock;
double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Seeds of passes that are no part of the image.
constexpr uint64_t kOracleSeed = 0x6f7261636c65ull;
constexpr uint64_t kSampleImageSeed = 0x73616d706c65ull;
// How many iterations of a rival are combined by their variances, as Müller 2019 does.
constexpr size_t kIterationsCombined = 4;
// The oracle's selection probabilities come from this many of its passes.
constexpr int kOracleSelectionPasses = 2;

std::unique_ptr<Rival> makeRival(const RenderOptions& options) {
  if (options.integrator == IntegratorKind::ppg) return std::make_unique<PracticalPathGuiding>(options.ppg);
  if (options.integrator == IntegratorKind::openpgl) return makeOpenPgl();
  return nullptr;
}

class Renderer {
 public:
  Renderer(const Scene& scene, const RenderOptions& options, Progress& progress)
      : m_scene(scene),
        m_options(options),
        m_progress(progress),
        m_lights(scene.emitters()),
        m_start(Clock::now()),
        m_pixels(size_t(scene.film().crop.width) * scene.film().crop.height),
        m_schedule(options, m_pixels, uint32_t(scene.film().crop.width)),
        m_pilot(m_pixels),
        m_guided(m_pixels) {
    if (options.features) m_features.resize(m_pixels);
    if (options.records) m_emitted.assign(m_pixels, Rgb(0, 0, 0));
    m_rival = makeRival(options);
  }

  RenderResult run() {
    if (m_rival) {
      runRival(uint32_t(m_options.spp));
    } else if (m_options.integrator == IntegratorKind::restir) {
      runRestir();
    } else {
      if (m_options.integrator == IntegratorKind::odis) {
        runPilot();
        buildGuide();
      }
      runRemaining(std::numeric_limits<uint32_t>::max());
    }
    RenderResult result;
    result.frame = combine();
    result.stats = m_stats;
    result.stats.bytesLights = m_lights.bytes();
    result.stats.interrupted = m_stopped;
    if (m_options.records) {
      for (const std::vector<PilotVertex>& tile : m_records)
        for (PilotVertex v : tile) result.records.push_back(divided(v, m_pixelValues[v.pixel]));
      result.pilotEmitted = std::move(m_emitted);
    }
    return result;
  }

  // Everything up to the guided passes, then one path.
  Path trace(Vec2i pixel, uint32_t sample, std::vector<PilotVertex>& vertices) {
    if (m_options.integrator == IntegratorKind::restir)
      throw OptionError("--replay: a pixel of --integrator restir is made of many paths");
    const Crop& crop = m_scene.film().crop;
    const uint32_t index = uint32_t(pixel.y - crop.y) * uint32_t(crop.width) + uint32_t(pixel.x - crop.x);
    const PathSettings settings = settingsOf(index, sample);
    Sampler sampler(m_options.sampler, m_options.seed,
                    uint32_t(pixel.y) * uint32_t(m_scene.film().width) + uint32_t(pixel.x), sample);
    float filterWeight;
    const Ray ray = cameraRay(m_scene, pixel, sampler, filterWeight);
    Path path(ray, sampler);
    if (!m_pixelValues.empty()) path.pixelValue = m_pixelValues[index];
    tracePaths(settings, std::span(&path, 1), &vertices);
    return path;
  }

  // What the guide is made of.
  PilotPass pilot() {
    if (m_options.integrator != IntegratorKind::odis)
      throw OptionError("--integrator: expected odis, others have no pilot");
    runPilot();
    PilotPass result{std::move(m_pilot), {}, std::move(m_pixelValues), guideOptions(), m_stopped};
    for (const std::vector<PilotVertex>& tile : m_records)
      result.vertices.insert(result.vertices.end(), tile.begin(), tile.end());
    return result;
  }

  // Everything up to the last sample, then what `use` asks for.
  void samples(const std::function<void(const SampleRenderer&)>& use) {
    if (m_options.integrator == IntegratorKind::restir)
      throw OptionError("--integrator restir: a pixel is made of many paths, it has no samples of its own");
    if (m_options.integrator == IntegratorKind::odis && m_schedule.pilotSpp() >= m_options.spp)
      throw OptionError("--pilot-spp: all samples are the pilot's, expected fewer");
    Pass pass = basicPass();
    pass.path = settingsOf(0, uint32_t(m_options.spp) - 1);
    pass.pixelValues = m_pixelValues;
    pass.seed ^= kSampleImageSeed;
    use([&](uint32_t sample, Purposes redrawn) {
      return renderSampleImage(pass, sample, redrawn, m_progress, [this] { return stop(); });
    });
  }

 private:
  // What a sample of a pixel is traced with, after everything that comes before it.
  PathSettings settingsOf(uint32_t pixel, uint32_t sample) {
    PathSettings settings = pathSettings();
    if (m_rival) {
      runRival(sample);
      settings.rival = m_rival.get();
    } else if (m_options.integrator == IntegratorKind::odis && sample >= m_schedule.pilotCount(pixel)) {
      runPilot();
      buildGuide();
      runRemaining(std::min(sample - m_schedule.pilotCount(pixel), m_schedule.lastRefinement()));
      useGuide(settings);
    }
    return settings;
  }
  PathSettings pathSettings() const {
    PathSettings settings;
    settings.scene = &m_scene;
    settings.lights = &m_lights;
    settings.maxDepth = m_options.maxDepth;
    settings.rrDepth = m_options.rrDepth;
    settings.guideBounces = m_options.guideBounces;
    settings.guideFeatures = m_options.guideFeatures;
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
    count(runPass(pass, m_progress, [this] { return stop(); }));
  }
  void count(const RayCounts& counts) {
    m_stats.rays += counts.rays;
    m_stats.shadowRays += counts.shadowRays;
  }

  void runPilot() {
    const Clock::time_point start = Clock::now();
    Pass pass = basicPass();
    pass.samples = [this](uint32_t pixel) { return std::pair(0u, m_schedule.pilotCount(pixel)); };
    pass.image = &m_pilot;
    pass.records = &m_records;
    pass.emitted = m_options.records ? &m_emitted : nullptr;
    m_progress.begin("pilot",
                     uint64_t(double(m_pixels) * std::min(double(m_options.spp), m_schedule.pilotSpp())));
    run(pass);
    m_progress.end();
    m_stats.secondsPilot = secondsSince(start);
    m_pixelValues = pixelEstimates(m_pilot, m_scene.film().crop.width);
    m_stats.pilotVertices = countVertices(m_records);
    m_stats.bytesBuild = m_stats.pilotVertices * sizeof(PilotVertex);
  }

  static uint64_t countVertices(const Records& records) {
    uint64_t count = 0;
    for (const std::vector<PilotVertex>& tile : records) count += tile.size();
    return count;
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

  void useGuide(PathSettings& settings) const {
    settings.guide = &m_guide;
    settings.learnedLights = m_options.lights != LightChoiceKind::hierarchy;
    settings.shadowRoulette = m_options.shadowRays == ShadowRayKind::roulette;
    settings.learnedRoulette = m_options.roulette != RouletteKind::throughput;
  }

  // What guides are built with: the scene's lights, and the networks where they are asked for.
  GuideOptions guideOptions() const {
    GuideOptions options = m_options.guideOptions;
    if (m_options.lights != LightChoiceKind::hierarchy && m_lights.groupCount() > 1) {
      options.lightGroups = m_lights.groupCount();
      options.lightParts = m_lights.dividedLights();
    }
    const Networks& networks = m_options.networks ? *m_options.networks : builtInNetworks();
    if (m_options.guide == GuideKind::network && !options.model) options.model = networks.directions;
    if (m_options.lights == LightChoiceKind::network && !options.lights) options.lights = networks.lights;
    if (m_options.roulette == RouletteKind::network && !options.continuations)
      options.continuations = networks.continuations;
    return options;
  }

  void buildGuide() {
    if (m_stopped) return;
    const Clock::time_point start = Clock::now();
    m_builder = std::make_unique<GuideBuilder>(guideOptions());
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
        m_builder->add(partsOf(records));
        if (i < kOracleSelectionPasses)
          std::move(records.begin(), records.end(), std::back_inserter(selection));
      }
      m_guide = m_builder->build(partsOf(selection), m_pixelValues);
      m_progress.end();
    } else {
      m_builder->add(partsOf(m_records));
      m_guide = m_builder->build(partsOf(m_records), m_pixelValues);
    }
    m_pilotWeights = pilotWeights();
    guideIsBuilt(m_stats.pilotVertices * sizeof(PilotVertex), 0);
    if (!m_options.records) m_records = {};
    m_stats.secondsBuild = secondsSince(start);
  }

  // Takes stock when the guide has learned, beside vertices of so much memory, and clears up when it won't learn any more.
  void guideIsBuilt(uint64_t bytesVertices, uint32_t guidedSamples) {
    m_stats.cells = m_guide.cellCount();
    m_stats.bytesMaps = m_guide.bytes();
    m_stats.bytesBuild = std::max(m_stats.bytesBuild, m_builder->bytes() + bytesVertices);
    if (guidedSamples >= m_schedule.lastRefinement()) m_builder.reset();
  }

  // At most so many of the samples that the pilot left, in each pixel. The guide learns from the first of them, too, and
  // after the first of all it is settled how many there are.
  void runRemaining(uint32_t limit) {
    const Clock::time_point start = Clock::now();
    const double building = m_stats.secondsBuild;
    const bool guided = m_options.integrator == IntegratorKind::odis;
    const auto most = [&] { return std::min(m_schedule.mostRemaining(), limit); };
    m_progress.begin(guided ? "guided" : "path", m_pixels * uint64_t(most()));
    for (uint32_t done = 0, next; done < most() && !stop(); done = next) {
      const bool learns = done < m_schedule.lastRefinement();
      next = std::min(m_schedule.passEnd(done), limit);
      Pass pass = basicPass();
      if (guided) {
        useGuide(pass.path);
        pass.pixelValues = m_pixelValues;
      }
      pass.samples = [this, done, next](uint32_t pixel) { return m_schedule.remaining(pixel, done, next); };
      pass.image = &m_guided;
      std::vector<PilotDigest> digests;
      if (learns) {
        pass.learner = m_builder.get();
        pass.digests = &digests;
      }
      run(pass);
      if (stop()) break;
      if (next == m_schedule.spreadAfter()) spreadSamples();
      if (learns) refineGuide(digests, next);
    }
    m_progress.end();
    m_stats.secondsGuided = secondsSince(start) - (m_stats.secondsBuild - building);
  }

  // Settles how many samples each pixel has. Guided samples are told apart from those that they are counted by, the pilot's
  // can't be, since all that comes after them depends on them: so their share in the image stays what it would have been.
  void spreadSamples() {
    m_schedule.spread(sampleCounts(pixelNoise(m_pilot, m_guided), m_scene.film().crop.width, m_options.spp));
    for (uint32_t pixel = 0; pixel < m_pilotWeights.size(); ++pixel)
      m_pilotWeights[pixel] *= m_schedule.remainingRatio(pixel);
  }

  // Learns from the vertices of a guided pass, and rebuilds the guide where it is time.
  void refineGuide(std::span<const PilotDigest> digests, uint32_t done) {
    const Clock::time_point start = Clock::now();
    m_builder->add(digests);
    if (std::has_single_bit(done + 1)) m_guide = m_builder->rebuild(m_guide);
    guideIsBuilt(0, done);
    m_stats.secondsBuild += secondsSince(start);
  }

  // The first so many samples of every pixel, one after another: the rival learns from each what it guides the
  // next ones with. Those that nothing is learnt from are rendered several at a time.
  void runRival(uint32_t samples) {
    const Clock::time_point start = Clock::now();
    const uint32_t spp = uint32_t(m_options.spp);
    m_progress.begin("guided", m_pixels * uint64_t(samples));
    for (uint32_t done = 0; done < samples && !stop();) {
      const uint32_t end = m_rival->iterationEnd(done, spp);
      const bool learns = end < spp;
      beginIteration();
      while (done < std::min(end, samples) && !stop()) {
        const uint32_t count = learns ? 1 : std::min(samples - done, kSamplesPerPass);
        Pass pass = basicPass();
        pass.path.rival = m_rival.get();
        pass.samples = [done, count](uint32_t) { return std::pair(done, count); };
        pass.image = &m_iterations.back();
        Records records;
        pass.records = learns ? &records : nullptr;
        run(pass);
        if (learns && !stop()) learnFrom(records, done);
        done += count;
      }
      if (learns && done == end && !stop()) m_rival->endIteration();
    }
    m_progress.end();
    m_stats.secondsGuided = secondsSince(start) - m_stats.secondsBuild;
    m_stats.bytesMaps = m_rival->bytes();
  }

  void learnFrom(const Records& records, uint32_t sample) {
    const Clock::time_point start = Clock::now();
    m_rival->learn(records, sample);
    m_stats.bytesBuild =
        std::max(m_stats.bytesBuild, m_rival->bytes() + countVertices(records) * sizeof(PilotVertex));
    m_stats.secondsBuild += secondsSince(start);
  }

  // Makes room for the samples of an iteration, and forgets those that won't be part of the image.
  void beginIteration() {
    const Rival::Combination combination = m_rival->combination();
    if (combination == Rival::Combination::all && !m_iterations.empty()) return;
    const size_t kept = combination == Rival::Combination::last ? 2 : kIterationsCombined;
    if (m_iterations.size() == kept) {
      for (const PixelSums& s : m_iterations.front()) m_stats.samples += s.count;
      m_iterations.erase(m_iterations.begin());
    }
    m_iterations.emplace_back(m_pixels);
  }

  // Frames that know nothing of each other, averaged.
  void runRestir() {
    if (m_options.features)
      throw OptionError("--integrator restir: renders the image alone, no features (--aov)");
    const Clock::time_point start = Clock::now();
    m_progress.begin("restir", m_pixels * uint64_t(m_options.spp));
    Pass pass = basicPass();
    pass.image = &m_guided;
    for (uint32_t sample = 0; sample < uint32_t(m_options.spp) && !stop(); ++sample)
      count(renderRestirFrame(pass, m_options.restir, sample, m_progress, [this] { return stop(); }));
    m_progress.end();
    m_stats.secondsGuided = secondsSince(start);
  }

  // What a pilot sample weighs in each pixel, a guided one weighing 1: by the inverse of their variances as the
  // pilot predicts them. It does not look at the pixel's own values, so the mean stays unbiased. Not to be made anew
  // when the guide has learnt from the samples that are weighed.
  std::vector<float> pilotWeights() const {
    if (m_options.pilotWeight >= 0) return std::vector<float>(m_pixels, float(m_options.pilotWeight));
    if (m_guide.predictions().empty()) return std::vector<float>(m_pixels, 1);
    return odis::pilotWeights(m_guide.predictions(), m_scene.film().crop.width);
  }

  // What the image is made of.
  std::vector<WeightedImage> weightedImages() {
    if (m_rival && m_rival->combination() == Rival::Combination::inverseVariance)
      return weighByVariance(m_iterations, m_scene.film().crop.width);
    if (m_rival) {
      // The last iteration that every pixel has a sample of, should the time have been short.
      const auto complete = std::find_if(m_iterations.rbegin(), m_iterations.rend(), [](const auto& image) {
        return std::all_of(image.begin(), image.end(), [](const PixelSums& s) { return s.count > 0; });
      });
      if (complete == m_iterations.rend()) return {};
      return {{&*complete, {}}};
    }
    m_stats.pilotWeight = pilotShare(m_pilotWeights);
    return {{&m_pilot, m_pilotWeights}, {&m_guided, {}}};
  }

  Frame2D combine() {
    const Crop& crop = m_scene.film().crop;
    Frame2D frame;
    frame.x = crop.x;
    frame.y = crop.y;
    frame.width = crop.width;
    frame.height = crop.height;
    frame.color.resize(m_pixels, Rgb(0, 0, 0));
    if (m_options.variance) frame.variance.resize(m_pixels, Rgb(0, 0, 0));
    const std::vector<WeightedImage> images = weightedImages();
    render::combine(images, frame.color, m_options.variance ? &frame.variance : nullptr);
    for (const std::vector<PixelSums>& image : m_iterations)
      for (const PixelSums& s : image) m_stats.samples += s.count;
    for (size_t pixel = 0; pixel < m_pixels; ++pixel) {
      m_stats.samples += m_pilot[pixel].count + m_guided[pixel].count;
      m_stats.pilotSamples += m_pilot[pixel].count;
    }
    m_stats.spp = double(m_stats.samples) / double(std::max<size_t>(m_pixels, 1));
    const bool guide = m_options.guideFeatures && m_options.integrator == IntegratorKind::odis;
    if (m_options.features) writeFeatures(m_features, guide, frame);
    if (m_options.features && guide)
      for (size_t pixel = 0; pixel < m_pixels; ++pixel)
        frame.guideSamples.push_back(float(m_pilot[pixel].count + m_guided[pixel].count));
    return frame;
  }

  // The pilot's share in the image, with these weights of its samples; 1 if there are none.
  double pilotShare(std::span<const float> weights) const {
    double pilot = 0, all = 0;
    for (size_t pixel = 0; pixel < m_pixels; ++pixel) {
      const double weight = m_pilot[pixel].count * (weights.empty() ? 1.0 : double(weights[pixel]));
      pilot += weight;
      all += weight + m_guided[pixel].count;
    }
    return all > 0 ? pilot / all : 0;
  }

  const Scene& m_scene;
  const RenderOptions& m_options;
  Progress& m_progress;
  LightSampler m_lights;
  Clock::time_point m_start;
  size_t m_pixels;
  Schedule m_schedule;
  std::vector<PixelSums> m_pilot, m_guided;
  std::vector<FeatureSums> m_features;
  Records m_records;
  std::vector<Rgb> m_emitted;
  std::vector<float> m_pixelValues;  // as the pilot sees them
  std::vector<float> m_pilotWeights;
  std::unique_ptr<GuideBuilder> m_builder;
  Guide m_guide;
  std::unique_ptr<Rival> m_rival;                    // null: path, odis
  std::vector<std::vector<PixelSums>> m_iterations;  // of the rival, as far as they make the image
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

void renderSamples(const Scene& scene, const RenderOptions& options, Progress& progress,
                   const std::function<void(const SampleRenderer&)>& use) {
  const tbb::global_control limit = limitThreads(options.threads);
  Renderer(scene, options, progress).samples(use);
}

PilotPass renderPilot(const Scene& scene, const RenderOptions& options, Progress& progress) {
  const tbb::global_control limit = limitThreads(options.threads);
  return Renderer(scene, options, progress).pilot();
}

std::string replay(const Scene& scene, const RenderOptions& options, Vec2i pixel, int sample) {
  const tbb::global_control limit = limitThreads(options.threads);
  Progress quiet;
  std::vector<PilotVertex> vertices;
  const Path path = Renderer(scene, options, quiet).trace(pixel, uint32_t(sample), vertices);
  return fmt::format("pixel {},{} sample {}: ", pixel.x, pixel.y, sample) + pathText(path, vertices);
}

}  // namespace odis::render
