#include "render/sensor/clip.h"

namespace odis::render {

ClipRange readClipRange(const Properties& node) {
  const ClipRange range{node.number("near_clip", kSensorDistances, 0.01f),
                        node.number("far_clip", kSensorDistances, 1e4f)};
  if (!(range.nearest < range.farthest))
    throw SceneError(
        node.placeOf(node.has("near_clip") ? "near_clip" : "far_clip"),
        fmt::format("found a near_clip of {} and a far_clip of {}, expected the first to be less",
                    range.nearest, range.farthest));
  return range;
}

}  // namespace odis::render
