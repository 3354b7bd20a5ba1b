// From frame to frame: what cells have seen fades, moves to other cells, or is forgotten.
#include "odis/cells/statistics.h"
#include "odis/cells/surroundings.h"

namespace odis::core {

namespace {

// A cell that is left with less than this many samples is forgotten.
constexpr double kLeastSamples = 0.01;

CellStatistics weighted(CellStatistics cell, double weight) {
  for (double* sum :
       {&cell.count, &cell.lightCount, &cell.sum, &cell.sumSquares, &cell.outgoingSquares, &cell.rays})
    *sum *= weight;
  for (double& sum : cell.outgoing) sum *= weight;
  for (ReturnedSums& half : cell.halves) scale(half, weight);
  for (double& sum : cell.lightSquares) sum *= weight;
  for (float& texel : cell.histogram) texel *= float(weight);
  cell.normal = cell.normal * float(weight);
  return cell;
}

LightField weighted(LightField field, double weight) {
  for (Histogram* sums : {&field.value, &field.inverse})
    for (float& texel : *sums) texel *= float(weight);
  return field;
}

void addField(LightField& sum, const LightField& field) {
  for (int t = 0; t < kMapTexels; ++t) {
    sum.value[t] += field.value[t];
    sum.inverse[t] += field.inverse[t];
  }
}

}  // namespace

CellStore& CellStore::operator=(CellStore&&) noexcept = default;

void CellStore::forget() {
  CellStore empty(m_clamp, m_looksAround, m_tasks);
  empty.m_mostCells = m_mostCells;
  if (m_caches) empty.cache(m_depthShares.maxDepth());
  empty.m_numbering = m_numbering + 1;
  *this = std::move(empty);
}

void CellStore::fade(double weight) {
  carryOver(m_grid, weight);
}

void CellStore::move(const CellGrid& grid) {
  if (m_cells.empty()) return place(grid);
  carryOver(grid, 1);
}

void CellStore::carryOver(const CellGrid& grid, double weight) {
  CellStore carried(m_clamp, m_looksAround, m_tasks);
  carried.m_placed = m_placed;
  carried.m_grid = grid;
  carried.m_mostCells = m_mostCells;
  carried.m_caches = m_caches;
  carried.m_depthShares = m_depthShares;
  carried.m_coarsening = m_coarsening;
  carried.m_samplesLeftOut = m_samplesLeftOut;
  carried.m_vertexCounts = m_vertexCounts;
  carried.m_numbering = m_numbering + 1;
  const bool stays = grid == m_grid;
  std::vector<uint32_t> newCell(m_cells.size(), kNoCell);  // of each cell of the finest level
  for (size_t c = 0; c < m_cells.size(); ++c) {
    const CellStatistics& cell = m_cells[c];
    if (cell.level > 0 || cell.count * weight < kLeastSamples) continue;
    newCell[c] = carried.insert(stays ? m_links[c].key : grid.key(cell.centroid, cell.normal, 0));
  }
  carried.addNewCells();
  for (size_t c = 0; c < m_cells.size(); ++c)
    if (newCell[c] != kNoCell) addTo(carried.m_cells[newCell[c]], weighted(m_cells[c], weight));
  if (m_looksAround) carryFields(carried, newCell, weight);
  *this = std::move(carried);
}

// The light field of siblings goes where the one goes that has seen most.
void CellStore::carryFields(CellStore& carried, std::span<const uint32_t> newCell, double weight) const {
  for (size_t c = 0; c < m_cells.size(); ++c) {
    if (m_fieldOf[c] == kNoCell) continue;
    uint32_t heir = kNoCell;
    double most = 0;
    for (const uint32_t child : childrenOf(c))
      if (newCell[child] != kNoCell && m_cells[child].count > most) {
        heir = newCell[child];
        most = m_cells[child].count;
      }
    if (heir == kNoCell) continue;
    const uint32_t parent = carried.m_links[heir].parent;
    const LightField field = weighted(m_fields[m_fieldOf[c]], weight);
    LightField& sum = carried.m_fields[carried.m_fieldOf[parent]];
    if (carried.m_grid == m_grid) {
      addField(sum, field);
      continue;
    }
    LightPoints points;
    points.add(field, m_grid.middle(m_links[c].key));
    points.addTo(sum, 0, carried.m_grid.middle(carried.m_links[parent].key));
  }
}

}  // namespace odis::core
