// Spectra turned into linear RGB (Rec. 709 primaries) by the CIE 1931 observer, as Mitsuba 3 does in its RGB
// variants.
#pragma once

#include <string>
#include <vector>

#include "render/math/vec.h"
#include "render/xml/error.h"

namespace odis::render {

struct SpectrumSample {
  double wavelength;  // nm
  double value;
};

// What reflects is lit by D65, whose colour is white but for 0.0012; what emits is seen as it is.
enum class SpectrumUse {
  reflectance,  // clamped to [0, 1]
  unbounded,    // the same, not bounded above: indices of refraction, absorption
  emission,     // radiance per nm; a flat spectrum of 1 has luminance 1
};

// Samples in rising order of wavelength, linear in between, zero outside. Negative channels become 0.
Rgb spectrumToRgb(const std::vector<SpectrumSample>& samples, SpectrumUse use);
// Of light of this radiance at all wavelengths, which is reddish beside the white of RGB images.
Rgb uniformEmission(double value);
// Planck's law in W / (m^2 sr nm).
Rgb blackbodyToRgb(double kelvin);
// "400:0.1, 500:0.2, ..."
std::vector<SpectrumSample> parseSpectrum(const std::string& text, const SourceLocation& at);
// A text file with a wavelength and a value a line; `#` begins a comment.
std::vector<SpectrumSample> readSpectrumFile(const std::string& path, const SourceLocation& at);
// Throws SceneError unless there are at least two samples whose wavelengths rise.
void checkSpectrum(const std::vector<SpectrumSample>& samples, const SourceLocation& at);

}  // namespace odis::render
