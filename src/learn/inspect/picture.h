// A place looked into, as a picture and as numbers.
#pragma once

#include <nlohmann/json.hpp>

#include "learn/inspect/inspect.h"
#include "learn/inspect/map_drawing.h"

namespace odis::learn {

// Everything side by side. The canvas is linear, to be written without a tone curve.
Canvas drawInspection(const Inspection& inspection, const std::string& title, MapColors colors);

// Tables for people.
std::string inspectionText(const Inspection& inspection, const std::string& title);
// The same and all maps for programs; what is not known is null.
nlohmann::ordered_json toJson(const Inspection& inspection);

}  // namespace odis::learn
