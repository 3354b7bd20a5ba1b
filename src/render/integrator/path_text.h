// A path in words, for those who replay one.
#pragma once

#include <span>
#include <string>

#include "render/integrator/path.h"

namespace odis::render {

// What the path brought, and a line for each of its vertices.
std::string pathText(const Path& path, std::span<const PilotVertex> vertices);

}  // namespace odis::render
