// Pictures side by side, for a look.
#pragma once

#include <string>
#include <vector>

#include "eval/image_file.h"

namespace odis::eval {

// Copies the images next to each other, left to right, a gap of a few black pixels between them; top edges
// aligned.
ColorImage montage(const std::vector<ColorImage>& images);

}  // namespace odis::eval
