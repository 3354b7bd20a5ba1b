// What can be chosen about resampling; docs/rivals.md.
#pragma once

namespace odis::render {

struct RestirOptions {
  int neighbours = 4;  // pixels whose sample is tried as well
  float radius = 16;   // how far away they are at most, in pixels
};

}  // namespace odis::render
