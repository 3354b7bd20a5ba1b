// From a description to a folder of files.
#pragma once

#include <string>

#include "learn/scenes/description.h"

namespace odis::learn {

// Writes meshes, textures and content.xml: everything but the cameras; `again`: only content.xml, since
// nothing but the exposure has changed. Throws WriteError, std::filesystem::filesystem_error.
void writeContent(const Description& scene, const std::string& folder, bool again = false);
// Writes scene.xml for the first view, scene-b.xml for the second: a camera each and an include of
// content.xml.
void writeViews(const Description& scene, const std::string& folder);

// The view in the world of the files.
View inWorld(const Description& scene, const View& view);

// Writes a whole file; throws WriteError.
void writeFile(const std::string& path, const std::string& bytes);

}  // namespace odis::learn
