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

#include "render/math/elementary.h"

namespace odis::render {

// The sky for the sun at an angle from the zenith (radians, at most pi / 2), a turbidity of 1 (very clear) to
// 10 (hazy) and an albedo of the ground of 0 to 1; outside of these all are clamped.
class Sky {
 public:
  Sky(float turbidity, float sunZenith, const Rgb& albedo);

  // The sky above the horizon: at an angle from the zenith whose cosine is at least 0, `gamma` radians, at
  // most pi, from the sun. Without branches or calls, so that loops over lanes become vectors.
  Rgb radiance(float cosTheta, float gamma, float cosGamma) const;

 private:
  struct Channel {
    std::array<float, 9> shape;  // parameters of the paper's F(theta, gamma): A to G, I, H
    float mean;                  // radiance that F is a share of

    float radiance(float cosTheta, float gamma, float cosGamma) const;
  };
  Channel m_channels[3];
};

// Equation 8 of the paper; chi is the glow around the sun.
[[gnu::always_inline]] inline float Sky::Channel::radiance(float cosTheta, float gamma,
                                                           float cosGamma) const {
  const auto& [A, B, C, D, E, F, G, I, H] = shape;
  const float cosGamma2 = cosGamma * cosGamma, toSun = 1 + H * H - 2 * H * cosGamma;
  const float chi = (1 + cosGamma2) / (toSun * std::sqrt(toSun));
  const float glow = exponential(std::min(B / (cosTheta + 0.01f), 88.0f));
  const float share =
      (1 + A * glow) * (C + D * exponential(E * gamma) + F * cosGamma2 + G * chi + I * std::sqrt(cosTheta));
  // Below 0 where the colour is outside of RGB: blue at the horizon away from a sun that sets.
  return std::max(0.0f, share * mean);
}

[[gnu::always_inline]] inline Rgb Sky::radiance(float cosTheta, float gamma, float cosGamma) const {
  const float r = m_channels[0].radiance(cosTheta, gamma, cosGamma),
              g = m_channels[1].radiance(cosTheta, gamma, cosGamma),
              b = m_channels[2].radiance(cosTheta, gamma, cosGamma);
  return {r, g, b};
}

// Mean radiance of the sun's disc, 0.5358 degrees wide, after the atmosphere; black below the horizon. The
// turbidity is clamped to 1 to 10.
Rgb sunRadiance(float turbidity, float sunZenith);

}  // namespace odis::render
