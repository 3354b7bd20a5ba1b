// Path vertices as arrays of Python.
#pragma once

#include <odis/odis.hpp>
#include <variant>
#include <vector>

#include "arrays.h"

namespace odis::python {

// Describes fields of vertices where they lie in Python's arrays, and keeps those alive.
class VertexArrays {
 public:
  // From names of fields to arrays; raises ValueError for what does not fit.
  explicit VertexArrays(const nb::dict& fields);

  const OdisPathVertices& described() const { return m_described; }

 private:
  OdisPathVertices m_described;
  std::vector<Array> m_arrays;
};

// What functions that take vertices accept: described ones, or fields by name.
using VerticesArgument = std::variant<VertexArrays, nb::dict>;
VertexArrays vertexArrays(const VerticesArgument& vertices);

}  // namespace odis::python
