#include "render/emitter/daylight.h"

namespace odis::render {

namespace {

Rgb fromXyz(double x, double y, double z) {
  return {float(std::max(0.0, 3.240479 * x - 1.537150 * y - 0.498535 * z)),
          float(std::max(0.0, -0.969256 * x + 1.875991 * y + 0.041556 * z)),
          float(std::max(0.0, 0.055648 * x - 0.204043 * y + 1.057311 * z))};
}

constexpr double kObserverIntegral = 106.857;  // of the CIE 1931 y curve over wavelength, nm

// Preetham's luminances are high (Zotti et al. 2007, "A Critical Review of the Preetham Skylight Model").
// These factors bring the horizontal illuminance of the sky to that of the model of Hošek and Wilkie (2012)
// over a ground of albedo 0.15. Rows are turbidities, columns elevations of the sun.
constexpr int kTurbidities = 7, kElevations = 9;
constexpr float kTurbidity[kTurbidities] = {2, 3, 4, 5, 6, 8, 10};
constexpr float kElevation[kElevations] = {1, 5, 10, 20, 30, 45, 60, 75, 89};  // degrees
constexpr float kCorrection[kTurbidities][kElevations] = {
    {0.213f, 0.358f, 0.439f, 0.500f, 0.526f, 0.557f, 0.600f, 0.649f, 0.607f},
    {0.355f, 0.570f, 0.645f, 0.642f, 0.608f, 0.564f, 0.541f, 0.529f, 0.472f},
    {0.438f, 0.695f, 0.751f, 0.703f, 0.639f, 0.565f, 0.520f, 0.488f, 0.427f},
    {0.514f, 0.789f, 0.816f, 0.733f, 0.655f, 0.573f, 0.516f, 0.474f, 0.427f},
    {0.596f, 0.849f, 0.838f, 0.725f, 0.642f, 0.558f, 0.498f, 0.447f, 0.398f},
    {0.772f, 0.952f, 0.884f, 0.753f, 0.689f, 0.630f, 0.563f, 0.487f, 0.399f},
    {1.027f, 0.933f, 0.865f, 0.786f, 0.777f, 0.814f, 0.799f, 0.661f, 0.476f},
};

// Where `value` lies in an ascending table: the entry below it and the fraction of the way to the next,
// clamped.
struct Bracket {
  int index;
  float fraction;
};
template <int n>
Bracket bracket(const float (&table)[n], float value) {
  const int above = int(std::upper_bound(table, table + n, value) - table);
  const int index = std::clamp(above - 1, 0, n - 2);
  return {index, std::clamp((value - table[index]) / (table[index + 1] - table[index]), 0.0f, 1.0f)};
}

float correction(float turbidity, float sunZenith) {
  const Bracket t = bracket(kTurbidity, turbidity), e = bracket(kElevation, 90 - sunZenith * (180 / kPi));
  const auto row = [&](int i) {
    return lerp(e.fraction, kCorrection[i][e.index], kCorrection[i][e.index + 1]);
  };
  return lerp(t.fraction, row(t.index), row(t.index + 1));
}

// The paper's chromaticity at the zenith: a polynomial in the sun's angle whose coefficients are quadratic in
// turbidity.
float zenithChromaticity(const float (&m)[3][4], float turbidity, float sunZenith) {
  const float t[3] = {turbidity * turbidity, turbidity, 1};
  float sum = 0;
  for (int i = 0; i < 3; ++i)
    sum += t[i] * (((m[i][0] * sunZenith + m[i][1]) * sunZenith + m[i][2]) * sunZenith + m[i][3]);
  return sum;
}
constexpr float kZenithX[3][4] = {{0.00166f, -0.00375f, 0.00209f, 0},
                                  {-0.02903f, 0.06377f, -0.03202f, 0.00394f},
                                  {0.11693f, -0.21196f, 0.06052f, 0.25886f}};
constexpr float kZenithY[3][4] = {{0.00275f, -0.00610f, 0.00317f, 0},
                                  {-0.04214f, 0.08970f, -0.04153f, 0.00516f},
                                  {0.15346f, -0.26756f, 0.06670f, 0.26688f}};

}  // namespace

Sky::Sky(float turbidity, float sunZenith) {
  const float t = std::clamp(turbidity, kTurbidity[0], kTurbidity[kTurbidities - 1]);
  const float zenith = std::clamp(sunZenith, 0.0f, kPi / 2);
  m_luminance = {0.1787f * t - 1.4630f, -0.3554f * t + 0.4275f, -0.0227f * t + 5.3251f, 0.1206f * t - 2.5771f,
                 -0.0670f * t + 0.3703f};
  m_x = {-0.0193f * t - 0.2592f, -0.0665f * t + 0.0008f, -0.0004f * t + 0.2125f, -0.0641f * t - 0.8989f,
         -0.0033f * t + 0.0452f};
  m_y = {-0.0167f * t - 0.2608f, -0.0950f * t + 0.0092f, -0.0079f * t + 0.2102f, -0.0441f * t - 1.6537f,
         -0.0109f * t + 0.0529f};

  const float chi = (4.0f / 9 - t / 120) * (kPi - 2 * zenith);
  const float kilocandela = (4.0453f * t - 4.9710f) * std::tan(chi) - 0.2155f * t + 2.4192f;  // per m^2
  constexpr float kLumenPerWatt = 683;
  const float luminance =
      1000 * kilocandela / (kLumenPerWatt * float(kObserverIntegral)) * correction(t, zenith);
  m_scaleLuminance = luminance / m_luminance(1, zenith);
  m_scaleX = zenithChromaticity(kZenithX, t, zenith) / m_x(1, zenith);
  m_scaleY = zenithChromaticity(kZenithY, t, zenith) / m_y(1, zenith);
}

Rgb Sky::radiance(float cosTheta, float gamma) const {
  if (!(cosTheta >= 0)) return {0, 0, 0};
  const float above = std::max(cosTheta, 1e-3f);  // the Perez function divides by it
  const double luminance = m_scaleLuminance * m_luminance(above, gamma);
  const double x = m_scaleX * m_x(above, gamma), y = m_scaleY * m_y(above, gamma);
  return fromXyz(luminance * x / y, luminance, luminance * (1 - x - y) / y);
}

namespace {

// Table 2 of the paper: the sun above the atmosphere in W/(m^2 sr nm), and absorption by ozone (1/cm) and by
// water vapour, from 380 nm in steps of 10. The gas absorption band at 760 nm is left out: the eye is all but
// blind there.
struct SolarSample {
  double radiance, ozone, water;
};
constexpr double kFirstWavelength = 380, kWavelengthStep = 10;
constexpr SolarSample kSolar[] = {
    {16559.0, 0, 0},         {16233.7, 0, 0},          {21127.5, 0, 0},       {25888.2, 0, 0},
    {25829.1, 0, 0},         {24232.3, 0, 0},          {26760.5, 0, 0},       {29658.3, 0.003, 0},
    {30545.4, 0.006, 0},     {30057.5, 0.009, 0},      {30663.7, 0.014, 0},   {28830.4, 0.021, 0},
    {28712.1, 0.030, 0},     {27825.0, 0.040, 0},      {27100.6, 0.048, 0},   {27233.6, 0.063, 0},
    {26361.3, 0.075, 0},     {25503.8, 0.085, 0},      {25060.2, 0.103, 0},   {25311.6, 0.120, 0},
    {25355.9, 0.120, 0},     {25134.2, 0.115, 0},      {24631.5, 0.125, 0},   {24173.2, 0.120, 0},
    {23685.3, 0.105, 0},     {23212.1, 0.090, 0},      {22827.7, 0.079, 0},   {22339.8, 0.067, 0},
    {21970.2, 0.057, 0},     {21526.7, 0.048, 0},      {21097.9, 0.036, 0},   {20728.3, 0.028, 0.016},
    {20240.4, 0.023, 0.024}, {19870.8, 0.018, 0.0125}, {19427.2, 0.014, 1.0}, {19072.4, 0.011, 0.87},
    {18628.9, 0.010, 0.061}, {18259.2, 0.009, 0.001},
};

// The CIE 1931 observer by the fits of Wyman, Sloan, Shirley 2013, "Simple Analytic Approximations to the CIE
// XYZ Color Matching Functions".
double lobe(double wavelength, double center, double below, double above) {
  const double t = (wavelength - center) / (wavelength < center ? below : above);
  return std::exp(-0.5 * t * t);
}
double observerX(double w) {
  return 1.056 * lobe(w, 599.8, 37.9, 31.0) + 0.362 * lobe(w, 442.0, 16.0, 26.7) -
         0.065 * lobe(w, 501.1, 20.4, 26.2);
}
double observerY(double w) {
  return 0.821 * lobe(w, 568.8, 46.9, 40.5) + 0.286 * lobe(w, 530.9, 16.3, 31.1);
}
double observerZ(double w) {
  return 1.217 * lobe(w, 437.0, 11.8, 36.0) + 0.681 * lobe(w, 459.0, 26.0, 13.8);
}

}  // namespace

Rgb sunRadiance(float turbidity, float sunZenith) {
  if (!(sunZenith <= kPi / 2)) return {0, 0, 0};
  const double degrees = sunZenith * 180 / M_PI;
  const double airMass = 1 / (std::cos(double(sunZenith)) + 0.15 * std::pow(93.885 - degrees, -1.253));
  // Ångström's coefficient for aerosol. The paper's 0.0461 T - 0.0459 dims the sun of hazy skies by up to a
  // half against the solar radiance of Hošek and Wilkie (2013); this fit stays within a tenth of it for
  // elevations above 20 degrees.
  const double beta = 0.014 * (turbidity + 1);
  constexpr double kOzone = 0.35, kWater = 2;  // cm in a column of air
  double x = 0, y = 0, z = 0, wavelength = kFirstWavelength;
  for (const SolarSample& s : kSolar) {
    const double micrometers = wavelength / 1000;
    const double water = s.water * kWater * airMass;
    const double depth = airMass * (0.008735 * std::pow(micrometers, -4.08)  // Rayleigh scattering
                                    + beta * std::pow(micrometers, -1.3)     // scattering by aerosol
                                    + kOzone * s.ozone) +
                         0.2385 * water / std::pow(1 + 20.07 * water, 0.45);
    const double radiance = s.radiance * std::exp(-depth) * kWavelengthStep / kObserverIntegral;
    x += radiance * observerX(wavelength);
    y += radiance * observerY(wavelength);
    z += radiance * observerZ(wavelength);
    wavelength += kWavelengthStep;
  }
  return fromXyz(x, y, z);
}

}  // namespace odis::render
