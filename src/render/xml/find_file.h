// Files that a scene names, and where they are looked for.
#pragma once

#include <string>
#include <vector>

#include "render/xml/error.h"

namespace odis::render {

enum class Wanted { file, folder };

// The first of `name` in the folder of the file that `at` names, then in `folders`; a name with backslashes,
// as Windows writes them, may have slashes. Throws MissingFiles, which says where it was looked for.
std::string findFile(const std::string& name, const std::vector<std::string>& folders,
                     const SourceLocation& at, Wanted wanted = Wanted::file);

}  // namespace odis::render
