// What a scene holds, for people.
#pragma once

#include <string>

#include "render/scene/scene.h"

namespace odis::render {

// A few lines of text, the warnings last.
std::string describe(const Scene& scene, const Warnings& warnings);

}  // namespace odis::render
