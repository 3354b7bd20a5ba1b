// The film and the reconstruction filter of scene files.
#pragma once

#include "render/scene/scene.h"
#include "render/xml/properties.h"

namespace odis::render {

// hdrfilm, ldrfilm and their like, with the size and crop of the command line in place of the file's. No
// node: all defaults. Throws SceneError for sizes that can't be drawn.
FilmSettings loadFilm(const Properties* node, const LoadOptions& options, Warnings& warnings);

}  // namespace odis::render
