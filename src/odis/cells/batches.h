// Vertices split into tasks for any number of threads, and items of such tasks sorted by cell. How a
// list is split does not depend on the number of threads, so sums made batch by batch don't either.
#pragma once

#include <algorithm>
#include <cassert>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "odis/path_vertex.h"
#include "odis/work/tasks.h"

namespace odis::core {

// A run of items, in pieces as they lie in memory.
template <class Item>
using Batch = std::vector<ArrayView<const Item>>;
using VertexBatch = Batch<PathVertex>;

template <class Item>
size_t countItems(ArrayView<const ArrayView<const Item>> parts) {
  size_t count = 0;
  for (const ArrayView<const Item>& part : parts) count += part.size();
  return count;
}

// At most 256 batches of at least `smallest` items each: enough for many threads, and large enough that most
// of a batch's items share their cells.
template <class Item>
std::vector<Batch<Item>> makeBatches(ArrayView<const ArrayView<const Item>> parts, size_t smallest = 16384) {
  constexpr size_t kMostBatches = 256;
  const size_t size = std::max(smallest, countItems(parts) / kMostBatches);
  std::vector<Batch<Item>> batches;
  size_t room = 0;  // in the last batch
  for (ArrayView<const Item> part : parts)
    while (!part.empty()) {
      if (room == 0) {
        batches.emplace_back();
        room = size;
      }
      const size_t taken = std::min(room, part.size());
      batches.back().push_back(part.subview(0, taken));
      part = part.subview(taken, part.size() - taken);
      room -= taken;
    }
  return batches;
}

// The items of each cell, in the order of batches and of items within them.
template <class Item>
struct CellOrder {
  std::vector<const Item*> items;
  std::vector<uint32_t> begin;  // where each cell's items begin, and where the last ones end

  std::span<const Item* const> of(size_t cell) const {
    return std::span(items).subspan(begin[cell], begin[cell + 1] - begin[cell]);
  }
  uint64_t bytes() const { return items.size() * sizeof(Item*) + begin.size() * sizeof(uint32_t); }
};

// Which cells the items of a batch belong to. A batch knows its own cells by small numbers.
struct BatchCells {
  std::span<const uint32_t> cellOf;  // of each item: an index of `cells`
  std::vector<uint32_t> cells;       // the number of each of the batch's cells among all; of those with items
};

// A counting sort. All cells have numbers below `cellCount`; `itemAt(batch, i)` is an item.
template <class Item, class ItemAt>
CellOrder<Item> sortByCell(const Tasks& tasks, std::span<const BatchCells> batches, uint32_t cellCount,
                           const ItemAt& itemAt) {
  // How many items each batch has for each of its cells, then where they begin, then the items.
  std::vector<std::vector<uint32_t>> next(batches.size());
  tasks.forEach(batches.size(), [&](size_t b) {
    next[b].assign(batches[b].cells.size(), 0);
    for (const uint32_t cell : batches[b].cellOf) ++next[b][cell];
  });
  CellOrder<Item> result;
  result.begin.assign(size_t(cellCount) + 1, 0);
  for (size_t b = 0; b < batches.size(); ++b)
    for (size_t i = 0; i < next[b].size(); ++i)
      if (next[b][i] > 0) {
        assert(batches[b].cells[i] < cellCount);
        result.begin[batches[b].cells[i] + 1] += next[b][i];
      }
  std::partial_sum(result.begin.begin(), result.begin.end(), result.begin.begin());
  std::vector<uint32_t> free(result.begin.begin(), result.begin.end() - 1);
  for (size_t b = 0; b < batches.size(); ++b)
    for (size_t i = 0; i < next[b].size(); ++i)
      if (next[b][i] > 0) {
        uint32_t& begin = free[batches[b].cells[i]];
        begin += std::exchange(next[b][i], begin);
      }
  result.items.resize(result.begin.back());
  tasks.forEach(batches.size(), [&](size_t b) {
    for (size_t i = 0; i < batches[b].cellOf.size(); ++i)
      result.items[next[b][batches[b].cellOf[i]]++] = &itemAt(b, i);
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

}  // namespace odis::core
