// Parts of an inspection of a saved file.
#pragma once

#include <fmt/format.h>

#include "learn/inspect/saved.h"
#include "odis/saved_frame.h"

namespace odis::learn {

// Numbers that are none are left out.
Quantiles quantilesOf(std::vector<float> values);

inline void extend(Bounds& box, const Float3& point) {
  box.low = {std::min(box.low.x, point.x), std::min(box.low.y, point.y), std::min(box.low.z, point.z)};
  box.high = {std::max(box.high.x, point.x), std::max(box.high.y, point.y), std::max(box.high.z, point.z)};
}

template <class T>
void noteOption(std::vector<ChosenOption>& options, const std::string& name, const T& value, const T& usual) {
  if (value != usual) options.push_back({name, fmt::format("{}", value)});
}
// Notes what of a guide's options is not set by name, and not the default.
void noteGuideOptions(std::vector<ChosenOption>& chosen, const core::GuideOptions& given);
// Notes the settings of a text that are not the defaults.
void noteSettings(std::vector<ChosenOption>& chosen, const std::string& settings);
// A model in words, by its number.
std::string modelText(uint64_t id);

GuideSummary summarizeGuide(core::Guide guide);
VertexSummary summarizeVertices(VertexParts parts);
// Of a saved builder, or of the one in a saved frame.
BuilderSummary summarizeBuilder(const core::Archive& file);
// `file` is the one that `saved` comes from.
FrameSummary summarizeFrame(const core::SavedFrame& saved, const core::Archive& file);

}  // namespace odis::learn
