// What was found in a saved file, as text, numbers and pictures.
#pragma once

#include <nlohmann/json.hpp>

#include "learn/inspect/map_drawing.h"
#include "learn/inspect/saved.h"

namespace odis::learn {

// Tables for people.
std::string savedText(const SavedInspection& inspection, const std::string& title);
// The same for programs, and the map of the cell; what is not known or infinite is null.
nlohmann::ordered_json toJson(const SavedInspection& inspection);

// The map of one cell; those of up to 64 cells of the finest level, taken evenly from all. Linear, to be
// written without a tone curve.
Canvas drawCell(const CellSummary& cell, const std::string& title, MapColors colors);
Canvas drawGuide(const GuideSummary& guide, const std::string& title, MapColors colors);

}  // namespace odis::learn
