// What a camera's ray sees of media before it meets a surface, in the mean over all places where it may be
// scattered: a denoiser takes noise of its features for what is there.
#pragma once

#include "render/path/path.h"

namespace odis::render {

class Veil {
 public:
  // Adds what the path's medium scatters on its ray, so long until it meets a surface.
  void add(const Path& path, int place, float length);
  // Covers the path's features.
  void cover(Path& path) const;

 private:
  Rgb m_albedo{0, 0, 0}, m_passing{1, 1, 1};
};

}  // namespace odis::render
