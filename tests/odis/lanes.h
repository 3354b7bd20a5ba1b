// A number type of four lanes, as a renderer that works on several paths together would have one: what
// odis/number.h asks of it.
#pragma once

#include <odis/number.h>

#include <array>

namespace odis::test {

inline constexpr int kLaneCount = 4;

template <class Value>
struct Lanes {
  Value lane[kLaneCount] = {};
  Lanes() = default;
  explicit Lanes(Value value) {
    for (Value& v : lane) v = value;
  }
  // Applies a function to the lanes of two numbers.
  template <class Result = Value, class Function>
  static Lanes<Result> map(const Lanes& a, const Lanes& b, const Function& f) {
    Lanes<Result> result;
    for (int i = 0; i < kLaneCount; ++i) result.lane[i] = f(a.lane[i], b.lane[i]);
    return result;
  }

#define ODIS_TEST_OPERATOR(RESULT, OP)                                         \
  friend Lanes<RESULT> operator OP(const Lanes& a, const Lanes& b) {           \
    return map<RESULT>(a, b, [](Value x, Value y) { return RESULT(x OP y); }); \
  }
  ODIS_TEST_OPERATOR(Value, +)
  ODIS_TEST_OPERATOR(Value, -)
  ODIS_TEST_OPERATOR(Value, *)
  ODIS_TEST_OPERATOR(Value, /)
  ODIS_TEST_OPERATOR(bool, <)
  ODIS_TEST_OPERATOR(bool, >)
  ODIS_TEST_OPERATOR(bool, <=)
  ODIS_TEST_OPERATOR(bool, >=)
  ODIS_TEST_OPERATOR(bool, ==)
  ODIS_TEST_OPERATOR(Value, &)
#undef ODIS_TEST_OPERATOR
  friend Lanes operator>>(const Lanes& a, int bits) {
    return map(a, a, [bits](Value x, Value) { return Value(x >> bits); });
  }
  friend Lanes min(const Lanes& a, const Lanes& b) {
    return map(a, b, [](Value x, Value y) { return x < y ? x : y; });
  }
  friend Lanes max(const Lanes& a, const Lanes& b) {
    return map(a, b, [](Value x, Value y) { return x > y ? x : y; });
  }
};
using LaneReal = Lanes<float>;
using LaneInteger = Lanes<int32_t>;
using LaneMask = Lanes<bool>;

template <class Value>
Lanes<Value> select(const LaneMask& mask, const Lanes<Value>& a, const Lanes<Value>& b) {
  Lanes<Value> result;
  for (int i = 0; i < kLaneCount; ++i) result.lane[i] = mask.lane[i] ? a.lane[i] : b.lane[i];
  return result;
}
inline LaneReal abs(const LaneReal& x) {
  return LaneReal::map(x, x, [](float v, float) { return std::abs(v); });
}
inline LaneReal sqrt(const LaneReal& x) {
  return LaneReal::map(x, x, [](float v, float) { return std::sqrt(v); });
}
inline LaneReal copysign(const LaneReal& magnitude, const LaneReal& sign) {
  return LaneReal::map(magnitude, sign, [](float m, float s) { return std::copysign(m, s); });
}
template <class Value>
LaneReal gather(const Value* values, const LaneInteger& index) {
  LaneReal result;
  for (int i = 0; i < kLaneCount; ++i) result.lane[i] = float(values[index.lane[i]]);
  return result;
}
template <class Values>
LaneReal element(const Values& values, const LaneInteger& index) {
  LaneReal result;
  for (int i = 0; i < kLaneCount; ++i) result.lane[i] = values[size_t(index.lane[i])].lane[i];
  return result;
}
inline std::array<LaneReal, 4> row(const LaneReal* table, const LaneInteger& index) {
  std::array<LaneReal, 4> result;
  for (int x = 0; x < 4; ++x)
    for (int i = 0; i < kLaneCount; ++i) result[size_t(x)].lane[i] = table[4 * index.lane[i] + x].lane[i];
  return result;
}
inline LaneInteger toInteger(const LaneReal& x) {
  LaneInteger result;
  for (int i = 0; i < kLaneCount; ++i) result.lane[i] = int32_t(x.lane[i]);
  return result;
}
inline LaneReal toReal(const LaneInteger& i) {
  LaneReal result;
  for (int k = 0; k < kLaneCount; ++k) result.lane[k] = float(i.lane[k]);
  return result;
}

}  // namespace odis::test

template <>
struct odis::IntegerOf<odis::test::LaneReal> {
  using type = odis::test::LaneInteger;
};
