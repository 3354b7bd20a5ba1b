#include "render/xml/spectrum.h"

#include <sstream>

#include "render/files/input_file.h"
#include "render/xml/element.h"

namespace odis::render {
namespace {

constexpr double kMinWavelength = 360, kMaxWavelength = 830;

// CIE standard illuminant D65, every 10 nm from 360 nm.
constexpr double kD65[] = {46.6383, 52.0891, 49.9755, 54.6482, 82.7549, 91.4860, 93.4318, 86.6823,
                           104.865, 117.008, 117.812, 114.861, 115.923, 108.811, 109.354, 107.802,
                           104.790, 107.689, 104.405, 104.046, 100.000, 96.3342, 95.7880, 88.6856,
                           90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778,
                           78.2842, 69.7213, 71.6091, 74.3490, 61.6040, 69.8856, 75.0870, 63.5927,
                           46.4182, 66.8054, 63.3828, 64.3040, 59.4519, 51.9590, 57.4406, 60.3125};

double d65(double wavelength) {
  const double x = (wavelength - kMinWavelength) / 10;
  const int i = std::clamp(int(x), 0, int(std::size(kD65)) - 2);
  return kD65[i] + (x - i) * (kD65[i + 1] - kD65[i]);
}

double lobe(double wavelength, double center, double below, double above) {
  const double x = (wavelength - center) / (wavelength < center ? below : above);
  return std::exp(-0.5 * x * x);
}

Imath::V3d matching(double w) {
  return {1.056 * lobe(w, 599.8, 37.9, 31.0) + 0.362 * lobe(w, 442.0, 16.0, 26.7) -
              0.065 * lobe(w, 501.1, 20.4, 26.2),
          0.821 * lobe(w, 568.8, 46.9, 40.5) + 0.286 * lobe(w, 530.9, 16.3, 31.1),
          1.217 * lobe(w, 437.0, 11.8, 36.0) + 0.681 * lobe(w, 459.0, 26.0, 13.8)};
}

// The integral of value * matching functions over the visible range, midpoint rule.
template <class Function>
Imath::V3d integrate(Function&& value) {
  constexpr int steps = 940;
  const double step = (kMaxWavelength - kMinWavelength) / steps;
  Imath::V3d sum(0.0);
  for (int i = 0; i < steps; ++i) {
    const double wavelength = kMinWavelength + (i + 0.5) * step;
    sum += matching(wavelength) * value(wavelength) * step;
  }
  return sum;
}

Imath::V3d xyzToRgb(const Imath::V3d& c) {
  return {3.240479 * c.x - 1.537150 * c.y - 0.498535 * c.z, -0.969256 * c.x + 1.875991 * c.y + 0.041556 * c.z,
          0.055648 * c.x - 0.204043 * c.y + 1.057311 * c.z};
}

double interpolate(const std::vector<SpectrumSample>& samples, double wavelength) {
  if (wavelength < samples.front().wavelength || wavelength > samples.back().wavelength) return 0;
  const auto next = std::lower_bound(samples.begin() + 1, samples.end() - 1, wavelength,
                                     [](const SpectrumSample& s, double w) { return s.wavelength < w; });
  const SpectrumSample &a = *(next - 1), &b = *next;
  return a.value + (wavelength - a.wavelength) / (b.wavelength - a.wavelength) * (b.value - a.value);
}

Rgb bounded(const Imath::V3d& color, double maximum) {
  const auto clip = [&](double x) { return float(std::clamp(x, 0.0, maximum)); };
  return {clip(color.x), clip(color.y), clip(color.z)};
}

}  // namespace

Rgb spectrumToRgb(const std::vector<SpectrumSample>& samples, SpectrumUse use) {
  constexpr double most = std::numeric_limits<float>::max();
  if (use == SpectrumUse::emission) {
    const double norm = integrate([](double) { return 1.0; }).y;
    return bounded(xyzToRgb(integrate([&](double w) { return interpolate(samples, w); }) / norm), most);
  }
  // Divided by the colour of perfect white, so that the small errors of the fit don't tint a grey.
  const Imath::V3d white = xyzToRgb(integrate(d65));
  const Imath::V3d color = xyzToRgb(integrate([&](double w) { return d65(w) * interpolate(samples, w); }));
  return bounded({color.x / white.x, color.y / white.y, color.z / white.z},
                 use == SpectrumUse::reflectance ? 1 : most);
}

Rgb blackbodyToRgb(double kelvin) {
  constexpr double h = 6.62607015e-34, c = 299792458, k = 1.380649e-23;
  const double norm = integrate([](double) { return 1.0; }).y;
  const auto planck = [&](double nanometres) {
    const double w = nanometres * 1e-9;
    return 2 * h * c * c / (std::pow(w, 5) * std::expm1(h * c / (w * k * kelvin))) * 1e-9;
  };
  return bounded(xyzToRgb(integrate(planck) / norm), std::numeric_limits<float>::max());
}

std::vector<SpectrumSample> parseSpectrum(const std::string& text, const SourceLocation& at) {
  constexpr const char* separators = ", \t\r\n";
  std::vector<SpectrumSample> samples;
  for (size_t i = text.find_first_not_of(separators); i != std::string::npos;) {
    const size_t end = std::min(text.find_first_of(separators, i), text.size());
    const std::string pair = text.substr(i, end - i);
    const size_t colon = pair.find(':');
    if (colon == std::string::npos)
      throw SceneError(at, "found '" + pair + "' in a spectrum, expected wavelength:value pairs");
    samples.push_back({parseNumber(pair.substr(0, colon), "a wavelength", at),
                       parseNumber(pair.substr(colon + 1), "the value of a spectrum", at)});
    i = text.find_first_not_of(separators, end);
  }
  checkSpectrum(samples, at);
  return samples;
}

std::vector<SpectrumSample> readSpectrumFile(const std::string& path, const SourceLocation& at) {
  std::istringstream stream;
  try {
    stream.str(readFile(path));
  } catch (const ReadError& error) {
    throw SceneError(at, "cannot read the spectrum file '" + path + "': " + error.what());
  }
  std::vector<SpectrumSample> samples;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    const SourceLocation here{path, number, 1};
    const std::vector<double> v = parseNumbers(line.substr(0, line.find('#')), "a line of a spectrum", here);
    if (v.empty()) continue;
    if (v.size() != 2)
      throw SceneError(here,
                       "found " + std::to_string(v.size()) + " numbers, expected a wavelength and a value");
    samples.push_back({v[0], v[1]});
  }
  checkSpectrum(samples, {path, 1, 1});
  return samples;
}

void checkSpectrum(const std::vector<SpectrumSample>& samples, const SourceLocation& at) {
  if (samples.size() < 2)
    throw SceneError(
        at, "found a spectrum of " + std::to_string(samples.size()) + " samples, expected at least 2");
  for (size_t i = 1; i < samples.size(); ++i)
    if (!(samples[i].wavelength > samples[i - 1].wavelength))
      throw SceneError(at, "found wavelengths that don't rise, expected each larger than the one before");
}

}  // namespace odis::render
