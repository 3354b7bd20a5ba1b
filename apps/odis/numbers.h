// Numbers in the arguments of the command line.
#pragma once

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "render/math/interval.h"

namespace odis::app {

// The decimal number that is the whole text; nothing if it is none or doesn't fit the type.
template <class Number>
std::optional<Number> parseNumber(const std::string& text) {
  const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + (plus ? 1 : 0), end, value);
  if (error != std::errc() || stop != end) return {};
  return value;
}

// The numbers of a text like "0,0,64,64" that lie in the range; nothing if there are not `count` of them.
template <class Number>
std::optional<std::vector<Number>> parseNumbers(const std::string& text, char separator, size_t count,
                                                const render::Interval<Number>& range) {
  std::vector<Number> numbers;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(separator, begin), text.size());
    const std::optional<Number> number = parseNumber<Number>(text.substr(begin, end - begin));
    if (!number || !range.contains(*number)) return {};
    numbers.push_back(*number);
    begin = end + 1;
  }
  if (numbers.size() != count) return {};
  return numbers;
}

// "a whole number from 1 to 65536".
template <class Number>
std::string expectedNumber(const render::Interval<Number>& range) {
  return (std::is_integral_v<Number> ? "a whole number from " : "a number from ") + range.text();
}

}  // namespace odis::app
