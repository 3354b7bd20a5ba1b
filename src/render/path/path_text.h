// A path in words, for those who replay one.
#pragma once

#include <span>
#include <string>

#include "render/path/path.h"

namespace odis::render {

// What the path brought, and a line for each of its vertices.
std::string pathText(const Path& path, std::span<const PathVertex> vertices);

}  // namespace odis::render
