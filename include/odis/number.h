// Number types of the code that a host runs at every vertex. That code is a set of templates on `Real`:
// `float` on the CPU, a `float` on a GPU, or a class of several lanes that are worked on together. A lane
// class brings the usual operators, whose comparisons give a mask, and these functions, which are found by
// argument-dependent look-up:
//
//   select(mask, a, b)                   a where the mask is set, else b; for numbers and integers
//   min, max, abs, sqrt, copysign        lane by lane
//   gather(pointer, index)               the Real of pointer[index], lane by lane
//   row(table, index)                    the four numbers table[4 index + i], as something with operator[]
//   element(values, index)               values[index] of a C array or of a row, lane by lane
//   toInteger(x), toReal(i)              conversions; toInteger rounds towards zero
//
// and a specialisation of IntegerOf. tests/odis/lanes.h is one of some eighty lines.
#pragma once

#include <cassert>
#include <cmath>
#include <cstdint>

// Marks functions that run on the host and, where nvcc compiles them, on the device.
#if defined(__CUDACC__)
#define ODIS_HOST_DEVICE __host__ __device__
#else
#define ODIS_HOST_DEVICE
#endif

namespace odis {

// Fetches memory that is read soon, where the compiler knows how to.
inline void fetchAhead([[maybe_unused]] const void* address) {
#if defined(__GNUC__)
  __builtin_prefetch(address);
#endif
}

// The integer type that belongs to a number type.
template <class Real>
struct IntegerOf;
template <>
struct IntegerOf<float> {
  using type = int32_t;
};
template <class Real>
using Integer = typename IntegerOf<Real>::type;

ODIS_HOST_DEVICE inline float select(bool mask, float a, float b) {
  return mask ? a : b;
}
ODIS_HOST_DEVICE inline int32_t select(bool mask, int32_t a, int32_t b) {
  return mask ? a : b;
}
// The lesser and the greater of two numbers; b where one of them is not a number.
ODIS_HOST_DEVICE inline float min(float a, float b) {
  return a < b ? a : b;
}
ODIS_HOST_DEVICE inline float max(float a, float b) {
  return a > b ? a : b;
}
ODIS_HOST_DEVICE inline int32_t min(int32_t a, int32_t b) {
  return a < b ? a : b;
}
ODIS_HOST_DEVICE inline int32_t max(int32_t a, int32_t b) {
  return a > b ? a : b;
}
ODIS_HOST_DEVICE inline float abs(float x) {
  return std::abs(x);
}
ODIS_HOST_DEVICE inline float sqrt(float x) {
  return std::sqrt(x);
}
ODIS_HOST_DEVICE inline float copysign(float magnitude, float sign) {
  return std::copysign(magnitude, sign);
}
template <class Value>
ODIS_HOST_DEVICE inline float gather(const Value* values, int32_t index) {
  return float(values[index]);
}
ODIS_HOST_DEVICE inline const float* row(const float* table, int32_t index) {
  return table + 4 * index;
}
ODIS_HOST_DEVICE inline float element(const float* values, int32_t index) {
  return values[index];
}
ODIS_HOST_DEVICE inline int32_t toInteger(float x) {
  return int32_t(x);
}
ODIS_HOST_DEVICE inline float toReal(int32_t i) {
  return float(i);
}

// Whether a number is an index of `count` elements, for assertions; of several lanes it is taken for granted.
ODIS_HOST_DEVICE inline bool isIndex(int32_t index, uint32_t count) {
  return uint32_t(index) < count;
}
template <class Lanes>
ODIS_HOST_DEVICE inline bool isIndex(const Lanes&, uint32_t) {
  return true;
}

// Values that lie side by side in memory, from an index on that may differ from lane to lane.
template <class Real, class Value>
class Run {
 public:
  ODIS_HOST_DEVICE Run(const Value* values, Integer<Real> first) : m_values(values), m_first(first) {}
  ODIS_HOST_DEVICE Real operator[](int i) const { return gather(m_values, m_first + Integer<Real>(i)); }

 private:
  const Value* m_values;
  Integer<Real> m_first;
};
// A scalar knows the address, so that compilers turn loops over a run into vector code.
template <class Value>
class Run<float, Value> {
 public:
  ODIS_HOST_DEVICE Run(const Value* values, int32_t first) : m_values(values + first) {}
  ODIS_HOST_DEVICE float operator[](int i) const { return float(m_values[i]); }

 private:
  const Value* m_values;
};

}  // namespace odis
