// Pilot vertices split into tasks for any number of threads, and items of such tasks sorted by cell. How a
// list is split does not depend on the number of threads, so sums made batch by batch don't either.
#pragma once

#include <tbb/parallel_for.h>

#include <span>
#include <vector>

#include "odis/guide.h"

namespace odis {

// A run of vertices, in pieces as they lie in memory.
using PilotBatch = std::vector<std::span<const PilotVertex>>;
std::vector<PilotBatch> makeBatches(PilotParts parts);

size_t countVertices(PilotParts parts);

// The items of each cell, in the order of batches and of items within them.
template <class Item>
struct CellOrder {
  std::vector<const Item*> items;
  std::vector<uint32_t> begin;  // of each cell's items, and the end

  std::span<const Item* const> of(size_t cell) const {
    return std::span(items).subspan(begin[cell], begin[cell + 1] - begin[cell]);
  }
  uint64_t bytes() const { return items.size() * sizeof(Item*) + begin.size() * sizeof(uint32_t); }
};

// A counting sort. `cells[batch][i]`, below `cellCount`, is the cell of `itemAt(batch, i)`.
template <class Item, class ItemAt>
CellOrder<Item> sortByCell(std::span<const std::vector<uint32_t>> cells, uint32_t cellCount,
                           const ItemAt& itemAt) {
  // How many items each batch has for each cell, then where they begin, then the items.
  std::vector<std::vector<uint32_t>> next(cells.size());
  tbb::parallel_for(size_t(0), cells.size(), [&](size_t batch) {
    next[batch].assign(cellCount, 0);
    for (const uint32_t cell : cells[batch]) ++next[batch][cell];
  });
  CellOrder<Item> result;
  result.begin.resize(size_t(cellCount) + 1);
  uint32_t total = 0;
  for (uint32_t cell = 0; cell < cellCount; ++cell) {
    result.begin[cell] = total;
    for (std::vector<uint32_t>& counts : next) {
      const uint32_t count = counts[cell];
      counts[cell] = total;
      total += count;
    }
  }
  result.begin[cellCount] = total;
  result.items.resize(total);
  tbb::parallel_for(size_t(0), cells.size(), [&](size_t batch) {
    for (size_t i = 0; i < cells[batch].size(); ++i)
      result.items[next[batch][cells[batch][i]]++] = &itemAt(batch, i);
  });
  return result;
}

// Calls `body` with each item. A cell's items lie all over memory, so those to come are fetched ahead.
template <class Item, class Body>
void forEachItem(std::span<const Item* const> items, const Body& body) {
  constexpr size_t kAhead = 8, kLine = 64;
  for (size_t i = 0; i < items.size(); ++i) {
    if (i + kAhead < items.size())
      for (size_t byte = 0; byte < sizeof(Item); byte += kLine)
        __builtin_prefetch(reinterpret_cast<const char*>(items[i + kAhead]) + byte);
    body(*items[i]);
  }
}

}  // namespace odis
