#include "odis/cells/statistics.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace odis {

namespace {

bool isFinite(const Float3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// The texel at (x, y), which may lie one step outside: the octahedral map continues across an edge mirrored
// about the edge's middle.
int wrappedTexel(int x, int y) {
  if (x < 0 || x >= kMapSize) {
    x = x < 0 ? 0 : kMapSize - 1;
    y = kMapSize - 1 - y;
  }
  if (y < 0 || y >= kMapSize) {
    y = y < 0 ? 0 : kMapSize - 1;
    x = kMapSize - 1 - x;
  }
  return y * kMapSize + x;
}

}  // namespace

Splat splat(const Float3& wi) {
  const Float2 square = directionToSquare(wi);
  const float x = square.x * kMapSize - 0.5f, y = square.y * kMapSize - 0.5f;
  const int x0 = std::clamp(int(std::floor(x)), -1, kMapSize - 1),
            y0 = std::clamp(int(std::floor(y)), -1, kMapSize - 1);
  const float fx = std::clamp(x - x0, 0.0f, 1.0f), fy = std::clamp(y - y0, 0.0f, 1.0f);
  return {{wrappedTexel(x0, y0), wrappedTexel(x0 + 1, y0), wrappedTexel(x0, y0 + 1),
           wrappedTexel(x0 + 1, y0 + 1)},
          {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy}};
}

bool isUsable(const PilotVertex& v) {
  return !v.discrete && v.pdf > 0 && v.survival > 0 && std::isfinite(v.pdf) && isFinite(v.position) &&
         isFinite(v.normal) && isFinite(v.wi) && isFinite(v.radiance) && std::isfinite(v.cosine);
}

float sampleValue(const PilotVertex& v) {
  const float luminance = 0.212671f * v.radiance.x + 0.715160f * v.radiance.y + 0.072169f * v.radiance.z;
  return std::max(luminance, 0.0f) * v.cosine / (v.pdf * v.survival);
}

Float3 reaim(const PilotVertex& v, const Float3& centroid) {
  if (!std::isfinite(v.distance)) return v.wi;
  const Float3 direction = v.position + v.wi * v.distance - centroid;
  const float squared = dot(direction, direction);
  return squared > 1e-20f && dot(direction, v.wi) > 0 ? direction * (1 / std::sqrt(squared)) : v.wi;
}

CellOrder sortByCell(const std::vector<uint32_t>& cellOfVertex, uint32_t cellCount) {
  CellOrder result;
  result.begin.assign(cellCount + 1, 0);
  for (const uint32_t cell : cellOfVertex)
    if (cell != kNoCell) ++result.begin[cell + 1];
  for (uint32_t cell = 0; cell < cellCount; ++cell) result.begin[cell + 1] += result.begin[cell];
  result.order.resize(result.begin.back());
  std::vector<uint32_t> next(result.begin.begin(), result.begin.end() - 1);
  for (uint32_t i = 0; i < cellOfVertex.size(); ++i)
    if (cellOfVertex[i] != kNoCell) result.order[next[cellOfVertex[i]]++] = i;
  return result;
}

// The grid spans what the pilot saw, not what the scene holds: a huge ground plane must not make the cells
// huge. A few vertices far out (0.5 % at either end of each axis) don't count.
void CellStore::place(std::span<const PilotVertex> vertices, int cellsPerDiagonal) {
  std::vector<float> axis[3];
  const size_t step = std::max<size_t>(1, vertices.size() / 20000);
  for (size_t i = 0; i < vertices.size(); i += step) {
    if (!isFinite(vertices[i].position)) continue;
    axis[0].push_back(vertices[i].position.x);
    axis[1].push_back(vertices[i].position.y);
    axis[2].push_back(vertices[i].position.z);
  }
  float low[3] = {}, extent[3] = {};
  for (int a = 0; a < 3 && !axis[a].empty(); ++a) {
    std::sort(axis[a].begin(), axis[a].end());
    const size_t cut = axis[a].size() / 200;
    low[a] = axis[a][cut];
    extent[a] = axis[a][axis[a].size() - 1 - cut] - low[a];
  }
  const float diagonal = std::sqrt(extent[0] * extent[0] + extent[1] * extent[1] + extent[2] * extent[2]);
  const float edge = diagonal > 0 ? diagonal / float(cellsPerDiagonal) : 1.0f;
  // An odd offset keeps walls at the ends of the extent off the cells' faces.
  const float offset = 0.37f * edge;
  m_grid = CellGrid({low[0] - offset, low[1] - offset, low[2] - offset}, edge);
  m_placed = true;
}

uint32_t CellStore::insert(const PilotVertex& vertex) {
  uint32_t child = kNoCell, finest = kNoCell;
  for (int level = 0; level < kCellLevels; ++level) {
    const uint32_t before = m_index.size();
    const uint32_t cell = m_index.insert(m_grid.key(vertex.position, vertex.normal, level));
    if (level == 0) finest = cell;
    if (cell == before) {
      m_cells.emplace_back().level = level;
    }
    if (child != kNoCell) m_cells[child].parent = cell;
    if (cell != before) break;  // its ancestors are known
    child = cell;
  }
  return finest;
}

void CellStore::add(std::span<const PilotVertex> vertices, int cellsPerDiagonal) {
  if (!m_placed) place(vertices, cellsPerDiagonal);

  // Sort the vertices into cells. One thread numbers the new ones, so their order is that of the vertices.
  std::vector<uint32_t> cellOfVertex(vertices.size(), kNoCell);
  std::vector<float> values(vertices.size(), 0.0f);
  tbb::parallel_for(tbb::blocked_range<size_t>(0, vertices.size(), 4096), [&](const auto& range) {
    for (size_t i = range.begin(); i < range.end(); ++i)
      values[i] = isUsable(vertices[i]) ? sampleValue(vertices[i]) : -1;
  });
  for (size_t i = 0; i < vertices.size(); ++i)
    if (values[i] >= 0) cellOfVertex[i] = insert(vertices[i]);
  const CellOrder sorted = sortByCell(cellOfVertex, m_index.size());

  // Values are clamped to a multiple of the mean over the next coarser cell, so that no single path rules a
  // map.
  std::vector<double> parentSum(m_index.size(), 0.0), parentCount(m_index.size(), 0.0);
  for (size_t i = 0; i < vertices.size(); ++i) {
    if (cellOfVertex[i] == kNoCell) continue;
    const uint32_t parent = m_cells[cellOfVertex[i]].parent;
    parentSum[parent] += values[i];
    parentCount[parent] += 1;
  }

  tbb::parallel_for(
      tbb::blocked_range<uint32_t>(0, m_index.size(), 16), [&](const tbb::blocked_range<uint32_t>& range) {
        for (uint32_t index = range.begin(); index < range.end(); ++index) {
          CellStatistics& cell = m_cells[index];
          const uint32_t begin = sorted.begin[index], end = sorted.begin[index + 1];
          if (begin == end) continue;
          if (cell.count == 0) {
            for (uint32_t i = begin; i < end; ++i)
              cell.centroid = cell.centroid + vertices[sorted.order[i]].position;
            cell.centroid = cell.centroid * (1.0f / float(end - begin));
          }
          const float limit = m_clamp * float(parentSum[cell.parent] / parentCount[cell.parent]);
          for (uint32_t i = begin; i < end; ++i) {
            const PilotVertex& vertex = vertices[sorted.order[i]];
            const float value = std::min(values[sorted.order[i]], limit);
            cell.count += 1;
            cell.sum += value;
            cell.sumSquares += double(value) * value;
            cell.normal = cell.normal + vertex.normal;
            if (value <= 0) continue;
            const Splat place = splat(reaim(vertex, cell.centroid));
            for (int k = 0; k < 4; ++k) cell.histogram[place.texel[k]] += value * place.weight[k];
          }
        }
      });
}

std::vector<CellStatistics> CellStore::rollUp() const {
  std::vector<CellStatistics> cells = m_cells;
  for (int level = 0; level + 1 < kCellLevels; ++level)
    for (size_t i = 0; i < cells.size(); ++i) {
      const CellStatistics& child = cells[i];
      if (child.level != level) continue;
      CellStatistics& parent = cells[child.parent];
      parent.count += child.count;
      parent.sum += child.sum;
      parent.sumSquares += child.sumSquares;
      parent.normal = parent.normal + child.normal;
      for (int t = 0; t < kMapTexels; ++t) parent.histogram[t] += child.histogram[t];
    }
  return cells;
}

}  // namespace odis
