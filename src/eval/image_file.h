// Reading and writing the colour image of an EXR file.
#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "render/image/write.h"
#include "render/integrators/render.h"

namespace odis::eval {

// An image that cannot be read, or not be used for what it was given for. what() says path and reason.
class ImageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct ColorImage {
  int width = 0, height = 0;
  std::vector<render::Rgb> pixels;
};

// All channels of an EXR, or of a PNG, JPEG, TGA, BMP or HDR file (by its name) as linear R, G and B. Throws
// ImageError.
render::ExrFile readChannels(const std::string& path);
// The colours of a layer; without a name those of findImageLayer (denoiser_layers.h). `path` is for the
// message. Throws ImageError.
ColorImage colorOf(const render::ExrFile& file, const std::string& path, const std::string& layer = "");
ColorImage readColor(const std::string& path, const std::string& layer = "");
// Writes the colour, and variance.R, G, B if the frame has a variance. Throws std::runtime_error with path
// and reason.
void writeColor(const std::string& path, const render::RenderedImage& frame, int fullWidth, int fullHeight,
                const std::map<std::string, std::string>& metadata);
void writeColor(const std::string& path, const ColorImage& image);

}  // namespace odis::eval
