// The paths that resampling starts from: one a pixel and frame.
#pragma once

#include "render/rivals/restir_sample.h"

namespace odis::render {

struct RestirPath {
  VisiblePoint point;
  SecondaryPoint sample;  // what the pixel itself found; not valid if that cannot be shared or is nothing
  Rgb radiance{0, 0, 0};  // all that is not up for sharing
  RayCounts counts;
};

// Traces a camera ray. `further` are numbers independent of `sampler`'s.
RestirPath traceRestirPath(const PathSettings& settings, const Ray& cameraRay, Sampler sampler,
                           const Sampler& further);

}  // namespace odis::render
