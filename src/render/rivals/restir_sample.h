// What the pixels of a frame share when they resample (Ouyang et al. 2021, "ReSTIR GI"; Lin et al. 2022,
// "Generalized Resampled Importance Sampling").
//
// A path is cut at the first vertex x1 that has lobes which may be guided. What arrives there along
// directions drawn from those lobes is scattered towards x1 by a second vertex x2. A sample is x2 with all
// that follows: light that next-event estimation found there, the direction in which the path went on, and
// the radiance that came from there. Another pixel takes it over by connecting its own x1 to x2; only the
// two BSDFs next to that connection change.
#pragma once

#include <odis/mixture.h>

#include "render/path/path.h"

namespace odis::render {

// x1 of a pixel. It does not depend on which lobe was drawn there.
struct VisiblePoint {
  bool valid = false;
  SurfacePoint at;
  Vec3 wo{0, 0, 1};         // local, towards the camera
  Rgb throughput{0, 0, 0};  // from the camera to there
  int depth = 0;            // 1 for the first vertex of the path
};

// x2 and what follows.
struct SecondaryPoint {
  bool valid = false;
  SurfacePoint at;
  bool back = false;  // whether the shading normal looks away from x1
  // Next-event estimation: radiance / pdf, black if something hides it; pdf 0 where MIS does not apply.
  Vec3 lightDirection{0, 0, 1};
  Rgb light{0, 0, 0};
  float lightPdf = 0;
  // Where the path went on: the emitter met there and what arrives from it besides.
  Vec3 wi{0, 0, 1};
  Rgb emission{0, 0, 0};
  float emissionPdf = 0;  // the density with which next-event estimation would have found the emitter
  Rgb beyond{0, 0, 0};
  // The density with which the sample was drawn: of the direction from x1, per solid angle there, times
  // that of `wi` at x2. Densities of what follows are the same for all pixels, and left out everywhere.
  float pdf = 0;
};

// What a sample contributes to a pixel, per area of x2 and per solid angle of `wi`: the value of the
// integrand, and cos(theta) / distance^2 from x1 to x2, which turns densities per solid angle into ones per
// area.
struct Contribution {
  Rgb value{0, 0, 0};
  float geometry = 0;
  Vec3 direction{0, 0, 1};  // from x1 to x2
  float distance = 0;
  float target() const { return luminance(value); }
};

// Without looking whether anything lies between. Zero where the sample cannot be taken over.
Contribution contributionOf(const SecondaryPoint& sample, const VisiblePoint& point);

}  // namespace odis::render
