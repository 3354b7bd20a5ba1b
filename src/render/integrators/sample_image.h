// Single samples of every pixel, for those who look into their variance.
#pragma once

#include <functional>
#include <vector>

#include "render/integrators/render.h"
#include "render/path/pass.h"

namespace odis::render {

// One sample of every pixel of the crop.
struct SampleImage {
  std::vector<Rgb> value;
  std::vector<Rgb> emitted;  // what of it the camera ray met directly
  uint64_t rays = 0;         // shadow rays included
};

// Renders a sample of every pixel with independent numbers, those for `redrawn` being others than without it.
using SampleRenderer = std::function<SampleImage(uint32_t sample, Purposes redrawn)>;

// Does all that comes before the last sample of `render` with these options, pilot and guide for example,
// then calls `use` with what renders samples the way that one is rendered, of other numbers than any sample
// of the image. Throws OptionError for methods that have no such samples.
void renderSamples(const Scene& scene, const RenderOptions& options, Progress& progress,
                   const std::function<void(const SampleRenderer&)>& use);

// Renders a sample of every pixel the way that a pass of an image does, with independent numbers that no
// pass of the image draws.
SampleImage renderSampleImage(Pass pass, uint32_t sample, Purposes redrawn, Progress& progress,
                              const std::function<bool()>& stop);

}  // namespace odis::render
