// Spectra turned into linear RGB (Rec. 709 primaries). The colour matching functions are the analytic fit of
// Wyman, Sloan and Shirley 2013, "Simple Analytic Approximations to the CIE XYZ Color Matching Functions".
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

// As Mitsuba 3 does in its RGB modes: what reflects is lit by D65, and white is (1, 1, 1); what emits is seen
// as it is.
enum class SpectrumUse {
  reflectance,  // clamped to [0, 1]
  index,        // of refraction: not bounded above
  emission,     // radiance per nm; a flat spectrum of 1 has luminance 1
};

// Samples in rising order of wavelength, linear in between, zero outside. Negative channels become 0.
Rgb spectrumToRgb(const std::vector<SpectrumSample>& samples, SpectrumUse use);
// Planck's law in W / (m^2 sr nm).
Rgb blackbodyToRgb(double kelvin);
// "400:0.1, 500:0.2, ..."
std::vector<SpectrumSample> parseSpectrum(const std::string& text, const SourceLocation& at);
// A text file with a wavelength and a value a line; `#` begins a comment.
std::vector<SpectrumSample> readSpectrumFile(const std::string& path, const SourceLocation& at);
// Throws SceneError unless there are at least two samples whose wavelengths rise.
void checkSpectrum(const std::vector<SpectrumSample>& samples, const SourceLocation& at);

}  // namespace odis::render
