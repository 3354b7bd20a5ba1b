// What the cells have seen: for each, a histogram over directions of the radiance that arrived, and how much
// there was.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "odis/cells/grid.h"
#include "odis/guide.h"
#include "odis/pilot.h"
#include "odis/sampling.h"

namespace odis {

using Histogram = std::array<float, kMapTexels>;

// The four texels among which a direction is spread, bilinearly, across the seams of the octahedral map.
struct Splat {
  int texel[4];
  float weight[4];
};
Splat splat(const Float3& wi);

struct CellStatistics {
  uint32_t parent = kNoCell;
  int level = 0;
  double count = 0;  // samples
  double sum = 0;    // of their values, radiance * cos / pdf as luminance
  double sumSquares = 0;
  Float3 centroid;        // of the first batch's positions; directions are re-aimed from here
  Float3 normal;          // sum of unit normals
  Histogram histogram{};  // of values by direction
};

// The cells at every level. A coarser cell's statistics are the sums of its children's, formed by `rollUp`.
class CellStore {
 public:
  explicit CellStore(float clamp) : m_clamp(clamp) {}

  // Sorts the vertices into cells and adds them up. The first call places the grid.
  void add(std::span<const PilotVertex> vertices, int cellsPerDiagonal);
  // The cells with the coarser levels filled in.
  std::vector<CellStatistics> rollUp() const;

  const CellGrid& grid() const { return m_grid; }
  const CellIndex& index() const { return m_index; }
  uint64_t bytes() const { return m_cells.capacity() * sizeof(CellStatistics) + m_index.bytes(); }
  float clamp() const { return m_clamp; }

 private:
  void place(std::span<const PilotVertex> vertices, int cellsPerDiagonal);
  uint32_t insert(const PilotVertex& vertex);

  float m_clamp;
  bool m_placed = false;
  CellGrid m_grid;
  CellIndex m_index;
  std::vector<CellStatistics> m_cells;
};

// Whether there is something to learn from a vertex: not discrete, and everything finite.
bool isUsable(const PilotVertex& vertex);
// What the vertex adds to a histogram: the estimate of radiance * cos, as a luminance.
float sampleValue(const PilotVertex& vertex);
// The direction in which a cell's centroid sees what the vertex saw.
Float3 reaim(const PilotVertex& vertex, const Float3& centroid);

// The vertices of each cell of the finest level, in their order: `order[begin[c] .. begin[c + 1])`.
struct CellOrder {
  std::vector<uint32_t> order;
  std::vector<uint32_t> begin;
};
CellOrder sortByCell(const std::vector<uint32_t>& cellOfVertex, uint32_t cellCount);

}  // namespace odis
