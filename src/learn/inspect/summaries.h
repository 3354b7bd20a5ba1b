// Parts of an inspection of a saved file.
#pragma once

#include "learn/inspect/saved.h"
#include "odis/saved_frame.h"

namespace odis::learn {

// Numbers that are none are left out.
Quantiles quantilesOf(std::vector<float> values);

inline void extend(Bounds& box, const Float3& point) {
  box.low = {std::min(box.low.x, point.x), std::min(box.low.y, point.y), std::min(box.low.z, point.z)};
  box.high = {std::max(box.high.x, point.x), std::max(box.high.y, point.y), std::max(box.high.z, point.z)};
}

GuideSummary summarizeGuide(core::Guide guide);
VertexSummary summarizeVertices(VertexParts parts);
// `file` is the one that `saved` comes from.
FrameSummary summarizeFrame(const core::SavedFrame& saved, const core::Archive& file);

}  // namespace odis::learn
