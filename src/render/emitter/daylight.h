// The colours of sun and clear sky: Preetham, Shirley, Smits, "A Practical Analytic Model for Daylight",
// SIGGRAPH 1999. Radiance is spectral, W/(m^2 sr nm), weighed by the CIE 1931 observer to linear RGB (a flat
// spectrum of 1 is white 1), the units of Mitsuba's sun and sky.
#pragma once

#include "render/math/vec.h"

namespace odis::render {

// The sky for the sun at an angle from the zenith (radians, at most pi / 2) and a turbidity of 2 (very clear)
// to 10 (hazy); outside of these both are clamped.
class Sky {
 public:
  Sky(float turbidity, float sunZenith);

  // The sky at `cosTheta` above the horizon, `gamma` radians from the sun; black below the horizon.
  Rgb radiance(float cosTheta, float gamma) const;

 private:
  struct Perez {
    float a, b, c, d, e;
    float operator()(float cosTheta, float gamma) const {
      const float cosGamma = std::cos(gamma);
      return (1 + a * std::exp(b / cosTheta)) * (1 + c * std::exp(d * gamma) + e * cosGamma * cosGamma);
    }
  };

  Perez m_luminance, m_x, m_y;
  float m_scaleLuminance, m_scaleX, m_scaleY;  // values at the zenith over those of the Perez function
};

// Radiance of the sun's disc, 0.5358 degrees wide, after the atmosphere; black below the horizon.
Rgb sunRadiance(float turbidity, float sunZenith);

}  // namespace odis::render
