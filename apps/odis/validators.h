// What the value of an option must be.
#pragma once

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <limits>

#include "numbers.h"

namespace odis::app {

// What options may be that several commands have.
inline constexpr render::Interval<int> kSamplesPerPixel{1, 1 << 24};
inline constexpr render::Interval<int> kPixelCount{1, 1 << 24};
inline constexpr render::Interval<int> kMaxDepth{-1, 1 << 20};  // -1: no limit
inline constexpr render::Interval<int> kRouletteDepth{1, 1 << 20};
inline constexpr render::Interval<int> kThreadCount{0, 4096};  // 0: one a core
inline constexpr render::Interval<uint64_t> kSeed{0, std::numeric_limits<uint64_t>::max()};
inline constexpr render::Interval<float> kStops{-100, 100};  // of exposure

// A number of the range, as help and errors show it. The range has the type of the option's variable.
template <class Number>
CLI::Validator within(const render::Interval<Number>& range) {
  return CLI::Validator(
      [range](std::string& text) {
        const std::optional<Number> value = parseNumber<Number>(text);
        if (!value || !range.contains(*value))
          return fmt::format("found {}, expected {}", text, expectedNumber(range));
        // CLI11 would read 010 as 8.
        text = fmt::format("{}", *value);
        return std::string();
      },
      range.text());
}

template <class Number>
CLI::Validator within(Number least, Number most) {
  return within(render::Interval<Number>{least, most});
}

}  // namespace odis::app
