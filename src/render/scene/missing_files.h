// Which files of a scene are not there.
#pragma once

#include <vector>

#include "render/xml/xml.h"

namespace odis::render {

// Each missing file once, in the order of the scene: what <include>, <path> and <spectrum> name, and what all
// elements do that can be reached from what is drawn. Some of these may turn out not to be drawn.
std::vector<SceneError> missingFiles(const ParsedScene& scene, const Warnings& order);

}  // namespace odis::render
