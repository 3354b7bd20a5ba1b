// Scenes at a size to measure at.
#pragma once

#include <memory>
#include <string>

#include "render/scene/scene.h"

namespace odis::eval {

// Loads the scene so that it has about `pixels` pixels at its own aspect ratio; 0: as the file or `options` has
// it. Throws SceneError.
std::unique_ptr<render::Scene> loadScene(const std::string& path, render::LoadOptions options, int pixels,
                                         render::Warnings& warnings);

}  // namespace odis::eval
