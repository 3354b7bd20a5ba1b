// Reference images: rendered once by plain path tracing, kept in a folder.
#pragma once

#include <string>

#include "eval/image_file.h"
#include "render/integrator/render.h"

namespace odis::eval {

// The image of `scene` by path tracing with `spp` samples per pixel and the depth and roulette of `options`.
// It is read from `folder` if it lies there: its file is named after the scene and a hash of everything that
// it depends on
// (`sceneHash`, size, crop, depth, roulette, filter, samples). Otherwise it is rendered and put there.
// Without pixels if rendering it was cancelled. Throws std::runtime_error if it can't be read or written.
ColorImage cachedReference(const render::Scene& scene, const std::string& name, uint64_t sceneHash,
                           render::RenderOptions options, int spp, const std::string& folder,
                           render::Progress& progress);

}  // namespace odis::eval
