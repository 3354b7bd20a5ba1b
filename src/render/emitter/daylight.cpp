#include "render/emitter/daylight.h"

#include <span>

namespace odis::render {

namespace {

constexpr float kDegree = kPi / 180;
constexpr float kLowestSun = 3;  // degrees; the tables are fitted from here to 89

// Logarithms of the sky's radiance, for red, green and blue: least squares over directions, turbidities of 2
// to 10 and elevations of the sun, on a ground of albedo 0.3; 7 % root mean square. A row belongs to one of
// the terms of a direction in Sky::radiance, a triple to 1, T / 10, (T / 10)^2 of the turbidity, its four
// entries to 1, x, x^2, x^3 of the cube root x of the sun's elevation over 90 degrees.
constexpr float kSky[3][9][3][4] = {{{{3.583f, -31.233f, 47.579f, -20.763f},
                                      {-30.815f, 157.899f, -203.76f, 73.978f},
                                      {17.811f, -109.538f, 145.744f, -49.346f}},
                                     {{-19.642f, 86.01f, -121.872f, 51.583f},
                                      {81.243f, -369.865f, 432.966f, -137.511f},
                                      {-55.282f, 290.496f, -328.393f, 82.243f}},
                                     {{14.599f, -78.357f, 118.949f, -54.99f},
                                      {-70.696f, 332.315f, -446.728f, 183.525f},
                                      {56.585f, -301.491f, 420.621f, -172.513f}},
                                     {{-5.538f, 26.659f, -39.341f, 17.423f},
                                      {21.158f, -112.699f, 156.236f, -64.048f},
                                      {-16.501f, 92.594f, -124.276f, 46.489f}},
                                     {{-0.309f, 0.778f, 0.976f, -1.516f},
                                      {-0.145f, 4.789f, -20.998f, 17.66f},
                                      {1.742f, -16.254f, 36.681f, -23.984f}},
                                     {{-3.292f, 15.274f, -28.931f, 17.666f},
                                      {14.946f, -18.248f, 52.472f, -40.525f},
                                      {-16.54f, 37.598f, -86.463f, 62.611f}},
                                     {{1.871f, -5.44f, 11.679f, -8.069f},
                                      {-2.591f, -22.299f, 14.841f, 4.107f},
                                      {4.164f, 7.338f, 5.801f, -14.62f}},
                                     {{0.624f, 0.632f, -2.396f, 1.196f},
                                      {-1.133f, -2.341f, 15.424f, -10.89f},
                                      {0.392f, 9.601f, -28.942f, 19.195f}},
                                     {{-1.895f, 14.096f, -30.404f, 18.74f},
                                      {12.199f, -87.563f, 193.161f, -122.523f},
                                      {-15.432f, 113.53f, -244.843f, 153.785f}}},
                                    {{{0.147f, -14.025f, 24.479f, -11.558f},
                                      {-23.448f, 116.826f, -149.016f, 55.353f},
                                      {15.67f, -98.417f, 138.145f, -54.037f}},
                                     {{-9.026f, 34.215f, -44.738f, 18.026f},
                                      {54.426f, -240.665f, 262.265f, -79},
                                      {-41.959f, 225.243f, -255.831f, 71.486f}},
                                     {{2.635f, -11.073f, 5.956f, 3.259f},
                                      {-33.888f, 129.927f, -113.352f, 13.278f},
                                      {33.161f, -164.894f, 190.781f, -54.753f}},
                                     {{-4.593f, 20.006f, -28.315f, 12.687f},
                                      {15.337f, -83.573f, 113.153f, -47.037f},
                                      {-11.617f, 68.341f, -88.606f, 32.556f}},
                                     {{-0.826f, 3.525f, -4.281f, 1.58f},
                                      {0.941f, -2.207f, -3.431f, 5.302f},
                                      {0.54f, -6.189f, 12.566f, -7.775f}},
                                     {{1.359f, -15.682f, 30.683f, -19.332f},
                                      {-12.963f, 141.851f, -250.321f, 143.823f},
                                      {7.305f, -100.892f, 183.281f, -104.241f}},
                                     {{0.013f, 5.996f, -11.188f, 7.129f},
                                      {8.421f, -79.227f, 128.895f, -70.476f},
                                      {-5.596f, 60.446f, -105.317f, 58.736f}},
                                     {{0.594f, -0.412f, 0.86f, -1.009f},
                                      {0.366f, -7.594f, 18.261f, -10.411f},
                                      {-1.881f, 19.4f, -41.241f, 24.576f}},
                                     {{1.259f, -7.364f, 13.642f, -9.041f},
                                      {-0.412f, 2.109f, 3.462f, 0.49f},
                                      {-5.021f, 35.803f, -75.879f, 42.88f}}},
                                    {{{-2.91f, -8.05f, 23.276f, -12.248f},
                                      {-17.344f, 88.765f, -112.09f, 37.372f},
                                      {14.879f, -93.886f, 139.19f, -58.776f}},
                                     {{-4.426f, 38.049f, -70.041f, 33.896f},
                                      {50.732f, -260.348f, 341.914f, -129.469f},
                                      {-46.205f, 261.185f, -358.763f, 143.175f}},
                                     {{-0.886f, -11.168f, 22.506f, -9.522f},
                                      {-27.2f, 132.725f, -163.153f, 53.045f},
                                      {29.21f, -154.613f, 201.121f, -72.683f}},
                                     {{-7.301f, 34.051f, -49.96f, 22.211f},
                                      {23.942f, -126.54f, 178.661f, -75.732f},
                                      {-18.202f, 101.035f, -142.853f, 60.024f}},
                                     {{-1.111f, 4.229f, -4.75f, 1.375f},
                                      {0.43f, 1.232f, -8.337f, 8.061f},
                                      {0.129f, -1.456f, 1.438f, -1.096f}},
                                     {{1.223f, -12.284f, 21.506f, -12.111f},
                                      {-23.507f, 154.562f, -244.895f, 127.078f},
                                      {19.537f, -130.082f, 214.071f, -111.534f}},
                                     {{0.219f, 2.983f, -5.134f, 2.526f},
                                      {11.607f, -77.147f, 120.398f, -60.122f},
                                      {-10.4f, 70.604f, -117.974f, 60.798f}},
                                     {{1.269f, -4.343f, 7.479f, -4.293f},
                                      {-0.528f, -0.064f, 2.555f, -2.071f},
                                      {-0.915f, 8.195f, -15.346f, 8.651f}},
                                     {{2.331f, -11.977f, 19.461f, -10.423f},
                                      {-5.559f, 30.453f, -46.05f, 24.283f},
                                      {2.099f, -11.255f, 17.63f, -10.789f}}}};

// Logarithms of the sun's radiance: rows for 1, sqrt(m), m, m^2, where 10 m is the air mass, columns for
// powers of T / 10. 2 % root mean square.
constexpr float kSun[3][4][5] = {{{10.077f, -0.041f, 0.256f, -0.491f, -0.174f},
                                  {0.117f, -0.046f, -0.166f, 0.435f, 2.185f},
                                  {-1.054f, 4.681f, -25.569f, 40.955f, -27.389f},
                                  {0.099f, -0.894f, 3.377f, -6.471f, 5.41f}},
                                 {{9.922f, 0.52f, -2.451f, 3.831f, -2.449f},
                                  {0.462f, -2.96f, 13.949f, -22.147f, 14.13f},
                                  {-2.296f, 9.077f, -47.342f, 75.829f, -46.168f},
                                  {0.388f, -2.853f, 13.072f, -22.087f, 13.921f}},
                                 {{9.725f, 3.847f, -20.183f, 34.325f, -19.313f},
                                  {1.161f, -20.286f, 106.368f, -180.888f, 101.905f},
                                  {-4.954f, 32.225f, -170.94f, 287.917f, -163.359f},
                                  {0.751f, -13.039f, 67.978f, -115.704f, 65.694f}}};

float polynomial(std::span<const float> coefficients, float x) {
  float sum = 0;
  for (size_t i = coefficients.size(); i-- > 0;) sum = sum * x + coefficients[i];
  return sum;
}

}  // namespace

Sky::Sky(float turbidity, float sunZenith, const Rgb& albedo) {
  const float t = std::clamp(turbidity, 2.0f, 10.0f) / 10;
  const float elevation = kPi / 2 - std::clamp(sunZenith, 0.0f, kPi / 2);
  const float x = std::cbrt(elevation / (kPi / 2));
  for (int c = 0; c < 3; ++c) {
    for (int k = 0; k < kTerms; ++k) {
      float inTurbidity[3];
      for (int i = 0; i < 3; ++i) inTurbidity[i] = polynomial(kSky[c][k][i], x);
      m_terms[k][c] = polynomial(inTurbidity, t);
    }
    // Light that the ground throws back, brightest near the horizon; fitted for albedos of 0 to 1.
    m_ground[c] = (std::clamp(albedo[c], 0.0f, 1.0f) - 0.3f) * std::sqrt(std::sin(elevation));
  }
}

Rgb Sky::radiance(float cosTheta, float gamma) const {
  if (!(cosTheta >= 0)) return {0, 0, 0};
  const float z = cosTheta, cosGamma = std::cos(gamma);
  const float terms[kTerms] = {1,
                               std::sqrt(z),
                               z,
                               std::exp(-20 * z),
                               gamma,
                               std::exp(-3 * gamma),
                               std::exp(-10 * gamma),
                               cosGamma * cosGamma,
                               gamma * z};
  Rgb logarithm = m_ground * std::exp(-1.4f * z);
  for (int k = 0; k < kTerms; ++k) logarithm += m_terms[k] * terms[k];
  return {std::exp(logarithm.x), std::exp(logarithm.y), std::exp(logarithm.z)};
}

Rgb sunRadiance(float turbidity, float sunZenith) {
  const float elevation = 90 - sunZenith / kDegree;
  if (!(elevation >= 0)) return {0, 0, 0};
  const float t = std::clamp(turbidity, 1.0f, 10.0f) / 10;
  // Kasten's air mass, as in Preetham, Shirley, Smits, "A Practical Analytic Model for Daylight", 1999.
  const float zenith = 90 - std::max(elevation, kLowestSun);
  const float airMass = 1 / (std::cos(zenith * kDegree) + 0.15f * std::pow(93.885f - zenith, -1.253f));
  const float m = airMass / 10, terms[4] = {1, std::sqrt(m), m, m * m};
  const float fade = std::min(1.0f, elevation / kLowestSun);
  Rgb radiance;
  for (int c = 0; c < 3; ++c) {
    float logarithm = 0;
    for (int k = 0; k < 4; ++k) logarithm += polynomial(kSun[c][k], t) * terms[k];
    radiance[c] = fade * std::exp(logarithm);
  }
  return radiance;
}

}  // namespace odis::render
