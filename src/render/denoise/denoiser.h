// Denoising a rendered image with Open Image Denoise and what the renderer knows of the scene beside colour.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/denoise/oidn_library.h"
#include "render/math/vec.h"
#include "render/path/progress.h"

namespace odis::render {

// What becomes of albedo and normals before they steer the denoising of the colours.
enum class Auxiliaries {
  clean,        // taken as images without noise
  prefiltered,  // each is denoised by itself, so that its noise does not end up in the image
  noisy,        // taken as images with as much noise as the colours have
  none          // colours alone
};

// Images of one size, row 0 at the top. Albedo and normals are those of features.h; either may be empty, but
// there are no normals without an albedo.
struct DenoiserInput {
  int width = 0, height = 0;
  std::span<const Rgb> color;    // linear, in any unit
  std::span<const Rgb> albedo;   // in [0, 1]
  std::span<const Vec3> normal;  // in world space or the camera's, of any length up to 1
};

// The denoiser may use about this much memory beside the images; it works in tiles where an image needs more.
inline constexpr int kDenoiserMegabytes = 1024;

class Denoiser {
 public:
  // Works on this many threads of the processor; 0: one a core. Throws DenoiserError if there is no library.
  explicit Denoiser(int threads);
  ~Denoiser();
  Denoiser(const Denoiser&) = delete;
  Denoiser& operator=(const Denoiser&) = delete;

  // "Open Image Denoise 2.5.1".
  const std::string& name() const { return m_name; }

  // The denoised colours; nothing if progress was cancelled. Colours that are not finite count as black,
  // negative ones as 0, others as ColorRange says; what of the auxiliaries is out of range is clamped. The
  // same input gives the same bits for any number of threads. Throws DenoiserError.
  std::optional<std::vector<Rgb>> denoise(const DenoiserInput& input, Auxiliaries auxiliaries,
                                          Progress& progress) const;

 private:
  [[noreturn]] void fail(const char* message) const;

  const OidnLibrary& m_oidn;
  OidnDevice* m_device;
  std::string m_name;
};

// "albedo and normal, clean", "albedo", "none", …: what `denoise` uses of this input.
std::string auxiliariesText(const DenoiserInput& input, Auxiliaries auxiliaries);

}  // namespace odis::render
