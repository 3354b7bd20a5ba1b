// A lamp behind a screen in dense, chromatic fog of which a box is full: most light comes by the fog.
#pragma once

#include <string>

#include "integrator/test_scenes.h"

namespace odis::test {

struct FoggyRoom {
  static std::string text() {
    std::string room = indirectRoom(16);
    const std::string fog =
        "<medium type=\"homogeneous\" id=\"fog\"><rgb name=\"sigma_t\" value=\"0.5, 0.4, 0.3\"/>"
        "<rgb name=\"albedo\" value=\"0.9\"/><phase type=\"hg\"><float name=\"g\" "
        "value=\"0.5\"/></phase></medium>";
    room.insert(room.find("</sensor>"), "<ref id=\"fog\"/>");
    return fog + room;
  }
  static constexpr int kMaxDepth = 6;
};

}  // namespace odis::test
