// Denoising for `odis render` and `odis denoise`.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "render/denoise/denoiser.h"

namespace odis::app {

// How an image was denoised, if it was.
struct Denoising {
  std::string denoiser;     // with its version
  std::string auxiliaries;  // "albedo and normal, clean"
  double seconds = 0;
  double secondsAuxiliaries = 0;  // what it took to render albedo and normal; 0 where a file had them
};

// Denoised colours; nothing, and words about it, where Ctrl-C came first. Throws DenoiserError, also where
// there is not enough memory.
std::optional<std::vector<render::Rgb>> denoiseColors(const render::Denoiser& denoiser,
                                                      const render::DenoiserInput& input,
                                                      render::Auxiliaries auxiliaries,
                                                      render::Progress& progress, Denoising& denoising);

// For the header of an EXR file: odis:denoiser, odis:denoiserAuxiliaries, odis:secondsDenoise,
// odis:secondsAuxiliaries (where they were rendered).
std::map<std::string, std::string> denoisingMetadata(const Denoising& denoising);

}  // namespace odis::app
