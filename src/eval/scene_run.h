// One scene's share of a comparison.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "eval/compare.h"
#include "eval/reference.h"
#include "eval/results_log.h"
#include "eval/schedule.h"

namespace odis::eval {

// How many samples per pixel a rendering takes, and what for.
struct Budget {
  int spp = 0;             // of the first method
  int samples = 0;         // of this one: the same, or what fits in the time
  bool equalTime = false;  // which of the two
};

class SceneRun {
 public:
  // Loads the scene; renders its reference if it is not there yet. All arguments must outlive the run.
  SceneRun(const CompareSettings& settings, const std::string& path, ResultsLog& log, Schedule& schedule,
           CompareObserver& observer);
  const SceneRecord& record() const { return m_record; }
  // Looks the result up or renders: the image, and the same denoised if that is asked for. Worth nothing if
  // progress is cancelled.
  std::vector<Measurement> measure(const Method& method, const Budget& budget, uint64_t seed);

 private:
  // What earlier runs left, if all of it is there.
  std::optional<std::vector<Measurement>> known(const Method& method, const std::string& key,
                                                uint64_t seed) const;
  Measurement measureImage(const Measurement& what, const Method& method, const render::RenderedImage& image);
  std::optional<Measurement> measureDenoised(Measurement noisyOne, const Method& method,
                                             const render::RenderedImage& noisy);
  void renderFeatures(const render::RenderOptions& options);
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
  // Albedo and normals for the denoiser, of the samples and the seed that were asked for last.
  render::RenderedImage m_features;
  std::pair<int, uint64_t> m_featuresOf{0, 0};
};

}  // namespace odis::eval
