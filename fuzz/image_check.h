// What must hold of every image that a file becomes.
#pragma once

#include <cstdlib>

#include "memory_file.h"
#include "render/image/image.h"

namespace odis::fuzz {

// Reads the file and looks at its corners, as a texture and as its parts.
inline void checkImage(const MemoryFile& file) {
  using render::Image;
  try {
    const auto image = Image::read(file.path(), true, {});
    const int right = image->width() - 1, bottom = image->height() - 1;
    for (const auto& part : {image, image->withGamma(1.8f), image->channel('g'), image->channel('a')}) {
      volatile float sum = part->rgb(0, 0).x + part->scalar(right, 0) + part->alpha(right, bottom);
      sum = sum + part->rgb(right, bottom).z + part->mean().x;
    }
  } catch (const render::SceneError&) {
  }
}

}  // namespace odis::fuzz
