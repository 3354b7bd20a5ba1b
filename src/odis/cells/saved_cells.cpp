// Cells written to a file and read again.
#include "odis/cells/saved_grid.h"
#include "odis/cells/statistics.h"
#include "odis/cells/surroundings.h"
#include "odis/record/vertex_fields.h"

namespace odis::core {

// What a cell of the finest level has gathered, but for what returns.
template <class Body>
constexpr void forEachField(FieldsOf<CellStatistics>, const Body& body) {
  body("count", &CellStatistics::count);
  body("lightCount", &CellStatistics::lightCount);
  body("sum", &CellStatistics::sum);
  body("sumSquares", &CellStatistics::sumSquares);
  body("outgoing", &CellStatistics::outgoing);
  body("outgoingSquares", &CellStatistics::outgoingSquares);
  body("rays", &CellStatistics::rays);
  body("centroid", &CellStatistics::centroid);
  body("normal", &CellStatistics::normal);
  body("bothSides", &CellStatistics::bothSides);
  body("groupSquares", &CellStatistics::lightSquares);  // "lightSquares" were of 32 groups
  body("histogram", &CellStatistics::histogram);
}

template <class Body>
constexpr void forEachField(FieldsOf<ReturnedSums>, const Body& body) {
  body("count", &ReturnedSums::count);
  body("outgoing", &ReturnedSums::outgoing);
  body("squares", &ReturnedSums::squares);
  body("passedOn", &ReturnedSums::passedOn);
}
static_assert(listedBytes<ReturnedSums>() == sizeof(ReturnedSums));

template <class Body>
constexpr void forEachField(FieldsOf<LightField>, const Body& body) {
  body("value", &LightField::value);
  body("inverse", &LightField::inverse);
}
static_assert(listedBytes<LightField>() == sizeof(LightField));

// Coarser levels are sums, which rollUp() forms anew.
void CellStore::save(ArchiveWriter& file, const std::string& name) const {
  file.addValue(name + ".placed", uint8_t(m_placed));
  saveGrid(file, name + ".grid", m_grid.flat());
  file.addValue(name + ".coarsening", int32_t(m_coarsening));
  file.addValue(name + ".leftOut", m_samplesLeftOut);
  saveFields(file, name + ".counts", m_vertexCounts);
  file.add(name + ".keys", keys());
  file.add(name + ".depthShares", m_depthShares.shares());
  std::vector<const CellStatistics*> finest;
  for (const CellStatistics& cell : m_cells)
    if (cell.level == 0) finest.push_back(&cell);
  saveFieldsAt<CellStatistics>(file, name + ".finest", finest.size(),
                               [&](size_t i) -> const CellStatistics& { return *finest[i]; });
  // Of both halves of the paths, one after the other.
  saveFieldsAt<ReturnedSums>(file, name + ".returned", m_caches ? 2 * finest.size() : 0,
                             [&](size_t i) -> const ReturnedSums& { return finest[i / 2]->halves[i % 2]; });
  saveFields(file, name + ".fields", m_fields);
}

void CellStore::load(const Archive& file, const std::string& name) {
  m_placed = file.value<uint8_t>(name + ".placed") != 0;
  m_grid = CellGrid(loadGrid(file, name + ".grid"));
  m_coarsening = file.valueOr<int32_t>(name + ".coarsening", 1);
  file.require(m_coarsening >= 1, name + ".coarsening: is damaged");
  m_samplesLeftOut = file.valueOr<uint64_t>(name + ".leftOut", 0);
  m_vertexCounts = loadFieldsOfOne<VertexCounts>(file, name + ".counts");
  m_depthShares.set(file.get<float>(name + ".depthShares"));
  const std::vector<uint64_t> keys = file.get<uint64_t>(name + ".keys");
  file.require(keys.size() <= kMostCells, name + ".keys: are too many");
  for (const uint64_t key : keys) {
    const uint32_t next = m_index.size();
    file.require(CellGrid::levelOf(key) < kCellLevels && m_index.insert(key) == next,
                 name + ".keys: are damaged");
    m_links.push_back({kNoCell, CellGrid::levelOf(key), key});
  }
  for (Link& link : m_links) {
    if (link.level + 1 == kCellLevels) continue;
    link.parent = m_index.find(CellGrid::parent(link.key));
    file.require(link.parent != kNoCell, name + ".keys: a cell has no parent");
  }
  size_t finest = 0;
  for (const Link& link : m_links) finest += link.level == 0;
  const auto cells = loadFields<CellStatistics>(file, name + ".finest", finest);
  const auto returned = loadFields<ReturnedSums>(file, name + ".returned", m_caches ? 2 * finest : 0);
  addNewCells();
  size_t next = 0;
  for (CellStatistics& cell : m_cells) {
    if (cell.level > 0) continue;
    const uint32_t parent = cell.parent;
    const bool inMedium = cell.inMedium;
    cell = cells[next];
    cell.parent = parent;
    cell.inMedium = inMedium;
    if (m_caches) cell.halves = {returned[2 * next], returned[2 * next + 1]};
    ++next;
  }
  m_fields = loadFields<LightField>(file, name + ".fields", m_fields.size());
}

}  // namespace odis::core
