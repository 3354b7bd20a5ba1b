// Rendering a scene: options in, images and statistics out.
#pragma once

#include <string>
#include <vector>

#include "render/integrators/options.h"
#include "render/path/progress.h"
#include "render/path/rendered_image.h"
#include "render/scene/scene.h"

namespace odis::render {

struct RenderStats {
  // Times of the stages; without a pilot, secondsGuided is that of all but building.
  double secondsPilot = 0, secondsBuild = 0, secondsGuided = 0;
  uint64_t samples = 0, pilotSamples = 0, rays = 0, shadowRays = 0;
  uint64_t pilotVertices = 0, cells = 0;
  uint64_t cellsBuilt = 0;  // in secondsBuild: those of all guides, of which the last has `cells`
  uint64_t bytesBuild = 0;  // held at most until the guide is built: pilot vertices and what is made of them
  uint64_t bytesMaps = 0, bytesLights = 0;
  bool guidingGivenUp = false;  // since it does not pay
  double pilotShare = 0;        // of the pilot in the weights of all samples
  double spp = 0;               // samples per pixel really taken
  // In the mean of any pixel: from 2 on there is a variance everywhere. Of a film that splats it is not known
  // whether there are more than that.
  uint32_t fewestSamples = 0;
  // The time of a guided sample in that of a pilot sample, recording included; 0 if there was none of either.
  double guidedCost() const {
    const uint64_t guided = samples - pilotSamples;
    if (pilotSamples == 0 || guided == 0 || !(secondsPilot > 0)) return 0;
    return secondsGuided / double(guided) / (secondsPilot / double(pilotSamples));
  }
  bool interrupted = false;  // before all samples were taken
};

struct RenderResult {
  RenderedImage image;
  RenderStats stats;
  // If asked for: the pilot's vertices, in the order of the tiles, and the emission that its camera rays met
  // (summed over a pixel's samples).
  std::vector<PathVertex> records;
  std::vector<Rgb> pilotEmitted;
};

// Whether samples after the pilot are guided, and whether paths may end in the cache.
bool isGuiding(const RenderOptions& options);
bool isCaching(const RenderOptions& options);
// Whether any sample was guided.
inline bool isGuiding(const RenderOptions& options, const RenderStats& stats) {
  return isGuiding(options) && stats.samples > stats.pilotSamples;
}

RenderResult render(const Scene& scene, const RenderOptions& options, Progress& progress);

// Traces the one path of `render` with these options that belongs to a pixel of the full image and a sample,
// and describes each of its vertices, a line each.
std::string replay(const Scene& scene, const RenderOptions& options, Vec2i pixel, int sample);

}  // namespace odis::render
