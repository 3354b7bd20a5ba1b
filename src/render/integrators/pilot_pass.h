// The pilot alone, for those who look into the guide that is made of it.
#pragma once

#include <vector>

#include <odis/pixel_sums.h>

#include "render/integrators/render.h"

namespace odis::render {

struct PilotPass {
  std::vector<PixelSums> image;
  std::vector<PathVertex> vertices;  // tile by tile, path by path; contributions in units of radiance
  std::vector<float> pixelValues;    // that contributions are divided by
  GuideOptions guideOptions;         // as the guide is built with
  bool interrupted = false;
};

// The pilot of `render` with these options: GuideBuilder(guideOptions) makes the first guide of it. Throws
// OptionError for methods that have none.
PilotPass renderPilot(const Scene& scene, const RenderOptions& options, Progress& progress);

}  // namespace odis::render
