// The colours of sun and clear sky. Radiance is spectral, W/(m^2 sr nm), weighed by the CIE 1931 observer to
// linear RGB, the units of Mitsuba's sun and sky.
//
// The values follow the models of Hošek and Wilkie, "An Analytic Model for Full Spectral Sky-Dome Radiance",
// 2012, and "Adding a Solar-Radiance Function to the Hošek-Wilkie Skylight Model", 2013, as Mitsuba 3.9
// evaluates them. They come from formulas of our own in their stead, whose few coefficients are fitted to
// them; how near, says daylight.cpp.
#pragma once

#include "render/math/vec.h"

namespace odis::render {

// The sky for the sun at an angle from the zenith (radians, at most pi / 2), a turbidity of 2 (very clear) to
// 10 (hazy) and an albedo of the ground of 0 to 1; outside of these all are clamped.
class Sky {
 public:
  Sky(float turbidity, float sunZenith, const Rgb& albedo);

  // The sky at `cosTheta` above the horizon, `gamma` radians from the sun; black below the horizon.
  Rgb radiance(float cosTheta, float gamma) const;

 private:
  static constexpr int kTerms = 9;
  Rgb m_terms[kTerms];  // factors of functions of the direction that add up to the radiance's logarithm
  Rgb m_ground;         // and of the ground's
};

// Mean radiance of the sun's disc, 0.5358 degrees wide, after the atmosphere; black below the horizon.
Rgb sunRadiance(float turbidity, float sunZenith);

}  // namespace odis::render
