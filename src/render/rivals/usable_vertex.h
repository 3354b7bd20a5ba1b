// Which of the recorded vertices a rival can learn from, and what.
#pragma once

#include <odis/pilot.h>

#include "render/math/vec.h"

namespace odis::render {

inline float luminance(const Float3& c) {
  return luminance(Rgb(c.x, c.y, c.z));
}

// Whether a direction was drawn from a density and everything is finite.
inline bool isUsable(const PilotVertex& v) {
  const auto finite = [](const Float3& f) { return isFinite(Vec3(f.x, f.y, f.z)); };
  return !v.discrete && v.pdf > 0 && v.survival > 0 && std::isfinite(v.pdf) && finite(v.position) &&
         finite(v.wi) && finite(v.radiance) && finite(v.weight);
}

// The probability density with which a path went on in the direction: the radiance that arrived, divided by
// it, is what a vertex contributes to the integral over directions. Roulette left out the others.
inline float survivingPdf(const PilotVertex& v) {
  return v.pdf * v.survival;
}

}  // namespace odis::render
