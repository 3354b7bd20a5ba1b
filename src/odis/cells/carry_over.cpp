// What cells have seen goes into other cells: it fades or moves from frame to frame, is added to that of
// another store, or is forgotten.
#include "odis/cells/statistics.h"
#include "odis/cells/surroundings.h"
#include "odis/record/vertex_check.h"

namespace odis::core {

namespace {

// A cell that is left with less than this many samples is forgotten.
constexpr double kLeastSamples = 0.01;

CellStatistics weighted(CellStatistics cell, double weight) {
  for (double* sum : {&cell.count, &cell.lightCount, &cell.sum, &cell.sumSquares, &cell.outgoingSquares,
                      &cell.rays, &cell.bothSides})
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

CellStore::CellStore(const CellStore&) = default;
CellStore::CellStore(CellStore&&) noexcept = default;
CellStore& CellStore::operator=(CellStore&&) noexcept = default;

void CellStore::forget() {
  CellStore empty(m_clamp, m_looksAround, m_tasks);
  empty.m_mostCells = m_mostCells;
  if (m_caches) empty.cache(m_depthShares.maxDepth());
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
  carried.add(*this, weight);
  *this = std::move(carried);
}

void CellStore::add(const CellStore& other, double weight) {
  m_coarsening = std::max(m_coarsening, other.m_coarsening);
  m_samplesLeftOut += other.m_samplesLeftOut;
  addCounts(m_vertexCounts, other.m_vertexCounts);
  if (m_depthShares.areUnknown()) m_depthShares.set(other.m_depthShares.shares());
  const bool sameGrid = other.m_grid == m_grid;
  std::vector<uint32_t> newCell(other.m_cells.size(), kNoCell);  // of each cell of the finest level
  for (size_t c = 0; c < other.m_cells.size(); ++c) {
    const CellStatistics& cell = other.m_cells[c];
    if (cell.level > 0 || cell.count * weight < kLeastSamples) continue;
    // In media the sum of the normals is zero, which makes a key of a medium again.
    newCell[c] = insert(sameGrid ? other.m_links[c].key : m_grid.key(cell.centroid, cell.normal, 0));
  }
  addNewCells();
  for (size_t c = 0; c < other.m_cells.size(); ++c)
    if (newCell[c] != kNoCell) addTo(m_cells[newCell[c]], weighted(other.m_cells[c], weight));
  if (m_looksAround) addFields(other, newCell, weight);
}

// The light field of siblings goes where the one goes that has seen most.
void CellStore::addFields(const CellStore& other, std::span<const uint32_t> newCell, double weight) {
  for (size_t c = 0; c < other.m_cells.size(); ++c) {
    if (other.m_fieldOf[c] == kNoCell) continue;
    uint32_t heir = kNoCell;
    double most = 0;
    for (const uint32_t child : other.childrenOf(c))
      if (newCell[child] != kNoCell && other.m_cells[child].count > most) {
        heir = newCell[child];
        most = other.m_cells[child].count;
      }
    if (heir == kNoCell) continue;
    const uint32_t parent = m_links[heir].parent;
    const LightField field = weighted(other.m_fields[other.m_fieldOf[c]], weight);
    LightField& sum = m_fields[m_fieldOf[parent]];
    if (m_grid == other.m_grid) {
      addField(sum, field);
      continue;
    }
    LightPoints points;
    points.add(field, other.m_grid.middle(other.m_links[c].key));
    points.addTo(sum, 0, m_grid.middle(m_links[parent].key));
  }
}

}  // namespace odis::core
