// Numbers of an inspection as JSON.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

#include "learn/inspect/inspect.h"

namespace odis::learn {

// JSON has no infinity and no such thing as not a number.
inline nlohmann::ordered_json jsonNumber(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}
inline nlohmann::ordered_json jsonVector(const Float3& v) {
  return {jsonNumber(v.x), jsonNumber(v.y), jsonNumber(v.z)};
}
inline nlohmann::ordered_json jsonMap(const SquareMap& map) {
  nlohmann::ordered_json values = nlohmann::ordered_json::array();
  for (const float value : map.values) values.push_back(jsonNumber(value));
  return {{"side", map.side}, {"values", values}};
}

}  // namespace odis::learn
