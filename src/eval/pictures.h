// PNGs of a comparison's images, for a look without a program that reads EXR.
#pragma once

#include <string>
#include <vector>

#include "eval/compare.h"
#include "eval/summary.h"

namespace odis::eval {

// Writes a PNG next to each image of seed 0 in `folder`, and for each scene and number of samples
// images/SCENE-SPP.png, and images/SCENE-SPP-denoised.png: the methods in their order and the reference, side
// by side. Exposure in stops. Throws
// ImageError, WriteError.
void writePictures(const Comparison& comparison, const std::vector<ComparisonRow>& rows,
                   const std::string& folder, float exposure);

}  // namespace odis::eval
