// What the cells take from the pilot's vertices.
#pragma once

#include <vector>

#include "odis/cells/batches.h"
#include "odis/cells/grid.h"
#include "odis/pilot.h"

namespace odis {

// Whether there is something to learn from a vertex: not discrete, and everything finite.
bool isUsable(const PilotVertex& vertex);
// What the vertex adds to a histogram: the estimate of radiance * cos, as a luminance.
float sampleValue(const PilotVertex& vertex);

// What the vertex scatters back along the path, next-event estimate included: not negative, finite.
Float3 outgoing(const PilotVertex& vertex);
float luminance(const Float3& color);

// A usable vertex. 68 bytes.
struct CellSample {
  Float3 position, normal, wi;
  float distance;
  float value;        // `sampleValue`
  Float3 outgoing;    // `outgoing`
  float rays;         // traced at the vertex and beyond
  float lightSquare;  // estimate of the squared next-event estimate from one group of lights
  uint32_t lightGroup;
};

// The usable vertices of a batch, and the cells of the finest level that they fall into, numbered as they are
// met. 72 bytes a sample and 24 a cell.
struct BatchSamples {
  struct Cell {
    uint64_t key = 0;
    uint32_t count = 0;
    double value = 0;  // sum
  };
  std::vector<CellSample> samples;
  std::vector<uint32_t> cellOf;  // of each sample
  std::vector<Cell> cells;

  uint64_t bytes() const {
    return samples.capacity() * sizeof(CellSample) + cellOf.capacity() * sizeof(uint32_t) +
           cells.capacity() * sizeof(Cell);
  }
};
BatchSamples takeSamples(const PilotBatch& batch, const CellGrid& grid);

}  // namespace odis
