// Vertices wherever they lie in a host's memory.
#pragma once

#include <vector>

#include "odis/record/vertex_source.h"

namespace odis::core {

// Vertices of a host, read where they lie.
class HostVertices final : public VertexSource {
 public:
  // NULL: none. Throws std::invalid_argument for strides and formats that can't be.
  explicit HostVertices(const OdisPathVertices* described);

  size_t size() const override { return m_size; }
  VertexIdentity identity(size_t i) const override;
  void copy(size_t i, PathVertex& vertex) const override;
  ArrayView<const PathVertex> array() const override { return m_array; }
  // All vertices as an array: their own, or a copy that is made by the first call.
  ArrayView<const PathVertex> view();

 private:
  // Fields that lie side by side, both in the host's memory and in PathVertex.
  struct Run {
    const char* data;
    size_t stride, offset, bytes;  // the latter two within PathVertex
    bool half;

    const char* at(size_t i) const { return data + i * stride; }
  };
  void addRun(const Run& run);

  size_t m_size = 0;
  ArrayView<const PathVertex> m_array;
  std::vector<Run> m_runs;
  Run m_pixel{}, m_sample{}, m_depth{};  // without data: not given
  std::vector<PathVertex> m_copies;
};

}  // namespace odis::core
