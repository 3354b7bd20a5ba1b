// The colours of sun and clear sky. Radiance is spectral, W/(m^2 sr nm), weighed by the CIE 1931 observer to
// linear RGB, the units of Mitsuba's sun and sky.
//
// The models are those of Hošek and Wilkie, "An Analytic Model for Full Spectral Sky-Dome Radiance", 2012,
// and "Adding a Solar-Radiance Function to the Hošek-Wilkie Skylight Model", 2013, with the authors'
// coefficients. The sky is that of Mitsuba 3.9. So is the sun above an elevation of 5 degrees, to 1 %; lower
// down Mitsuba interpolates between multiples of 3 degrees, or below 2 holds what it has there, where the
// model fades.
#pragma once

#include <array>

#include "render/math/vec.h"

namespace odis::render {

// The sky for the sun at an angle from the zenith (radians, at most pi / 2), a turbidity of 1 (very clear) to
// 10 (hazy) and an albedo of the ground of 0 to 1; outside of these all are clamped.
class Sky {
 public:
  Sky(float turbidity, float sunZenith, const Rgb& albedo);

  // The sky at `cosTheta` above the horizon, `gamma` radians from the sun; black below the horizon.
  Rgb radiance(float cosTheta, float gamma) const;

 private:
  struct Channel {
    std::array<float, 9> shape;  // parameters of the paper's F(theta, gamma): A to G, I, H
    float mean;                  // radiance that F is a share of
  };
  Channel m_channels[3];
};

// Mean radiance of the sun's disc, 0.5358 degrees wide, after the atmosphere; black below the horizon. The
// turbidity is clamped to 1 to 10.
Rgb sunRadiance(float turbidity, float sunZenith);

}  // namespace odis::render
