// restir: frames in which pixels resample their neighbours' paths (docs/rivals.md), averaged.
#include "render/rivals/restir.h"

#include "render/integrators/integrator.h"

namespace odis::render {

namespace {

class RestirIntegrator : public Integrator {
 public:
  explicit RestirIntegrator(RenderJob& job)
      : m_job(job), m_image(job.pixelCount()), m_film(job.newColorFilm()) {
    if (job.options().features)
      throw OptionError("--integrator restir: renders the image alone, no features (--aov)");
    if (!job.scene().media().empty())
      throw OptionError("--integrator restir: does not know participating media, which the scene has");
  }

  // Frames know nothing of each other.
  void render() override {
    const RenderOptions& options = m_job.options();
    const Stopwatch stopwatch;
    m_job.progress().begin("restir", m_job.pixelCount() * uint64_t(options.spp));
    const Pass pass = m_job.pass();
    for (uint32_t sample = 0; sample < uint32_t(options.spp) && !m_job.stop(); ++sample)
      m_job.count(renderRestirFrame({pass, options.restir, m_image, m_film.get()}, sample, m_job.progress(),
                                    m_job.stopFunction()));
    m_job.progress().end();
    m_job.stats.secondsGuided = stopwatch.seconds();
  }

  Pass passBefore(uint32_t, uint32_t) override {
    throw OptionError("--integrator restir: a pixel is made of many paths, it has no samples of its own");
  }

  void finish(RenderResult& result) override {
    for (const PixelSums& s : m_image) result.stats.samples += s.count;
    if (m_film) return fillPixels(result, *m_film);
    fillPixels(result, m_job.options(), [this](uint32_t pixel) {
      const WeightedSums part{&m_image[pixel], 1};
      return meanOfParts({&part, 1});
    });
  }

 private:
  RenderJob& m_job;
  std::vector<PixelSums> m_image;
  std::unique_ptr<SplatFilm> m_film;  // null unless it splats
};

}  // namespace

std::unique_ptr<Integrator> makeRestirIntegrator(RenderJob& job) {
  return std::make_unique<RestirIntegrator>(job);
}

}  // namespace odis::render
