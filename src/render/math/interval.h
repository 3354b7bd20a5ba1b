// The numbers that something may be: a parameter of a scene, an option, a setting, a key of a training. Each
// is declared once, where the number is read; errors, help and the manual show its text.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>

namespace odis::render {

template <class Number>
struct Interval {
  Number least, most;
  bool withLeast = true, withMost = true;  // whether the ends are part of it
  std::optional<Number> also = {};         // a number beside it that has a meaning of its own

  // NaN is in no interval.
  bool contains(Number x) const {
    if (also && x == *also) return true;
    return (withLeast ? x >= least : x > least) && (withMost ? x <= most : x < most);
  }
  // "0 to 1", "more than 0 and at most 1", "-1 or 0.01 to 100"; "any" if both ends are those of a
  // floating-point type.
  std::string text() const {
    constexpr bool real = std::is_floating_point_v<Number>;
    const bool below = real && least <= std::numeric_limits<Number>::lowest(),
               above = real && most >= std::numeric_limits<Number>::max();
    if (below && above) return "any";
    const std::string beside = also ? shown(*also) + " or " : "";
    if (withLeast && withMost && !above) return beside + shown(least) + " to " + shown(most);
    const std::string from = withLeast ? shown(least) + " or more" : "more than " + shown(least);
    if (above) return beside + from;
    return beside + from + (withMost ? " and at most " : " and less than ") + shown(most);
  }

 private:
  // Long rows of zeros can't be read.
  static std::string shown(Number x) {
    if constexpr (std::is_floating_point_v<Number>)
      if (std::abs(x) >= Number(1e10)) return fmt::format("{:g}", x);
    return fmt::format("{}", x);
  }
};

// What the parameters of scenes are declared with.
using NumberRange = Interval<double>;
inline constexpr NumberRange kAnyNumber{std::numeric_limits<double>::lowest(),
                                        std::numeric_limits<double>::max()};

constexpr NumberRange between(double least, double most) {
  return {least, most};
}

}  // namespace odis::render
