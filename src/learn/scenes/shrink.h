// Images of the user's made small enough to be a part of many scenes.
#pragma once

#include <string>
#include <vector>

#include "render/math/vec.h"

namespace odis::learn {

// The bytes of a PNG of at most 320 pixels either side. Throws SceneError if the file can't be read.
std::string shrunkTexture(const std::string& path);
// Whether its mean has a channel that reflects much and one that reflects less than a tenth of that. Throws
// as above.
bool isVividTexture(const std::string& path);
// The bytes of a HDR file of at most 512 x 256 pixels, averages over whole pixels.
std::string shrunkEnvironment(const std::string& path);

// A Radiance HDR file in memory. Throws std::runtime_error.
std::string encodeHdr(int width, int height, const std::vector<render::Rgb>& pixels);

}  // namespace odis::learn
