// ppg and openpgl: guides that learn from what they render (docs/rivals.md), sample after sample.
#include <algorithm>
#include <numeric>

#include "render/integrators/integrator.h"
#include "render/rivals/inverse_variance.h"
#include "render/rivals/open_pgl.h"
#include "render/rivals/ppg.h"

namespace odis::render {

namespace {

// How many iterations are combined by their variances, as Müller 2019 does.
constexpr size_t kIterationsCombined = 4;
// The greatest number of samples per pixel in a pass that nothing is learned from.
constexpr uint32_t kSamplesPerPass = 8;

class RivalIntegrator : public Integrator {
 public:
  RivalIntegrator(RenderJob& job, std::unique_ptr<Rival> rival) : m_job(job), m_rival(std::move(rival)) {}

  void render() override { renderFirst(uint32_t(m_job.options().spp)); }

  Pass passBefore(uint32_t, uint32_t sample) override {
    renderFirst(sample);
    return guidedPass();
  }

  void finish(RenderResult& result) override;

 private:
  using Image = std::vector<PixelSums>;

  void renderFirst(uint32_t samples);
  void runIteration(uint32_t& done, uint32_t end, bool learns);
  void beginIteration();
  Pass guidedPass() {
    Pass pass = m_job.pass();
    pass.path.rival = m_rival.get();
    return pass;
  }
  // Runs a pass of some samples of every pixel, which are added to the image of the iteration.
  void runPass(SampleRange samples, TileVertices* vertices);
  void fillFromFilms(RenderResult& result, std::span<const std::vector<float>> weights);
  void learnFrom(const TileVertices& vertices, uint32_t sample);

  RenderJob& m_job;
  std::unique_ptr<Rival> m_rival;
  std::vector<Image> m_iterations;                  // as far as they make the image
  std::vector<std::unique_ptr<SplatFilm>> m_films;  // theirs; null unless they splat
};

// Takes the first samples of every pixel, one after another: the rival learns from each what it guides the
// next ones with.
void RivalIntegrator::renderFirst(uint32_t samples) {
  const Stopwatch stopwatch;
  const uint32_t spp = uint32_t(m_job.options().spp);
  m_job.progress().begin("guided", m_job.pixelCount() * uint64_t(samples));
  for (uint32_t done = 0; done < samples && !m_job.stop();) {
    const uint32_t end = m_rival->iterationEnd(done, spp);
    const bool learns = end < spp;
    beginIteration();
    runIteration(done, std::min(end, samples), learns);
    if (learns && done == end && !m_job.stop()) m_rival->endIteration();
  }
  m_job.progress().end();
  m_job.stats.secondsGuided = stopwatch.seconds() - m_job.stats.secondsBuild;
  m_job.stats.bytesMaps = m_rival->bytes();
}

// Samples that nothing is learned from are rendered several at a time.
void RivalIntegrator::runIteration(uint32_t& done, uint32_t end, bool learns) {
  while (done < end && !m_job.stop()) {
    const uint32_t count = learns ? 1 : std::min(end - done, kSamplesPerPass);
    TileVertices vertices;
    runPass({done, count}, learns ? &vertices : nullptr);
    if (learns && !m_job.stop()) learnFrom(vertices, done);
    done += count;
  }
}

void RivalIntegrator::runPass(SampleRange samples, TileVertices* vertices) {
  if (vertices) vertices->resize(m_job.tiles().count());
  Pass pass = guidedPass();
  pass.splats.colors = m_films.back().get();
  pass.samples = [samples](uint32_t) { return samples; };
  pass.wantsVertices = vertices;
  pass.deliver = [&](uint32_t tile, ArrayView<const FrameSample> taken, ArrayView<const PathVertex> met) {
    for (const FrameSample& s : taken) addSample(m_iterations.back()[s.pixel], s.value, s.rays);
    if (vertices) (*vertices)[tile].assign(met.begin(), met.end());
  };
  m_job.run(pass);
}

void RivalIntegrator::learnFrom(const TileVertices& vertices, uint32_t sample) {
  const Stopwatch stopwatch;
  m_rival->learn(vertices, sample);
  uint64_t count = 0;
  for (const std::vector<PathVertex>& tile : vertices) count += tile.size();
  m_job.stats.bytesBuild = std::max(m_job.stats.bytesBuild, m_rival->bytes() + count * sizeof(PathVertex));
  m_job.stats.secondsBuild += stopwatch.seconds();
}

// Makes room for the samples of an iteration, and forgets those that won't be part of the image.
void RivalIntegrator::beginIteration() {
  const Rival::Combination combination = m_rival->combination();
  if (combination == Rival::Combination::all && !m_iterations.empty()) return;
  const size_t kept = combination == Rival::Combination::last ? 2 : kIterationsCombined;
  if (m_iterations.size() == kept) {
    for (const PixelSums& s : m_iterations.front()) m_job.stats.samples += s.count;
    m_iterations.erase(m_iterations.begin());
    m_films.erase(m_films.begin());
  }
  m_iterations.emplace_back(m_job.pixelCount());
  m_films.push_back(m_job.newColorFilm());
}

// Adds up the iterations on films that splat. Samples of many pixels make a pixel then: those of an iteration
// all have the mean of their weights.
void RivalIntegrator::fillFromFilms(RenderResult& result, std::span<const std::vector<float>> weights) {
  std::vector<float> all;
  for (size_t i = 0; i < weights.size(); ++i) {
    const double sum = std::accumulate(weights[i].begin(), weights[i].end(), 0.0);
    const auto weight = float(sum / double(weights[i].size()));
    const std::vector<float> sums = m_films[i]->sums();
    all.resize(sums.size());
    for (size_t k = 0; k < sums.size(); ++k) all[k] += weight * sums[k];
  }
  fillPixels(result, all, m_films.front()->channels());
}

void RivalIntegrator::finish(RenderResult& result) {
  for (const Image& image : m_iterations)
    for (const PixelSums& s : image) result.stats.samples += s.count;
  if (m_rival->combination() == Rival::Combination::inverseVariance) {
    const std::vector<std::vector<float>> weights =
        weighByVariance(m_iterations, m_job.tiles().sampled().width);
    if (m_job.film() == FilmKind::splat) return fillFromFilms(result, weights);
    fillPixels(result, m_job.options(), [&](uint32_t pixel) {
      std::array<WeightedSums, kIterationsCombined> parts;
      for (size_t i = 0; i < m_iterations.size(); ++i)
        parts[i] = {&m_iterations[i][pixel], weights[i][pixel]};
      return meanOfParts({parts.data(), m_iterations.size()});
    });
    return;
  }
  if (m_iterations.empty()) beginIteration();
  // The last iteration that every pixel has a sample of, should the time have been short, else what there is.
  const auto complete = std::find_if(m_iterations.rbegin(), m_iterations.rend(), [](const Image& image) {
    return std::all_of(image.begin(), image.end(), [](const PixelSums& s) { return s.count > 0; });
  });
  const Image& image = complete == m_iterations.rend() ? m_iterations.front() : *complete;
  if (const auto& film = m_films[size_t(&image - m_iterations.data())]) return fillPixels(result, *film);
  fillPixels(result, m_job.options(), [&](uint32_t pixel) {
    const WeightedSums part{&image[pixel], 1};
    return meanOfParts({&part, 1});
  });
}

}  // namespace

std::unique_ptr<Integrator> makePpgIntegrator(RenderJob& job) {
  return std::make_unique<RivalIntegrator>(job, std::make_unique<PracticalPathGuiding>(job.options().ppg));
}

std::unique_ptr<Integrator> makeOpenPglIntegrator(RenderJob& job) {
  return std::make_unique<RivalIntegrator>(job, makeOpenPgl());
}

}  // namespace odis::render
