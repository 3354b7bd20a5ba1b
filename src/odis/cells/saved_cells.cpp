// Cells written to a file and read again.
#include "odis/cells/saved_grid.h"
#include "odis/cells/statistics.h"
#include "odis/cells/surroundings.h"
#include "odis/files/archive.h"

namespace odis::core {

namespace {

// Calls body(name, member) for all that a cell of the finest level has gathered.
template <class Body>
void forEachColumn(const Body& body) {
  body("count", &CellStatistics::count);
  body("lightCount", &CellStatistics::lightCount);
  body("sum", &CellStatistics::sum);
  body("sumSquares", &CellStatistics::sumSquares);
  body("outgoing", &CellStatistics::outgoing);
  body("outgoingSquares", &CellStatistics::outgoingSquares);
  body("rays", &CellStatistics::rays);
  body("halves", &CellStatistics::halves);
  body("centroid", &CellStatistics::centroid);
  body("normal", &CellStatistics::normal);
  body("lightSquares", &CellStatistics::lightSquares);
  body("histogram", &CellStatistics::histogram);
}

}  // namespace

// Coarser levels are sums, which rollUp() forms anew.
void CellStore::save(ArchiveWriter& file) const {
  file.addValue("cells.placed", uint8_t(m_placed));
  saveGrid(file, "cells.grid", m_grid.flat());
  file.addValue("cells.coarsening", int32_t(m_coarsening));
  file.addValue("cells.leftOut", m_samplesLeftOut);
  file.addValue("cells.counts", m_vertexCounts);
  file.add("cells.keys", keys());
  file.add("cells.depthShares", m_depthShares.shares());
  forEachColumn([&]<class T>(const std::string& name, T CellStatistics::*member) {
    std::vector<T> column;
    for (const CellStatistics& cell : m_cells)
      if (cell.level == 0) column.push_back(cell.*member);
    file.add("cells." + name, column);
  });
  std::vector<Histogram> fields;
  for (const LightField& field : m_fields) {
    fields.push_back(field.value);
    fields.push_back(field.inverse);
  }
  file.add("cells.fields", fields);
}

void CellStore::load(const Archive& file) {
  m_placed = file.value<uint8_t>("cells.placed") != 0;
  m_grid = CellGrid(loadGrid(file, "cells.grid"));
  m_coarsening = file.value<int32_t>("cells.coarsening");
  m_samplesLeftOut = file.value<uint64_t>("cells.leftOut");
  m_vertexCounts = file.value<VertexCounts>("cells.counts");
  m_depthShares.set(file.get<float>("cells.depthShares"));
  const std::vector<uint64_t> keys = file.get<uint64_t>("cells.keys");
  for (const uint64_t key : keys) {
    const uint32_t next = m_index.size();
    file.require(CellGrid::levelOf(key) < kCellLevels && m_index.insert(key) == next,
                 "cells.keys: are damaged");
    m_links.push_back({kNoCell, CellGrid::levelOf(key), key});
  }
  for (Link& link : m_links) {
    if (link.level + 1 == kCellLevels) continue;
    link.parent = m_index.find(CellGrid::parent(link.key));
    file.require(link.parent != kNoCell, "cells.keys: a cell has no parent");
  }
  addNewCells();
  size_t finest = 0;
  for (const Link& link : m_links) finest += link.level == 0;
  forEachColumn([&]<class T>(const std::string& name, T CellStatistics::*member) {
    const std::vector<T> column = file.get<T>("cells." + name, finest);
    size_t next = 0;
    for (CellStatistics& cell : m_cells)
      if (cell.level == 0) cell.*member = column[next++];
  });
  const std::vector<Histogram> fields = file.get<Histogram>("cells.fields", 2 * m_fields.size());
  for (size_t f = 0; f < m_fields.size(); ++f) m_fields[f] = {fields[2 * f], fields[2 * f + 1]};
}

}  // namespace odis::core
