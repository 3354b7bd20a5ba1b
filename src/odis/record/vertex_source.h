// Vertices wherever they lie, to be read one by one.
#pragma once

#include "odis/path_vertex.h"

namespace odis::core {

// What tells vertices apart, and what they are ordered by.
struct VertexIdentity {
  uint32_t pixel, sample;
  uint16_t depth;
};
inline VertexIdentity identityOf(const PathVertex& v) {
  return {v.pixel, v.sample, v.depth};
}

class VertexSource {
 public:
  virtual ~VertexSource() = default;

  virtual size_t size() const = 0;
  virtual VertexIdentity identity(size_t i) const = 0;
  // Sets the fields that are given; the others keep what `vertex` has, which should be the defaults.
  virtual void copy(size_t i, PathVertex& vertex) const = 0;
  // All vertices if they lie as an array; empty otherwise.
  virtual ArrayView<const PathVertex> array() const = 0;
};

class VertexArray final : public VertexSource {
 public:
  VertexArray(ArrayView<const PathVertex> vertices) : m_vertices(vertices) {}  // NOLINT

  size_t size() const override { return m_vertices.size(); }
  VertexIdentity identity(size_t i) const override { return identityOf(m_vertices[i]); }
  void copy(size_t i, PathVertex& vertex) const override { vertex = m_vertices[i]; }
  ArrayView<const PathVertex> array() const override { return m_vertices; }

 private:
  ArrayView<const PathVertex> m_vertices;
};

}  // namespace odis::core
