// Numbers that are given for each vertex, or once for all of them.
#pragma once

#include <optional>
#include <variant>

#include "arrays.h"

namespace odis::python {

// The number in an array without dimensions, as numpy's numbers are; raises ValueError where the type `T` has
// no such number.
template <class T>
T numberIn(const Array& array, const char* name);

// What functions accept that take numbers for `count` vertices.
template <class T>
using Given = std::variant<T, Array>;

template <class T>
class Each {
 public:
  Each(const Given<T>& given, const char* name, size_t count) {
    if (const T* number = std::get_if<T>(&given))
      m_all = *number;
    else if (const Array& array = std::get<Array>(given); array.ndim() == 0)
      m_all = numberIn<T>(array, name);
    else
      m_rows.emplace(array, name, 0, count);
  }
  T operator()(size_t i) const { return m_rows ? (*m_rows)(i) : m_all; }

 private:
  std::optional<Rows<T>> m_rows;
  T m_all{};
};

}  // namespace odis::python
