#include "odis/cells/statistics.h"

#include <cassert>
#include <cmath>
#include <numeric>

#include "odis/cells/place_grid.h"
#include "odis/cells/surroundings.h"
#include "odis/maps/texel_directions.h"
#include "odis/record/vertex_check.h"

namespace odis::core {

namespace {

// The least number of samples with which a cell of the finest level has a map of its own; fewer would hardly
// change its parent's map.
constexpr double kLeastForFinestMap = 16;
// The same for a cell beyond the grid's reach; a map of fewer samples would not save what it costs.
constexpr double kLeastForFarMap = 64;
// With so many samples a half of such a map comes from the cell itself (GuideOptions::priorSamples).
constexpr double kHalfKnown = 250;

}  // namespace

Float3 reaim(const Float3& position, const Float3& wi, float distance, const Float3& centroid) {
  if (!std::isfinite(distance)) return wi;
  const Float3 direction = position + wi * distance - centroid;
  const float squared = dot(direction, direction);
  const bool usable = squared > 1e-20f && squared < INFINITY && dot(direction, wi) > 0;
  return usable ? direction * (1 / std::sqrt(squared)) : wi;
}

Histogram cosinesOf(const CellStatistics& cell) {
  if (!cell.inMedium) return cosinesTo(meanNormal(cell));
  Histogram ones;
  ones.fill(1);
  return ones;
}

CellStore::CellStore(float clamp, bool looksAround, std::shared_ptr<const Tasks> tasks)
    : m_clamp(clamp), m_looksAround(looksAround), m_tasks(std::move(tasks)) {}
CellStore::~CellStore() = default;

uint64_t CellStore::bytes() const {
  return m_cells.capacity() * sizeof(CellStatistics) + m_links.capacity() * sizeof(Link) +
         m_fields.capacity() * sizeof(LightField) + m_around.size * sizeof(Surroundings) + m_index.bytes() +
         (m_fieldOf.capacity() + m_children.capacity() + m_firstChild.capacity()) * sizeof(uint32_t);
}

std::vector<uint64_t> CellStore::keys() const {
  std::vector<uint64_t> keys;
  keys.reserve(m_links.size());
  for (const Link& link : m_links) keys.push_back(link.key);
  return keys;
}

void CellStore::place(std::span<BatchSamples* const> batches, int cellsPerDiagonal) {
  size_t count = 0;
  for (const BatchSamples* batch : batches) count += batch->samples.size();
  std::vector<Float3> positions;
  const size_t step = std::max<size_t>(1, count / 20000);
  size_t next = 0;  // within the batch
  for (const BatchSamples* batch : batches) {
    for (; next < batch->samples.size(); next += step) positions.push_back(batch->samples[next].position);
    next -= batch->samples.size();
  }
  place(gridFor(std::move(positions), cellsPerDiagonal));
}

// Doubles the edges of the cells until there are few enough. Coarser levels add less than half as many.
// Returns whether the grid is another one.
bool CellStore::coarsen(std::span<BatchSamples* const> batches) {
  constexpr int kMostCoarsening = 1 << 18;
  const int before = m_coarsening;
  while (m_coarsening < kMostCoarsening) {
    CellIndex finest;
    for (const BatchSamples* batch : batches)
      for (const CellSample& s : batch->samples) finest.insert(m_grid.key(s.position, s.normal, 0));
    if (finest.size() + finest.size() / 2 <= m_mostCells) break;
    m_coarsening *= 2;
    place(m_grid.coarser(2));
  }
  return m_coarsening > before;
}

void CellStore::place(const CellGrid& grid) {
  m_grid = grid;
  m_placed = true;
}

// The number of the cell with this key, of the finest level; it and its ancestors get numbers if they have
// none. kNoCell where there is no room for them.
uint32_t CellStore::insert(uint64_t key) {
  if (m_links.size() + kCellLevels > m_mostCells) return m_index.find(key);
  uint32_t child = kNoCell, finest = kNoCell;
  for (int level = 0; level < kCellLevels; ++level, key = CellGrid::parent(key)) {
    const uint32_t before = m_index.size();
    const uint32_t cell = m_index.insert(key);
    if (level == 0) finest = cell;
    if (cell == before) m_links.push_back({kNoCell, level, key});
    if (child != kNoCell) m_links[child].parent = cell;
    if (cell != before) break;  // its ancestors are known
    child = cell;
  }
  return finest;
}

namespace {

// Adds samples to their cell, and to the light seen from the middle of its parent's cube if that is
// gathered; values clamped.
void accumulate(CellStatistics& cell, LightField* field, const Float3& middle, float limit,
                std::span<const CellSample* const> samples) {
  if (cell.count == 0) {
    forEachItem(samples, [&](const CellSample& s) { cell.centroid = cell.centroid + s.position; });
    cell.centroid = cell.centroid * (1.0f / float(samples.size()));
  }
  forEachItem(samples, [&](const CellSample& sample) {
    const float value = std::min(sample.value, limit);
    cell.count += 1;
    cell.sum += value;
    cell.sumSquares += double(value) * value;
    const Float3& outgoing = sample.outgoing;
    cell.outgoing[0] += outgoing.x;
    cell.outgoing[1] += outgoing.y;
    cell.outgoing[2] += outgoing.z;
    const double brightness = luminance(outgoing);
    cell.outgoingSquares += brightness * brightness;
    cell.rays += sample.rays;
    // Added for every sample, as zeros where it does not count: branches would be mispredicted.
    assert(sample.lightGroup < kMaxLightGroups);
    cell.lightCount += sample.lightSquare != kNoLights;
    cell.lightSquares[sample.lightGroup] += std::max(sample.lightSquare, 0.0f);
    cell.normal = cell.normal + sample.normal;
    cell.bothSides += sample.scattersBothSides();
    if (value <= 0) return;
    const Splat spread = splat(reaim(sample.position, sample.wi, sample.distance, cell.centroid));
    for (int k = 0; k < 4; ++k) cell.histogram[spread.texel[k]] += value * spread.weight[k];
    if (field) field->add(sample, value, middle);
  });
}

}  // namespace

void CellStore::add(VertexParts parts, int cellsPerDiagonal, const VertexRules& rules) {
  const std::vector<VertexBatch> vertices = makeBatches(parts);
  std::vector<BatchSamples> samples(vertices.size());
  m_tasks->forEach(vertices.size(), [&](size_t b) { samples[b] = take(vertices[b], rules); });
  std::vector<BatchSamples*> batches;
  for (BatchSamples& batch : samples) batches.push_back(&batch);
  add(batches, cellsPerDiagonal);
}

BatchSamples CellStore::takeWithoutCells(const VertexBatch& batch, const VertexRules& rules) const {
  BatchSamples result = takeSamples(batch, rules);
  if (m_depthShares.areUnknown())
    for (const ArrayView<const PathVertex>& piece : batch)
      for (const PathVertex& v : piece) result.energy.add(v);
  return result;
}

BatchSamples CellStore::take(const VertexBatch& batch, const VertexRules& rules) const {
  BatchSamples result = takeWithoutCells(batch, rules);
  if (m_placed) assignCells(result, m_grid);
  return result;
}

// Makes room for the cells that got numbers.
void CellStore::addNewCells() {
  const size_t known = m_cells.size(), count = m_links.size();
  m_cells.resize(count);
  m_fieldOf.resize(count, kNoCell);
  m_firstChild.assign(count + 1, 0);
  for (size_t c = 0; c < count; ++c)
    if (m_links[c].parent != kNoCell) ++m_firstChild[m_links[c].parent + 1];
  std::partial_sum(m_firstChild.begin(), m_firstChild.end(), m_firstChild.begin());
  m_children.resize(m_firstChild.back());
  std::vector<uint32_t> free(m_firstChild.begin(), m_firstChild.end() - 1);
  uint32_t fields = uint32_t(m_fields.size());
  for (size_t c = 0; c < count; ++c) {
    const Link& link = m_links[c];
    if (link.parent != kNoCell) m_children[free[link.parent]++] = uint32_t(c);
    if (c < known) continue;
    m_cells[c].parent = link.parent;
    assert(link.level < kCellLevels);
    m_cells[c].level = link.level;
    m_cells[c].inMedium = CellGrid::isOfMedium(link.key);
    if (m_looksAround && link.level == 1) m_fieldOf[c] = fields++;
  }
  m_fields.resize(fields);
}

void CellStore::add(std::span<BatchSamples* const> batches, int cellsPerDiagonal) {
  if (!m_placed) place(batches, cellsPerDiagonal);
  const bool isCoarser = m_cells.empty() && m_mostCells < kMostCells && coarsen(batches);
  // Cells that are known are found by many threads; new ones get their numbers in the order of the vertices.
  std::vector<BatchCells> cells(batches.size());
  m_tasks->forEach(batches.size(), [&](size_t b) {
    if (isCoarser || !batches[b]->haveCells()) assignCells(*batches[b], m_grid);
    cells[b].cellOf = batches[b]->cellOf;
    cells[b].cells.reserve(batches[b]->cells.size());
    for (const BatchSamples::Cell& cell : batches[b]->cells) cells[b].cells.push_back(m_index.find(cell.key));
  });
  for (size_t b = 0; b < batches.size(); ++b) {
    for (size_t i = 0; i < cells[b].cells.size(); ++i) {
      if (cells[b].cells[i] != kNoCell) continue;
      const BatchSamples::Cell& cell = batches[b]->cells[i];
      cells[b].cells[i] = insert(cell.key);
      if (cells[b].cells[i] == kNoCell) m_samplesLeftOut += cell.count;
    }
    addCounts(m_vertexCounts, batches[b]->counts);
  }
  addNewCells();
  // Samples without a cell are sorted behind all others.
  for (BatchCells& batch : cells)
    for (uint32_t& cell : batch.cells) cell = std::min(cell, uint32_t(m_cells.size()));

  // Values are clamped by those of the next coarser cell.
  std::vector<double> parentSum(m_cells.size(), 0.0), parentCount(m_cells.size(), 0.0);
  for (size_t b = 0; b < batches.size(); ++b)
    for (size_t i = 0; i < cells[b].cells.size(); ++i) {
      if (cells[b].cells[i] == m_cells.size()) continue;
      const uint32_t parent = m_cells[cells[b].cells[i]].parent;
      parentSum[parent] += batches[b]->cells[i].value;
      parentCount[parent] += batches[b]->cells[i].count;
    }

  // Sort the samples by cell and add them up.
  const CellOrder<CellSample> order =
      sortByCell<CellSample>(*m_tasks, cells, uint32_t(m_cells.size()) + 1,
                             [&](size_t b, size_t i) -> const CellSample& { return batches[b]->samples[i]; });
  m_transientBytes = order.bytes();
  for (const BatchSamples* batch : batches) m_transientBytes += batch->bytes();
  forEachCell(*m_tasks, m_cells.size(), [&](size_t parent) {
    if (m_links[parent].level != 1) return;
    LightField* field = m_looksAround ? &m_fields[m_fieldOf[parent]] : nullptr;
    const float limit = largestValue(parentCount[parent], parentSum[parent]);
    for (const uint32_t c : childrenOf(parent))
      if (!order.of(c).empty())
        accumulate(m_cells[c], field, m_grid.middle(m_links[parent].key), limit, order.of(c));
  });
  if (!m_caches) return;
  EnergyByDepth energy;
  for (const BatchSamples* batch : batches) energy.add(batch->energy);
  m_depthShares.learn(energy);
  addReturned(order);
}

void addTo(CellStatistics& sum, const CellStatistics& cell) {
  sum.count += cell.count;
  if (sum.count > 0)
    sum.centroid = sum.centroid + (cell.centroid - sum.centroid) * float(cell.count / sum.count);
  sum.sum += cell.sum;
  sum.sumSquares += cell.sumSquares;
  for (size_t i = 0; i < 3; ++i) sum.outgoing[i] += cell.outgoing[i];
  sum.outgoingSquares += cell.outgoingSquares;
  sum.rays += cell.rays;
  for (size_t half = 0; half < 2; ++half) addTo(sum.halves[half], cell.halves[half]);
  sum.lightCount += cell.lightCount;
  for (size_t g = 0; g < sum.lightSquares.size(); ++g) sum.lightSquares[g] += cell.lightSquares[g];
  sum.normal = sum.normal + cell.normal;
  sum.bothSides += cell.bothSides;
  for (int t = 0; t < kMapTexels; ++t) sum.histogram[t] += cell.histogram[t];
}

const std::vector<CellStatistics>& CellStore::rollUp() {
  for (int level = 1; level < kCellLevels; ++level)
    forEachCell(*m_tasks, m_cells.size(), [&](size_t c) {
      if (m_links[c].level != level) return;
      CellStatistics& cell = m_cells[c];
      cell = {};
      cell.parent = m_links[c].parent;
      cell.level = level;
      cell.inMedium = CellGrid::isOfMedium(m_links[c].key);
      for (const uint32_t child : childrenOf(c)) addTo(cell, m_cells[child]);
    });
  forEachCell(*m_tasks, m_cells.size(), [&](size_t c) {
    CellStatistics& cell = m_cells[c];
    cell.hasMap = cell.parent == kNoCell || cell.count >= leastForMap(c);
  });
  return m_cells;
}

double CellStore::leastForMap(size_t cell) const {
  if (!m_grid.isWithinReach(m_links[cell].key)) return kLeastForFarMap;
  return m_links[cell].level == 0 ? kLeastForFinestMap : 0;
}

double CellStore::visitedCells() const {
  double sum = 0;
  for (size_t c = 0; c < m_cells.size(); ++c)
    if (m_grid.isWithinReach(m_links[c].key))
      sum += 1;
    else if (m_cells[c].hasMap)
      sum += m_cells[c].count / (m_cells[c].count + kHalfKnown);
  return sum;
}

// Puts the light of coarser cells together from their children's, then lets all cells look at it.
const std::vector<CellStatistics>& CellStore::lookAround() {
  if (!m_looksAround) return m_cells;
  LightPoints points;
  std::vector<uint32_t> pointsOf(m_cells.size(), kNoCell);
  for (int level = 1; level < kCellLevels; ++level)
    for (size_t c = 0; c < m_cells.size(); ++c) {
      if (m_links[c].level != level) continue;
      const Float3 middle = m_grid.middle(m_links[c].key);
      if (level == 1) {
        pointsOf[c] = points.add(m_fields[m_fieldOf[c]], middle);
        continue;
      }
      LightField light;
      for (const uint32_t child : childrenOf(c)) points.addTo(light, pointsOf[child], middle);
      pointsOf[c] = points.add(light, middle);
    }

  // The threads that fill it are the first to touch it.
  if (m_around.size < m_cells.size()) {
    m_around.cells = std::make_unique_for_overwrite<Surroundings[]>(m_cells.size());
    m_around.size = m_cells.size();
  }
  fillSurroundings(points, pointsOf);
  return m_cells;
}

// Cells of one parent, and of one grandparent, have the same cells around them: what those have seen is put
// together once, as from the parent's centroid, and each child looks at that.
void CellStore::fillSurroundings(const LightPoints& points, std::span<const uint32_t> pointsOf) {
  const auto clear = [&](size_t cell, size_t map) { m_around.cells[cell][map].fill(0); };
  forEachCell(*m_tasks, m_cells.size(), [&](size_t c) {
    CellStatistics& cell = m_cells[c];
    cell.around = &m_around.cells[c];
    if (cell.parent == kNoCell) clear(c, 0);
    if (cell.parent == kNoCell || m_links[cell.parent].parent == kNoCell) clear(c, 1);
    if (cell.level == 0 || !cell.hasMap) return;

    LightField seen;
    for (int i = 0; i < 27; ++i) {
      const uint32_t near =
          m_index.find(CellGrid::neighbour(m_links[c].key, i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
      if (near != kNoCell) points.addTo(seen, pointsOf[near], cell.centroid);
    }
    LightPoints around;
    around.add(seen, cell.centroid);
    const auto look = [&](size_t from, size_t map) {
      clear(from, map);
      if (!m_cells[from].hasMap) return;
      around.addTo(m_around.cells[from][map], 0, m_cells[from].centroid);
    };
    for (const uint32_t child : childrenOf(c)) {
      look(child, 0);
      for (const uint32_t grandchild : childrenOf(child)) look(grandchild, 1);
    }
  });
}

}  // namespace odis::core
