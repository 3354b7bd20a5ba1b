// What all integrators share while they render one image: the scene, the options, progress and time limit,
// sums of features.
#pragma once

#include <tbb/global_control.h>

#include <atomic>
#include <chrono>

#include "render/integrators/render.h"
#include "render/path/pass.h"

namespace odis::render {

class RenderJob {
 public:
  RenderJob(const Scene& scene, const RenderOptions& options, Progress& progress);

  const Scene& scene() const { return m_scene; }
  const RenderOptions& options() const { return m_options; }
  const LightSampler& lights() const { return m_lights; }
  const Crop& crop() const { return m_scene.film().crop; }
  // Which kind of film the image has, and the pixels that are sampled for it: with a film that splats, those
  // around the crop as well. Pixels are counted in these.
  FilmKind film() const { return m_film; }
  const SampledTiles& tiles() const { return m_tiles; }
  size_t pixelCount() const { return m_tiles.sampled().pixels(); }
  // The numbers of a pixel of the full image, and of the crop's pixel number `index`.
  uint32_t pixelIndex(const Vec2i& pixel) const { return m_tiles.pixelIndex(pixel); }
  uint32_t pixelOfCrop(size_t index) const;
  // A new film of the colours; null unless it splats.
  std::unique_ptr<SplatFilm> newColorFilm() const;

  // A pass of unguided samples; samples() and deliver() are left to fill in.
  Pass pass();
  // Runs a pass and counts its rays.
  void run(const Pass& pass);
  void count(const RayCounts& counts);
  // Whether rendering should end; once it does it stays so. To be asked only while there is more to do.
  bool stop();
  // Whether stop() has ended it.
  bool interrupted() const { return m_stopped; }
  std::function<bool()> stopFunction();
  Progress& progress() { return m_progress; }

  RenderStats stats;
  // Empty or null unless asked for; features are on a film if that splats.
  std::vector<FeatureSums> features;
  std::vector<GuideFeatureSums> guideFeatures;
  std::unique_ptr<SplatFilm> featureFilm;
  std::vector<Rgb> pilotEmitted;

 private:
  const Scene& m_scene;
  const RenderOptions& m_options;
  FilmKind m_film;
  SampledTiles m_tiles;
  Progress& m_progress;
  LightSampler m_lights;
  std::chrono::steady_clock::time_point m_start;
  std::atomic<bool> m_stopped{false};
};

// Limits the threads of everything that is done while it lives; 0: one a core.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);

 private:
  tbb::global_control m_control;
};

// Measures the time since it was made.
class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - m_start).count();
  }

 private:
  std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
};

}  // namespace odis::render
