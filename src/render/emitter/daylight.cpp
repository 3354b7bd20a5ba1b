#include "render/emitter/daylight.h"

#include "render/emitter/hosek_wilkie.h"

namespace odis::render {

namespace {

using namespace hosek_wilkie;

// Where a value, of 0 to the last index, lies in a table of equal steps: between `index` and the entry after
// it.
struct Position {
  int index;
  float fraction;
};

Position positionIn(float value, int entries) {
  const int index = std::min(int(value), entries - 2);
  return {index, value - float(index)};
}

Position turbidityPosition(float turbidity) {
  return positionIn(limited(turbidity, 1.0f, float(kTurbidities)) - 1, kTurbidities);
}

// Both data sets follow the cube root of the sun's elevation: 0 at the horizon, 1 at the zenith.
float elevationParameter(float sunZenith) {
  return std::cbrt(limited(1 - sunZenith / (kPi / 2), 0.0f, 1.0f));
}

// Bernstein polynomials of degree 5.
std::array<float, kControlPoints> bernstein(float x) {
  const float y = 1 - x;
  return {y * y * y * y * y,      5 * x * y * y * y * y, 10 * x * x * y * y * y,
          10 * x * x * x * y * y, 5 * x * x * x * x * y, x * x * x * x * x};
}

// Cubic Hermite interpolation from b to c with central differences as slopes (Catmull and Rom, "A Class of
// Local Interpolating Splines", 1974).
float catmullRom(float t, float a, float b, float c, float d) {
  const float slopeB = (c - a) / 2, slopeC = (d - b) / 2;
  return b + t * (slopeB + t * (3 * (c - b) - 2 * slopeB - slopeC + t * (2 * (b - c) + slopeB + slopeC)));
}

}  // namespace

Sky::Sky(float turbidity, float sunZenith, const Rgb& albedo) {
  const Position haze = turbidityPosition(turbidity);
  const std::array<float, kControlPoints> basis = bernstein(elevationParameter(sunZenith));
  for (int c = 0; c < 3; ++c) {
    const float ground = limited(albedo[c], 0.0f, 1.0f);
    m_channels[c] = {};
    // Bézier curves in the sun's elevation, linear between turbidities and albedos.
    for (int t = 0; t < 2; ++t)
      for (int a = 0; a < kAlbedos; ++a)
        for (int k = 0; k < kControlPoints; ++k) {
          const float weight = (t == 0 ? 1 - haze.fraction : haze.fraction) * (a == 0 ? 1 - ground : ground) *
                               basis[size_t(k)];
          for (int i = 0; i < kShapeParameters; ++i)
            m_channels[c].shape[size_t(i)] += weight * kSkyShape[haze.index + t][a][k][c][i];
          m_channels[c].mean += weight * kSkyRadiance[haze.index + t][a][k][c];
        }
    m_channels[c].mean /= kCieYIntegral;
  }
}

Rgb sunRadiance(float turbidity, float sunZenith) {
  if (!(sunZenith <= kPi / 2)) return {0, 0, 0};
  const Position haze = turbidityPosition(turbidity);
  const Position height = positionIn(elevationParameter(sunZenith) * (kSunKnots - 1), kSunKnots);
  Rgb result(0, 0, 0);
  for (int t = 0; t < 2; ++t) {
    const auto& knots = kSunRadiance[haze.index + t];
    const float weight = t == 0 ? 1 - haze.fraction : haze.fraction;
    for (int c = 0; c < 3; ++c)
      result[c] += weight * catmullRom(height.fraction, knots[std::max(height.index - 1, 0)][c],
                                       knots[height.index][c], knots[height.index + 1][c],
                                       knots[std::min(height.index + 2, kSunKnots - 1)][c]);
  }
  return {std::max(result.x, 0.0f), std::max(result.y, 0.0f), std::max(result.z, 0.0f)};
}

}  // namespace odis::render
