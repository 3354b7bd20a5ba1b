// Whether the boundaries of media are closed.
#pragma once

#include <vector>

#include "render/shape/shape.h"
#include "render/xml/error.h"

namespace odis::render {

class Boundaries {
 public:
  // A shape that bounds a medium, with its motion (null: it stands still), of which what is when the shutter
  // opens counts. Shapes of the same `frame`, a space, may close each other's openings: a cylinder and the
  // disks at its ends.
  void add(const Shape& shape, const Motion* motion, const SourceLocation& at, const void* frame);
  // Tells of those that are left open. Cost: linear in the number of triangles.
  void warn(Warnings& warnings) const;

 private:
  struct Opening {
    Vec3 p;
    size_t shape;
  };
  struct Frame {
    const void* key;
    std::vector<SourceLocation> shapes;
    std::vector<Opening> openings;
  };
  static void warn(const Frame& frame, Warnings& warnings);

  std::vector<Frame> m_frames;
};

}  // namespace odis::render
