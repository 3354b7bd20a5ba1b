// What a scene holds, for people.
#pragma once

#include <string>

#include "render/scene/scene.h"

namespace odis::render {

// A few lines of text; last what differs from what the scene describes, and what doesn't for all that it
// says.
std::string describe(const Scene& scene, const Warnings& warnings);

}  // namespace odis::render
