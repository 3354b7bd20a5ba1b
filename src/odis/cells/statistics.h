// What the cells have seen: for each cell a histogram over directions of the radiance that arrived, and
// sums over its samples.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "odis/cells/cell_index.h"
#include "odis/cells/depth_shares.h"
#include "odis/cells/returned.h"
#include "odis/cells/samples.h"
#include "odis/maps/histogram.h"

namespace odis::core {

// What the cells around a cell have seen, re-aimed at its centroid: sums of values over the 27 cells around
// its parent, and over those around its parent's parent; zeros beyond the coarsest level.
using Surroundings = std::array<Histogram, 2>;

// The greatest number of cells of a store, some 8 GB without a guide. As many maps are left to pixels.
inline constexpr size_t kMostCells = kMostMaps / 2;

class Archive;
class ArchiveWriter;
class LightPoints;
struct LightField;

struct CellStatistics {
  uint32_t parent = kNoCell;
  int level = 0;
  double count = 0;                      // number of samples
  double lightCount = 0;                 // number of samples that tell of lights
  double sum = 0;                        // sum of the samples' values, radiance * cos / pdf as luminance
  double sumSquares = 0;                 // sum of the squares of the values
  std::array<double, 3> outgoing{};      // sum of what the vertices scatter back, in red, green and blue
  double outgoingSquares = 0;            // sum of the squares of its luminance
  double rays = 0;                       // sum of the rays traced at the vertices and beyond
  std::array<ReturnedSums, 2> halves{};  // of the paths (pathHalf); only of a store that caches
  // Mean position of the first batch's samples, or of a coarser cell's children; directions are re-aimed
  // from here.
  Float3 centroid;
  Float3 normal;         // sum of the samples' unit normals
  double bothSides = 0;  // number of samples whose surfaces scatter to both sides
  std::array<double, kMaxLightGroups> lightSquares{};  // sums of CellSample::lightSquare, for each group
  Histogram histogram{};                               // sums of values by direction
  const Surroundings* around = nullptr;                // null where nothing asked for it
  // Whether its vertices are those of a medium, as its key says: they have no normals, and cosines are 1.
  bool inMedium = false;
  // Whether it has a map of its own, not its parent's. Finest cells, and those beyond the grid's reach, that
  // paths seldom come to have none, so that they cost next to nothing.
  bool hasMap = true;
};

// The mean unit normal of a cell's vertices; upwards where there is none.
inline Float3 meanNormal(const CellStatistics& cell) {
  const float length = std::sqrt(dot(cell.normal, cell.normal));
  return length > 0 ? cell.normal * (1 / length) : Float3{0, 0, 1};
}

// The cosines, with their sign, between the mean normal of a cell and the texels' centres; 1 in media.
Histogram cosinesOf(const CellStatistics& cell);

// Adds what a cell has seen to what another one has.
void addTo(CellStatistics& sum, const CellStatistics& cell);

// A cell and its ancestors, finest first; null beyond the coarsest.
using CellChain = std::array<const CellStatistics*, kCellLevels>;
inline CellChain chainOf(std::span<const CellStatistics> cells, size_t cell) {
  CellChain chain{};
  size_t length = 0;
  for (size_t next = cell; next != kNoCell && length < chain.size(); next = cells[next].parent)
    chain[length++] = &cells[next];
  return chain;
}

// Calls `body` with the index of each cell, by many threads at once.
template <class Body>
void forEachCell(const Tasks& tasks, size_t count, const Body& body) {
  constexpr size_t kBlock = 16;
  tasks.forEach((count + kBlock - 1) / kBlock, [&](size_t block) {
    const size_t end = std::min((block + 1) * kBlock, count);
    for (size_t cell = block * kBlock; cell < end; ++cell) body(cell);
  });
}

// Calls `body` with the index of each cell: parents before their children, those of a level by many threads
// at once.
template <class Body>
void forEachFromCoarse(const Tasks& tasks, std::span<const CellStatistics> cells, const Body& body) {
  for (int level = kCellLevels - 1; level >= 0; --level)
    forEachCell(tasks, cells.size(), [&](size_t c) {
      if (cells[c].level == level) body(c);
    });
}

// The cells at every level. A coarser cell's statistics are the sums of its children's, formed by `rollUp`.
class CellStore {
 public:
  // `clamp` as in GuideOptions. What lies around the cells is gathered only if it is asked for.
  explicit CellStore(float clamp, bool looksAround = false,
                     std::shared_ptr<const Tasks> tasks = libraryTasks());
  ~CellStore();
  CellStore(const CellStore&);
  CellStore(CellStore&&) noexcept;
  CellStore& operator=(CellStore&&) noexcept;

  // Keeps the number of cells below a limit: the first call of `add` makes them as much larger as it takes,
  // later ones leave out the samples of cells that there is no more room for.
  void limitCells(size_t most) { m_mostCells = std::min(most, kMostCells); }
  // Lets the store gather what a radiance cache needs, of paths of this max_depth (0: none).
  void cache(uint32_t maxDepth);
  // How many times larger the cells' edges are for that, and how many samples were left out.
  int coarsening() const { return m_coarsening; }
  uint64_t samplesLeftOut() const { return m_samplesLeftOut; }

  // Places the grid; otherwise the first call of `add` does.
  void place(const CellGrid& grid);
  // Places the grid anew: what a cell has seen goes to the cell around its centroid.
  void move(const CellGrid& grid);
  // Lets each sample that was added count `weight` times, in [0, 1]. Cells that are left with less than a
  // hundredth of a sample are forgotten.
  void fade(double weight);
  // Lets go of all that was added, and of the grid.
  void forget();
  // Adds what another store with the same options has seen, each of its samples counting `weight` times: to
  // the same cells if the grids are equal, else to those around its cells' centroids.
  void add(const CellStore& other, double weight = 1);
  // Sorts the vertices into cells and adds them up.
  void add(VertexParts parts, int cellsPerDiagonal, const VertexRules& rules = {});
  // The same in two steps: many threads take samples, with their cells if there is a grid by then; one call
  // adds them up and finds the cells of those that have none.
  BatchSamples take(const VertexBatch& batch, const VertexRules& rules = {}) const;
  BatchSamples takeWithoutCells(const VertexBatch& batch, const VertexRules& rules) const;
  void add(std::span<BatchSamples* const> batches, int cellsPerDiagonal);
  // The cells, with the coarser levels filled in. They stay as they are until more is added.
  const std::vector<CellStatistics>& rollUp();
  // Fills in what lies around the cells that are rolled up, in a store that gathers it. Returns the cells.
  const std::vector<CellStatistics>& lookAround();

  // How many cells there are that paths come to: beyond the grid's reach one counts less than 1, by how many
  // samples it has.
  double visitedCells() const;

  // Writes all that was added, in arrays whose names begin with `name`, and reads it into a store without
  // cells. The latter throws FileError.
  void save(ArchiveWriter& file, const std::string& name) const;
  void load(const Archive& file, const std::string& name);

  // How many vertices were taken and refused.
  const VertexCounts& vertexCounts() const { return m_vertexCounts; }
  bool isPlaced() const { return m_placed; }
  const CellGrid& grid() const { return m_grid; }
  const CellIndex& index() const { return m_index; }
  // The key of each cell.
  std::vector<uint64_t> keys() const;
  uint64_t bytes() const;
  // What the last `add` needed on top of the cells, the samples that it was given included.
  uint64_t transientBytes() const { return m_transientBytes; }
  // The most that a value counts in a cell whose parent has so many samples with this sum of values, so that
  // no single path rules a map. Maps take the sum of what is added at once, as it comes; what judges a map
  // without a vertex's own sample takes all that the parent has, clamped already. That is less, and better:
  // by the maps' limits cells are guided too seldom (docs/experiments/0060-one-clamp.md).
  float largestValue(double count, double sum) const { return count > 0 ? m_clamp * float(sum / count) : 0; }
  const DepthShares& depthShares() const { return m_depthShares; }
  const Tasks& tasks() const { return *m_tasks; }

 private:
  void place(std::span<BatchSamples* const> batches, int cellsPerDiagonal);
  bool coarsen(std::span<BatchSamples* const> batches);
  void carryOver(const CellGrid& grid, double weight);
  void addFields(const CellStore& other, std::span<const uint32_t> newCell, double weight);
  uint32_t insert(uint64_t key);
  void addNewCells();
  void addReturned(const CellOrder<CellSample>& order);
  // The least number of samples with which a cell has a map of its own.
  double leastForMap(size_t cell) const;
  void fillSurroundings(const LightPoints& points, std::span<const uint32_t> pointsOf);
  std::span<const uint32_t> childrenOf(size_t cell) const {
    return std::span(m_children).subspan(m_firstChild[cell], m_firstChild[cell + 1] - m_firstChild[cell]);
  }

  float m_clamp;
  bool m_looksAround;
  bool m_caches = false;
  DepthShares m_depthShares;
  std::shared_ptr<const Tasks> m_tasks;
  bool m_placed = false;
  size_t m_mostCells = kMostCells;
  int m_coarsening = 1;
  uint64_t m_samplesLeftOut = 0;
  CellGrid m_grid;
  CellIndex m_index;
  struct Link {
    uint32_t parent;
    int level;
    uint64_t key;
  };
  std::vector<Link> m_links;  // of all cells that have numbers
  std::vector<CellStatistics> m_cells;
  std::vector<uint32_t> m_children, m_firstChild;  // of all cells, and where each cell's begin
  std::vector<LightField> m_fields;                // what arrives in the cells one level above the finest
  std::vector<uint32_t> m_fieldOf;                 // of each cell: an index of m_fields, or kNoCell
  // Of each cell, filled in anew whenever it is asked for: copies of a store have none.
  struct Around {
    Around() = default;
    Around(const Around&) {}
    Around(Around&&) noexcept = default;
    Around& operator=(Around&&) noexcept = default;

    std::unique_ptr<Surroundings[]> cells;
    size_t size = 0;
  } m_around;
  uint64_t m_transientBytes = 0;
  VertexCounts m_vertexCounts;
};

// The direction in which a cell's centroid sees what a vertex at `position` saw at `distance` in direction
// `wi`.
Float3 reaim(const Float3& position, const Float3& wi, float distance, const Float3& centroid);

}  // namespace odis::core
