// Path vertices as arrays of Python.
#pragma once

#include <memory>
#include <odis/odis.hpp>
#include <variant>
#include <vector>

#include "arrays.h"

namespace odis::python {

// Describes fields of vertices where they lie in Python's arrays, and keeps those alive. A field that is one
// number for all vertices is written out.
class VertexArrays {
 public:
  // From names of fields to arrays; raises ValueError for what does not fit.
  explicit VertexArrays(const nb::dict& fields);

  const OdisPathVertices& described() const { return m_described; }
  // "position, normal, ...": the fields that were given.
  std::string fieldNames() const;

 private:
  using Bytes = std::shared_ptr<const std::vector<uint8_t>>;

  OdisPathVertices m_described;
  std::vector<Array> m_arrays;
  std::vector<Bytes> m_writtenOut;
};

// What functions that take vertices accept: described ones, or fields by name.
using VerticesArgument = std::variant<VertexArrays, nb::dict>;
VertexArrays vertexArrays(const VerticesArgument& vertices);

}  // namespace odis::python
