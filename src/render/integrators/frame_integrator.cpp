#include "render/integrators/frame_integrator.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>

#include "render/image/fill_gaps.h"

namespace odis::render {

namespace {

const char* stageName(const FramePass& pass) {
  if (pass.kind == ODIS_PASS_PILOT) return "pilot";
  if (pass.kind == ODIS_PASS_ORACLE) return "oracle";
  return pass.guide->cellCount > 0 ? "guided" : "path";
}

// Lets paths use what the guide has learned, as far as the options allow.
void useGuide(PathSettings& settings, const GuideView& guide, const RenderOptions& options) {
  settings.guide = &guide;
  settings.learnedLights = options.setting("lights") != "hierarchy";
  settings.shadowRoulette = options.setting("shadow-rays") == "roulette";
  settings.learnedRoulette = options.setting("roulette") != "throughput";
}

}  // namespace

FrameOptions frameOptions(const RenderJob& job) {
  const RenderOptions& options = job.options();
  FrameOptions frame = job.tiles().asFrame();
  frame.keepPixelMeans = job.film() == FilmKind::pixels;
  frame.samplesPerPixel = uint32_t(options.spp);
  frame.seed = options.seed;
  frame.settings = options.settings;
  frame.set("max-depth=" + std::to_string(std::max(options.maxDepth, 0)));
  return frame;
}

void FrameIntegrator::beginStage(const FramePass& framePass) {
  const char* stage = stageName(framePass);
  if (m_stage == stage) return m_job.progress().changeTotal(framePass.stageSamples);
  if (m_stage) m_job.progress().end();
  m_stage = stage;
  const FrameStatistics frame = m_frame.statistics();
  const bool pilot = framePass.kind == ODIS_PASS_PILOT;
  m_job.progress().begin(stage, framePass.stageSamples,
                         pilot ? frame.samples : frame.samples - frame.pilotSamples);
}

Pass FrameIntegrator::passOf(const FramePass& framePass) {
  Pass pass = m_job.pass();
  pass.seed = framePass.seed;
  if (framePass.guide->cellCount > 0) useGuide(pass.path, *framePass.guide, m_job.options());
  if (framePass.kind == ODIS_PASS_GUIDED) pass.pixelValues = m_frame.pixelValues();
  if (framePass.kind == ODIS_PASS_PILOT && m_job.options().records) pass.emitted = &m_job.pilotEmitted;
  pass.splats.colors = m_film.get();
  pass.splats.keep = framePass.weightsLater;
  if (!framePass.partOfImage) {
    pass.features = nullptr;
    pass.guideFeatures = nullptr;
    pass.splats = {};
    pass.path.features = false;
  }
  pass.samples = [this](uint32_t pixel) { return m_frame.samples(pixel); };
  pass.deliver = [this](uint32_t, ArrayView<const FrameSample> samples,
                        ArrayView<const PathVertex> vertices) {
    if (samples.empty()) return;  // of a tile that was done before the pass went on
    m_frame.add(samples, vertices);
    m_saver.noteNews();
  };
  pass.wantsVertices = framePass.wantsVertices;
  return pass;
}

// Shows what there is; pixels without a sample as those around them.
void FrameIntegrator::showPicture() {
  std::vector<Rgb> colors(m_job.crop().pixels());
  std::vector<float> weights(colors.size());
  const std::vector<float> sums = m_film ? m_film->sums() : std::vector<float>();
  tbb::parallel_for(tbb::blocked_range<size_t>(0, colors.size()), [&](const auto& range) {
    for (size_t pixel = range.begin(); pixel < range.end(); ++pixel) {
      if (m_film) {
        const float* at = &sums[pixel * size_t(m_film->channels())];
        weights[pixel] = at[3] > 0 ? 1 : 0;
        colors[pixel] = at[3] > 0 ? Rgb(at[0], at[1], at[2]) / at[3] : Rgb(0, 0, 0);
        continue;
      }
      const Float3 color = m_frame.mean(uint32_t(pixel)).color;
      colors[pixel] = Rgb(color.x, color.y, color.z);
      weights[pixel] = m_frame.sampleCount(uint32_t(pixel)) > 0 ? 1 : 0;
    }
  });
  fillGaps(m_job.crop().width, m_job.crop().height, weights, colors);
  m_job.progress().showPicture(m_job.crop().width, m_job.crop().height, std::move(colors));
}

// Traces a pass. It pauses to be saved and to show a picture, and goes on where it was.
void FrameIntegrator::trace(const FramePass& framePass) {
  RenderStats& stats = m_job.stats;
  double& seconds = framePass.kind == ODIS_PASS_PILOT    ? stats.secondsPilot
                    : framePass.kind == ODIS_PASS_ORACLE ? stats.secondsBuild
                                                         : stats.secondsGuided;
  beginStage(framePass);
  for (bool leftOut = true; leftOut && !m_job.interrupted();) {
    const Stopwatch tracing;
    std::atomic<bool> paused{false};
    m_job.count(runPass(passOf(framePass), m_job.progress(), [&] {
      const bool pause = m_job.stop() || m_saver.isDue() || m_job.progress().wantsPicture();
      if (pause) paused = true;
      return pause;
    }));
    seconds += tracing.seconds();
    leftOut = paused;
    // No guide is built for samples that there is no time for.
    const bool interrupted = m_job.interrupted() || (framePass.wantsVertices && m_job.stop());
    if (interrupted || (leftOut && m_saver.isDue())) m_saver.save(m_frame);
    if (m_job.progress().wantsPicture() && !interrupted) showPicture();
  }
}

void FrameIntegrator::run(const FramePass& framePass) {
  RenderStats& stats = m_job.stats;
  const OdisPassKind kind = framePass.kind;
  if (m_guideIsNew) stats.cellsBuilt += framePass.guide->cellCount;
  trace(framePass);
  const Stopwatch building;
  const bool hasKept = framePass.weightsLater, interrupted = m_job.interrupted();
  m_frame.endPass(interrupted);
  if (hasKept) addKept(interrupted);
  m_guideIsNew = kind != ODIS_PASS_GUIDED || framePass.wantsVertices;
  if (m_guideIsNew) stats.secondsBuild += building.seconds();
}

// Adds the samples of a pass that has settled what they weigh. A frame without means counts samples of passes
// that were not interrupted: the last of those, or else the next one, is of this pass.
void FrameIntegrator::addKept(bool interrupted) {
  const auto weight = [this, interrupted](uint32_t pixel) {
    return m_frame.sampleWeight(pixel, m_frame.sampleCount(pixel) - (interrupted ? 0 : 1));
  };
  if (m_film) m_film->addKept(weight);
  if (m_job.featureFilm) m_job.featureFilm->addKept(weight);
}

void FrameIntegrator::render() {
  while (const FramePass* pass = m_frame.beginPass()) run(*pass);
  if (m_stage) m_job.progress().end();
}

void FrameIntegrator::tracePilot() {
  trace(*m_frame.beginPass());
  m_frame.endPass(true);
  m_job.progress().end();
}

Pass FrameIntegrator::passBefore(uint32_t pixel, uint32_t sample) {
  while (const FramePass* pass = m_frame.beginPass()) {
    const SampleRange range = m_frame.samples(pixel);
    const bool contains = pass->partOfImage && sample >= range.first && sample < range.first + range.count;
    if (contains || m_frame.guideIsFinal()) return passOf(*pass);
    run(*pass);
  }
  return m_job.pass();  // interrupted
}

void FrameIntegrator::finish(RenderResult& result) {
  if (m_film) {
    fillPixels(result, *m_film);
  } else {
    const ArrayView<const PixelSums> pilot = m_frame.pilotImage();
    const bool pilotWeighs = m_job.options().settingNumber("pilot-weight") > 0;
    fillPixels(result, m_job.options(), [&](uint32_t pixel) {
      const uint32_t samples = m_frame.sampleCount(pixel), later = samples - pilot[pixel].count;
      const bool pilotCounts = pilotWeighs || later == 0;
      return MeanOfSamples{m_frame.mean(pixel), pilotCounts ? samples : later};
    });
  }
  const FrameStatistics frame = m_frame.statistics();
  RenderStats& stats = result.stats;
  stats.samples = frame.samples;
  stats.pilotSamples = frame.pilotSamples;
  stats.pilotVertices = frame.pilotVertices;
  stats.cells = frame.cells;
  stats.bytesMaps = frame.guideBytes;
  stats.bytesBuild = frame.buildingBytes;
  stats.guidingGivenUp = frame.guidingGivenUp;
  stats.pilotShare = frame.pilotFraction;
}

}  // namespace odis::render
