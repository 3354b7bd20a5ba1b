// The pictures of a comparison as the report embeds them.
#pragma once

#include <string>

#include "eval/image_file.h"

namespace odis::eval {

// A byte of a picture is 255 log(1 + scale x) / log(1 + scale most), x in units of the screen's white at the
// exposure of the reference: 14 stops, coarser steps where it is brighter, as the eye has them. The page
// decodes it (src/eval/report/picture.js).
inline constexpr double kPictureScale = 64, kPictureMost = 256;

// PNG files in base64: the image, red, green and blue; values in [0, 1] as grey.
std::string encodePicture(const ColorImage& image, double exposure);
std::string encodeMap(const std::vector<float>& values, int width, int height);

std::string base64(const std::string& bytes);

}  // namespace odis::eval
