// Intel's Open Path Guiding Library as a rival (https://github.com/OpenPathGuidingLibrary/openpgl): a k-d
// tree over space with parallax-aware mixtures of von Mises-Fisher lobes (Ruppert, Herholz and Lensch 2020,
// "Robust Fitting of Parallax-Aware Mixtures for Path Guiding"), multiplied by the cosine at the vertex.
#pragma once

#include <memory>

#include "render/rivals/rival.h"

namespace odis::render {

// Whether this build has Open PGL.
bool hasOpenPgl();
// Throws OptionError if it has not.
std::unique_ptr<Rival> makeOpenPgl();

}  // namespace odis::render
