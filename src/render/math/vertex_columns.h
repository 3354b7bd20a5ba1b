// Vertices in columns.
#pragma once

#include <cstddef>

#include "render/math/columns.h"
#include "render/math/surface_point.h"

namespace odis::render {

// What is computed with side by side of the vertices of several paths: see SurfacePoint and Vertex.
struct VertexColumns {
  Columns3 p, ng;
  Columns3 s, t, n;  // the shading frame
  Column uvX, uvY, time, b1, b2, pError;
  Columns3 wo;

  // Vertices are read and written in fours: there are as many pointers as the next multiple of four, all to
  // vertices that may be read or written.
  void read(const Vertex* const* vertices, size_t count) {
    readRows(vertices, count, [](size_t) { return true; });
  }
  // Reads the rows that p, n and wo lie in.
  void readPlaces(const Vertex* const* vertices, size_t count) {
    readRows(vertices, count, [](size_t offset) {
      return offset == kPlaceRow || offset == kNormalRow || offset == kDirectionRow;
    });
  }
  void write(Vertex* const* vertices, size_t count) const {
    for (size_t first = 0; first < count; first += 4)
      forEachRow(
          *this, [&](size_t offset, const Column& a, const Column& b, const Column& c, const Column& d) {
            const auto row = [&](size_t lane) { return reinterpret_cast<float*>(vertices[lane]) + offset; };
            fromColumns(first, row, a.of, b.of, c.of, d.of);
          });
  }

 private:
  // Where rows begin, in numbers from the vertex.
  static constexpr size_t kPlaceRow = 0, kNormalRow = 12,
                          kDirectionRow = offsetof(Vertex, at.pError) / sizeof(float);

  // Reads the rows whose offsets are wanted.
  template <class Wanted>
  [[gnu::always_inline]] void readRows(const Vertex* const* vertices, size_t count, const Wanted& wanted) {
    for (size_t first = 0; first < count; first += 4)
      forEachRow(*this, [&](size_t offset, Column& a, Column& b, Column& c, Column& d) {
        if (!wanted(offset)) return;
        const auto row = [&](size_t lane) { return reinterpret_cast<const float*>(vertices[lane]) + offset; };
        toColumns(first, row, a.of, b.of, c.of, d.of);
      });
  }

  // Calls use(offset, a, b, c, d) for each four numbers that lie side by side in a vertex.
  template <class Self, class Use>
  static void forEachRow(Self& c, const Use& use) {
    constexpr size_t kFloat = sizeof(float);
    static_assert(offsetof(Vertex, at.p) == 0 && offsetof(Vertex, at.ng) == 3 * kFloat &&
                  offsetof(Vertex, at.shading) == 6 * kFloat && offsetof(Vertex, at.uv) == 15 * kFloat &&
                  offsetof(Vertex, at.time) == 17 * kFloat &&
                  offsetof(Vertex, at.barycentric) == 18 * kFloat &&
                  offsetof(Vertex, wo) == offsetof(Vertex, at.pError) + kFloat);
    use(kPlaceRow, c.p.x, c.p.y, c.p.z, c.ng.x);
    use(4, c.ng.y, c.ng.z, c.s.x, c.s.y);
    use(8, c.s.z, c.t.x, c.t.y, c.t.z);
    use(kNormalRow, c.n.x, c.n.y, c.n.z, c.uvX);
    use(16, c.uvY, c.time, c.b1, c.b2);
    use(kDirectionRow, c.pError, c.wo.x, c.wo.y, c.wo.z);
  }
};

}  // namespace odis::render
