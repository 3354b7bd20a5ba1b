// What the cells take from path vertices.
#pragma once

#include <utility>
#include <vector>

#include "odis/cell_grid.h"
#include "odis/cells/batches.h"
#include "odis/cells/depth_shares.h"
#include "odis/files/fields.h"
#include "odis/guide_view.h"
#include "odis/path_vertex.h"
#include "odis/record/vertex_check.h"

namespace odis::core {

// What the vertex adds to a histogram: the estimate of radiance * cos, as a luminance.
float sampleValue(const PathVertex& vertex);

// What the vertex scatters back along the path, next-event estimation included: not negative, finite.
Float3 returnedRadiance(const PathVertex& vertex);

// A usable vertex or, with the value 0, one whose path took a delta lobe of a surface that has others. 68
// bytes.
struct CellSample {
  Float3 position, normal, wi;
  float distance;
  float value;      // sampleValue()
  Float3 outgoing;  // returnedRadiance()
  float rays;       // traced at the vertex and beyond
  // Estimate of the squared next-event estimate from one group of lights; kNoLights: not to be counted.
  float lightSquare;
  uint8_t lightGroup;
  uint8_t flags;
  uint16_t depth;

  // Flags: the half of the paths (pathHalf) that it belongs to; whether its surface scatters to both sides.
  static constexpr uint8_t kHalf = 1, kBothSides = 2;
  uint32_t half() const { return flags & kHalf; }
  bool scattersBothSides() const { return (flags & kBothSides) != 0; }
};
inline constexpr float kNoLights = -1;

// The usable vertices of a batch and, once there is a grid, the cells of the finest level that they fall
// into, numbered as they are met. 72 bytes a sample and 24 a cell.
struct BatchSamples {
  struct Cell {
    uint64_t key = 0;
    uint32_t count = 0;
    double value = 0;  // sum of the samples' values
  };
  std::vector<CellSample> samples;
  std::vector<uint32_t> cellOf;  // index of each sample's cell in `cells`
  std::vector<Cell> cells;
  VertexCounts counts;
  EnergyByDepth energy;  // of all vertices, if it is asked for

  bool haveCells() const { return cellOf.size() == samples.size(); }
  // Lets go of all but the counts.
  void release() {
    BatchSamples all;
    all.counts = counts;
    *this = std::move(all);
  }
  uint64_t bytes() const {
    return samples.capacity() * sizeof(CellSample) + cellOf.capacity() * sizeof(uint32_t) +
           cells.capacity() * sizeof(Cell);
  }
};

template <class Body>
constexpr void forEachField(FieldsOf<CellSample>, const Body& body) {
  body("position", &CellSample::position);
  body("normal", &CellSample::normal);
  body("wi", &CellSample::wi);
  body("distance", &CellSample::distance);
  body("value", &CellSample::value);
  body("outgoing", &CellSample::outgoing);
  body("rays", &CellSample::rays);
  body("lightSquare", &CellSample::lightSquare);
  body("lightGroup", &CellSample::lightGroup);
  body("half", &CellSample::flags);  // which was all that it told
  body("depth", &CellSample::depth);
}
static_assert(listedBytes<CellSample>() == sizeof(CellSample));

template <class Body>
constexpr void forEachField(FieldsOf<BatchSamples::Cell>, const Body& body) {
  body("key", &BatchSamples::Cell::key);
  body("count", &BatchSamples::Cell::count);
  body("value", &BatchSamples::Cell::value);
}

// Takes the samples alone.
BatchSamples takeSamples(const VertexBatch& batch, const VertexRules& rules = {});
// Finds their cells.
void assignCells(BatchSamples& batch, const CellGrid& grid);

}  // namespace odis::core
