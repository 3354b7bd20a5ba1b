// JSON that may be damaged or hostile.
#pragma once

#include <nlohmann/json.hpp>

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

}  // namespace odis::render
