// Arrays in both directions: those of Python, read where they lie, and those of the library, shown or handed
// over as numpy's.
#pragma once

#include <nanobind/ndarray.h>

#include <cstring>
#include <string>
#include <type_traits>

#include "bindings.h"

namespace odis::python {

// What comes in: anything that supports DLPack or Python's buffers.
using Array = nb::ndarray<nb::ro>;
// What goes out. The shape is known to type checkers; -1 stands for any size.
template <class T, nb::ssize_t... kShape>
using NumpyArray = nb::ndarray<nb::numpy, T, nb::shape<kShape...>>;

inline constexpr size_t kAnyCount = SIZE_MAX;

// "float32".
std::string typeName(nb::dlpack::dtype type);
// "float32 of shape (10, 3)".
std::string describe(const Array& array);
// Raises ValueError: "NAME: expected EXPECTED, found FOUND".
[[noreturn]] void refuseArray(const char* name, const std::string& expected, const std::string& found);
// Raises ValueError unless the array lies in memory that the CPU reads, holds elements of this type, and has
// one dimension (`columns` is 0) or two, rows and `columns`; `count` is the number of elements or rows.
void requireArray(const Array& array, const char* name, nb::dlpack::dtype type, size_t columns, size_t count);

// The rows of an array with any strides; an array of one dimension has rows of one number.
template <class T>
class Rows {
 public:
  Rows(const Array& array, const char* name, size_t columns = 0, size_t count = kAnyCount)
      : m_array(array), m_data(static_cast<const char*>(array.data())) {
    requireArray(array, name, nb::dtype<T>(), columns, count);
    m_count = array.shape(0);
    m_rowStride = array.stride(0) * int64_t(sizeof(T));
    m_columnStride = columns > 0 ? array.stride(1) * int64_t(sizeof(T)) : 0;
  }
  size_t size() const { return m_count; }
  T operator()(size_t row, int column = 0) const {
    // A flag may be any byte; what is neither 0 nor 1 is no value of a bool in C++.
    std::conditional_t<std::is_same_v<T, bool>, uint8_t, T> value;
    std::memcpy(&value, m_data + int64_t(row) * m_rowStride + column * m_columnStride, sizeof value);
    return T(value);
  }

 private:
  Array m_array;
  const char* m_data;
  size_t m_count = 0;
  int64_t m_rowStride = 0, m_columnStride = 0;
};

inline Float3 vectorAt(const Rows<float>& rows, size_t row) {
  return {rows(row, 0), rows(row, 1), rows(row, 2)};
}

// A new array, not filled in.
template <class Result>
Result newArray(std::initializer_list<size_t> shape) {
  using T = typename Result::Scalar;
  size_t size = 1;
  for (const size_t extent : shape) size *= extent;
  T* data = new T[size];
  const nb::capsule owner(data, [](void* memory) noexcept { delete[] static_cast<T*>(memory); });
  return Result(data, shape, owner);
}

}  // namespace odis::python
