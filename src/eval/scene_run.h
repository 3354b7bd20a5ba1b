// One scene's share of a comparison.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "eval/compare.h"
#include "eval/reference.h"
#include "eval/results_log.h"
#include "eval/schedule.h"
#include "render/integrators/auxiliary_images.h"

namespace odis::eval {

// How many samples per pixel a rendering takes, and what for.
struct Budget {
  int spp = 0;             // of the first method
  int samples = 0;         // of this one: the same, or what fits in the time
  bool equalTime = false;  // which of the two
};

class SceneRun {
 public:
  // Loads the scene. All arguments must outlive the run.
  SceneRun(const CompareSettings& settings, const std::string& path, ResultsLog& log, Schedule& schedule,
           CompareObserver& observer);
  // Tells the schedule what a sample takes, if there is something to be rendered.
  void timeASample();
  // Renders the reference if it is not there yet. To be called before measure().
  void takeReference();
  const SceneRecord& record() const { return m_record; }
  // Looks the result up or renders: the image, and the same denoised if that is asked for. Worth nothing if
  // progress is cancelled.
  std::vector<Measurement> measure(const Method& method, const Budget& budget, uint64_t seed);

  // What was planned for the budget needs no rendering.
  void skip(const Budget& budget);

 private:
  // Returns the options of a path-traced image with the comparison's depths and threads.
  render::RenderOptions plainOptions(int spp) const;
  // What earlier runs left, if all of it is there.
  std::optional<std::vector<Measurement>> known(const Method& method, const std::string& key,
                                                uint64_t seed) const;
  Measurement measureImage(const Measurement& what, const Method& method, const render::RenderedImage& image);
  std::optional<Measurement> measureDenoised(Measurement noisyOne, const Method& method,
                                             const render::RenderedImage& noisy);
  void renderAuxiliariesOf(uint64_t seed, int threads);
  std::string denoisedKey(const std::string& key) const;
  std::string keyOf(const Method& method, const render::RenderOptions& options, const Budget& budget) const;
  std::string writeImage(const Measurement& m, const Method& method,
                         const render::RenderedImage& frame) const;

  const CompareSettings& m_settings;
  ResultsLog& m_log;
  Schedule& m_schedule;
  CompareObserver& m_observer;
  std::unique_ptr<render::Scene> m_scene;
  SceneRecord m_record;
  Reference m_reference;
  // What the denoiser is told beside colours, of all methods alike, with the seed that was asked for last;
  // and what it took to render.
  render::AuxiliaryImages m_auxiliaries;
  uint64_t m_auxiliarySeed = 0;
  double m_auxiliarySeconds = 0, m_auxiliaryCpuSeconds = 0;
};

}  // namespace odis::eval
