// Reference images: rendered once by plain path tracing, kept in a folder.
#pragma once

#include <optional>
#include <string>

#include "eval/image_file.h"
#include "eval/metrics.h"
#include "render/integrators/render.h"

namespace odis::eval {

struct Reference {
  ColorImage image;                     // without pixels if rendering it was cancelled
  std::optional<ReferenceError> error;  // its own, if the variance of its pixels is known
  std::string file, settings;           // where it lies and what it is
  double secondsRendered = 0;           // 0: it was there
};

// The image of `scene` by path tracing with `spp` samples per pixel and the depth, roulette and threads of
// `options`. It is read from `folder` if it lies there with as many samples or more: its file is named after
// the scene and a hash of everything that it depends on (`sceneHash`, size, crop, depth, roulette, filter,
// samples). Otherwise it is rendered and put there with the variance of its pixels. Throws ImageError,
// std::runtime_error if it can't be read or written.
Reference cachedReference(const render::Scene& scene, const std::string& name, uint64_t sceneHash,
                          render::RenderOptions options, const std::string& folder,
                          render::Progress& progress);

// Any EXR file; its error is known if it has channels variance.R, ... (of each pixel's mean) or stderr.R, ...
// Throws ImageError.
Reference readReference(const std::string& path);

}  // namespace odis::eval
