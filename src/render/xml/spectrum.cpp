#include "render/xml/spectrum.h"

#include <sstream>

#include "render/files/input_file.h"
#include "render/xml/cie_tables.h"
#include "render/xml/element.h"

namespace odis::render {
namespace {

// Mitsuba's constants: they give spectra that are 1 everywhere, and D65, the luminance 1.
constexpr double kMatchingIntegral = 106.7502593994140625, kD65Integral = 98.99741751876255;

// The entries of a table of even steps over the range of wavelengths that `position`, 0 to 1, lies between.
struct TablePosition {
  TablePosition(double position, size_t entries)
      : index(std::min(size_t(position * double(entries - 1)), entries - 2)),
        fraction(position * double(entries - 1) - double(index)) {}
  double between(double a, double b) const { return a + fraction * (b - a); }

  size_t index;
  double fraction;
};

Imath::V3d matching(double position) {
  const TablePosition at(position, std::size(kMatching));
  const double *a = kMatching[at.index], *b = kMatching[at.index + 1];
  return {at.between(a[0], b[0]), at.between(a[1], b[1]), at.between(a[2], b[2])};
}

double d65(double position) {
  const TablePosition at(position, std::size(kD65));
  return at.between(kD65[at.index], kD65[at.index + 1]) / kD65Integral;
}

// The integral of a function of the wavelength times the matching functions, and D65 if it lights; by the sum
// that Mitsuba makes, so that spectra of narrow bands get its colours, too.
template <class Function>
Imath::V3d integrate(Function&& value, bool lit) {
  constexpr int steps = 1000;
  Imath::V3d sum(0.0);
  for (int i = 0; i < steps; ++i) {
    const double position = double(i) / (steps - 1);
    const double wavelength = kMinWavelength + position * (kMaxWavelength - kMinWavelength);
    sum += matching(position) * value(wavelength) * (lit ? d65(position) : 1);
  }
  return sum * (kMaxWavelength - kMinWavelength) / (steps * kMatchingIntegral);
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
  const auto value = [&](double wavelength) { return interpolate(samples, wavelength); };
  return bounded(xyzToRgb(integrate(value, use != SpectrumUse::emission)),
                 use == SpectrumUse::reflectance ? 1 : std::numeric_limits<float>::max());
}

Rgb uniformEmission(double value) {
  return Rgb(bounded(xyzToRgb({1, 1, 1}), std::numeric_limits<float>::max()) * float(value));
}

Rgb blackbodyToRgb(double kelvin) {
  constexpr double h = 6.62607015e-34, c = 299792458, k = 1.380649e-23;
  const auto planck = [&](double nanometres) {
    const double w = nanometres * 1e-9;
    return 2 * h * c * c / (std::pow(w, 5) * std::expm1(h * c / (w * k * kelvin))) * 1e-9;
  };
  return bounded(xyzToRgb(integrate(planck, false)), std::numeric_limits<float>::max());
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
