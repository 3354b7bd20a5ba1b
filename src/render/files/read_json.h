// JSON that may be damaged or hostile.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <string_view>

#include "render/files/input_file.h"

namespace odis::render {

// How deep arrays and objects of a text are nested, brackets in strings not counted.
int jsonDepth(std::string_view text);

// What nlohmann::json says without the number of its exception.
std::string jsonReason(const std::exception& error);

// Throws ReadError if it is no JSON, or nested so deep that printing it would overflow the stack.
template <class Json>
Json parseJson(std::string_view text) {
  constexpr int kMaxDepth = 100;
  if (jsonDepth(text) > kMaxDepth)
    throw ReadError("its JSON is nested more than " + std::to_string(kMaxDepth) + " deep");
  try {
    return Json::parse(text);
  } catch (const typename Json::exception& error) {
    throw ReadError("it is not JSON: " + jsonReason(error));
  }
}

// What parseJson makes of a file. Throws ReadError.
template <class Json>
Json readJson(const std::string& path) {
  return parseJson<Json>(readFile(path));
}

// The whole number, zero or more, that a value must hold: nlohmann's own conversions cast a fraction
// or a negative number to whatever type is asked for. Throws Json::type_error.
template <class Json>
uint64_t wholeNumber(const Json& json) {
  if (!json.is_number_unsigned() && !(json.is_number_integer() && json >= 0))
    throw Json::type_error::create(302, "expected a whole number, found " + json.dump(), &json);
  return json.template get<uint64_t>();
}

}  // namespace odis::render
