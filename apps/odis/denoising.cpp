#include "denoising.h"

#include <fmt/format.h>

#include <new>

#include "console.h"
#include "render/integrators/job.h"

namespace odis::app {

using namespace render;

std::optional<std::vector<Rgb>> denoiseColors(const Denoiser& denoiser, const DenoiserInput& input,
                                              Auxiliaries auxiliaries, Progress& progress,
                                              Denoising& denoising) {
  const Stopwatch watch;
  std::optional<std::vector<Rgb>> colors;
  try {
    colors = denoiser.denoise(input, auxiliaries, progress);
  } catch (const std::bad_alloc&) {
    throw DenoiserError(denoiser.name() + ": not enough memory");
  }
  if (!colors) {
    say("interrupted while denoising: the image stays as it was rendered\n");
    return {};
  }
  denoising.denoiser = denoiser.name();
  denoising.auxiliaries = auxiliariesText(input, auxiliaries);
  denoising.seconds = watch.seconds();
  return colors;
}

std::map<std::string, std::string> denoisingMetadata(const Denoising& denoising) {
  if (denoising.denoiser.empty()) return {};
  std::map<std::string, std::string> metadata{
      {"odis:denoiser", denoising.denoiser},
      {"odis:denoiserAuxiliaries", denoising.auxiliaries},
      {"odis:secondsDenoise", fmt::format("{:.4f}", denoising.seconds)}};
  if (denoising.secondsAuxiliaries > 0)
    metadata["odis:secondsAuxiliaries"] = fmt::format("{:.4f}", denoising.secondsAuxiliaries);
  return metadata;
}

}  // namespace odis::app
