// False colours for numbers.
#pragma once

#include "render/math/vec.h"

namespace odis::render {

// From black at 0 over violet and orange to pale yellow at 1; linear.
Rgb magma(double share);

}  // namespace odis::render
