#include "odis/image/tiles.h"

#include <algorithm>
#include <cassert>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

namespace odis::core {

namespace {

// Threads share the work on a call that brings at least this many tiles, and this many samples and vertices
// together.
constexpr size_t kTilesForThreads = 5, kWorkForThreads = 16384;

[[noreturn]] void refuseTwice(const FrameSample& sample) {
  throw std::logic_error("odisAddSamples: sample " + std::to_string(sample.sample) + " of pixel " +
                         std::to_string(sample.pixel) + " came twice");
}

}  // namespace

TileCollector::TileCollector(const TileGrid& grid, std::shared_ptr<const Tasks> tasks)
    : m_grid(grid), m_tiles(std::make_unique<Tile[]>(tileCount())), m_tasks(std::move(tasks)) {}

SamplesDue TileCollector::samplesDue(uint32_t tile) const {
  SamplesDue due;
  m_grid.forEachPixel(tile, [&](uint32_t pixel) {
    const uint64_t ofPixel = m_due(pixel).count;
    due.all += ofPixel;
    due.most = std::max(due.most, ofPixel);
  });
  return due;
}

uint64_t TileCollector::missing() const {
  uint64_t missing = 0;
  for (uint32_t t = 0; t < tileCount(); ++t)
    if (!m_tiles[t].done) missing += samplesDue(t).all - m_tiles[t].samples.size();
  return missing;
}

void TileCollector::beginPass(Due due, Sink sink) {
  m_due = std::move(due);
  m_sink = std::move(sink);
  m_notDue = m_twice = 0;
  for (uint32_t t = 0; t < tileCount(); ++t) {
    m_tiles[t].claims.begin({});
    m_tiles[t].done = false;
  }
}

// Whether all samples and vertices are of this tile and due.
bool TileCollector::allIn(uint32_t tile, ArrayView<const FrameSample> samples,
                          ArrayView<const PathVertex> vertices) const {
  // Neighbours are of one pixel for the most part.
  const auto areIn = [&](const auto& all) {
    uint32_t pixel = ~0u;
    SampleRange due;
    for (const auto& each : all) {
      if (each.pixel != pixel) {
        pixel = each.pixel;
        if (pixel >= m_grid.pixelCount() || m_grid.tileOf(pixel) != tile) return false;
        due = m_due(pixel);
      }
      if (each.sample < due.first || each.sample - due.first >= due.count) return false;
    }
    return true;
  };
  return areIn(samples) && areIn(vertices);
}

void TileCollector::add(ArrayView<const FrameSample> samples, const VertexSource& vertices) {
  // Whatever is of one tile and lies in an array needs no sorting by tile.
  if (!samples.empty() && vertices.array().size() == vertices.size())
    if (const uint32_t tile = m_grid.tileOf(samples[0].pixel); allIn(tile, samples, vertices.array())) {
      requireOpen(tile);
      const size_t claimed =
          claim(tile, samples.size(), [&](size_t i) -> const FrameSample& { return samples[i]; });
      if (claimed < samples.size()) refuseTwice(samples[claimed]);
      return addToTile(tile, samples, vertices.array());
    }
  addTiles(samples, vertices);
}

template <class Body>
void TileCollector::forEach(bool byThreads, size_t count, const Body& body) const {
  if (byThreads && m_tasks) return m_tasks->forEach(count, body);
  for (size_t i = 0; i < count; ++i) body(i);
}

// [i] the tile of `identityAt(i)`; TileOrder::kNone if that is not due.
template <class IdentityAt>
std::vector<uint32_t> TileCollector::tilesOf(bool byThreads, size_t count,
                                             const IdentityAt& identityAt) const {
  constexpr size_t kBlock = 8192;
  std::vector<uint32_t> tiles(count);
  forEach(byThreads, (count + kBlock - 1) / kBlock, [&](size_t block) {
    // Neighbours are of one pixel for the most part.
    uint32_t pixel = ~0u, tile = TileOrder::kNone;
    SampleRange due;
    for (size_t i = block * kBlock; i < std::min((block + 1) * kBlock, count); ++i) {
      const auto identity = identityAt(i);
      if (identity.pixel != pixel) {
        pixel = identity.pixel;
        const bool inImage = pixel < m_grid.pixelCount();
        due = inImage ? m_due(pixel) : SampleRange();
        tile = inImage ? m_grid.tileOf(pixel) : TileOrder::kNone;
      }
      tiles[i] = identity.sample - due.first < due.count ? tile : TileOrder::kNone;
    }
  });
  return tiles;
}

// Where samples belong. Neighbours are of one pixel for the most part.
template <class SampleAt>
struct TileCollector::SlotsOf {
  SampleSlot operator()(size_t i) const {
    const FrameSample& s = sampleAt(i);
    if (s.pixel != pixel) {
      pixel = s.pixel;
      place = collector.m_grid.placeInTile(pixel);
    }
    return {place, s.sample};
  }
  uint32_t firstDue() const { return collector.m_due(pixel).first; }

  const TileCollector& collector;
  const SampleAt& sampleAt;
  mutable uint32_t pixel = ~0u, place = 0;
};

// Claims samples of a tile for the call that brings them; answers how many come before one that another
// call has claimed, or this one before. Where that is not `count`, none is claimed.
template <class SampleAt>
size_t TileCollector::claim(uint32_t index, size_t count, const SampleAt& sampleAt) {
  if (count == 0) return 0;
  Tile& tile = m_tiles[index];
  const std::lock_guard lock(tile.mutex);
  if (tile.done) return 0;
  if (tile.claims.due().all == 0) tile.claims.begin(samplesDue(index));
  const uint64_t before = tile.claims.bytes();
  const size_t claimed = tile.claims.claim(count, SlotsOf<SampleAt>{*this, sampleAt});
  m_waitingBytes += tile.claims.bytes() - before;
  return claimed;
}

// The same for the samples of many tiles: all are claimed, or none and std::logic_error is thrown.
template <class SampleAtOf>
void TileCollector::claimAll(bool byThreads, ArrayView<const uint32_t> tiles, const TileOrder& order,
                             const SampleAtOf& sampleAtOf) {
  std::vector<size_t> claimed(tiles.size());
  forEach(byThreads, tiles.size(),
          [&](size_t t) { claimed[t] = claim(tiles[t], order.count(tiles[t]), sampleAtOf(tiles[t])); });
  const auto isRefused = [&](size_t t) { return claimed[t] < order.count(tiles[t]); };
  size_t refused = 0;
  while (refused < tiles.size() && !isRefused(refused)) ++refused;
  if (refused == tiles.size()) return;
  for (size_t t = 0; t < tiles.size(); ++t) {
    if (isRefused(t)) continue;
    const std::lock_guard lock(m_tiles[tiles[t]].mutex);
    const auto sampleAt = sampleAtOf(tiles[t]);
    m_tiles[tiles[t]].claims.disclaim(claimed[t], SlotsOf<decltype(sampleAt)>{*this, sampleAt});
  }
  refuseTwice(sampleAtOf(tiles[refused])(claimed[refused]));
}

void TileCollector::addTiles(ArrayView<const FrameSample> samples, const VertexSource& vertices) {
  const bool isLarge = samples.size() + vertices.size() >= kWorkForThreads;
  const std::vector<uint32_t> tileOfSample =
      tilesOf(isLarge, samples.size(), [&](size_t i) { return samples[i]; });
  for (size_t i = 0; i < samples.size(); ++i)
    if (tileOfSample[i] == TileOrder::kNone)
      throw std::out_of_range("odisAddSamples: sample " + std::to_string(samples[i].sample) + " of pixel " +
                              std::to_string(samples[i].pixel) +
                              " is not due in this pass: odisGetSamples says which are");
  const TileOrder sampleOrder(tileOfSample),
      vertexOrder(tilesOf(isLarge, vertices.size(), [&](size_t i) { return vertices.identity(i); }));
  std::vector<uint32_t> tiles;
  for (uint32_t tile = std::min(sampleOrder.first(), vertexOrder.first());
       tile < std::max(sampleOrder.end(), vertexOrder.end()); ++tile)
    if (sampleOrder.count(tile) + vertexOrder.count(tile) > 0) tiles.push_back(tile);
  for (const uint32_t tile : tiles) requireOpen(tile);
  const bool byThreads = isLarge && tiles.size() >= kTilesForThreads;
  claimAll(byThreads, tiles, sampleOrder, [&](uint32_t tile) {
    return [&, tile](size_t i) -> const FrameSample& { return samples[sampleOrder.index(tile, i)]; };
  });
  forEach(byThreads, tiles.size(), [&](size_t t) {
    const size_t count = sampleOrder.count(tiles[t]);
    std::vector<FrameSample> sorted;
    if (!sampleOrder.isSorted())
      for (size_t i = 0; i < count; ++i) sorted.push_back(samples[sampleOrder.index(tiles[t], i)]);
    const ArrayView<const FrameSample> ofTile =
        sampleOrder.isSorted() && count > 0
            ? ArrayView<const FrameSample>(&samples[sampleOrder.index(tiles[t], 0)], count)
            : ArrayView<const FrameSample>(sorted);
    Order order = orderOf(vertices, vertexOrder.count(tiles[t]),
                          [&](size_t k) { return vertexOrder.index(tiles[t], k); });
    addToTile(tiles[t], ofTile, copyInOrder(vertices, std::move(order)));
  });
  m_notDue += vertices.size() - vertexOrder.size();
}

// The order in which `count` vertices of a tile are handed on, those at indexAt(0), indexAt(1), ...
template <class IndexAt>
TileCollector::Order TileCollector::orderOf(const VertexSource& vertices, size_t count,
                                            const IndexAt& indexAt) const {
  Order order;
  order.reserve(count);
  uint32_t pixel = ~0u, place = 0;
  for (size_t k = 0; k < count; ++k) {
    const size_t i = indexAt(k);
    const VertexIdentity v = vertices.identity(i);
    if (v.pixel != pixel) place = m_grid.placeInTile(pixel = v.pixel);
    order.emplace_back(uint64_t(place) << 48 | uint64_t(v.sample) << 16 | v.depth, i);
  }
  return order;
}

// Leaves out vertices that came before; returns how many. Depths of very long paths are cut off, and those of
// vertices without one are all 0.
uint64_t TileCollector::leaveOutTwice(Order& order) {
  const auto isSame = [](const auto& a, const auto& b) {
    const uint64_t depth = b.first & 0xffff;
    return a.first == b.first && depth != 0 && depth != 0xffff;
  };
  const auto end = std::unique(order.begin(), order.end(), isSame);
  const auto twice = uint64_t(order.end() - end);
  order.erase(end, order.end());
  return twice;
}

std::vector<PathVertex> TileCollector::copyInOrder(const VertexSource& vertices, Order order) {
  if (!std::is_sorted(order.begin(), order.end())) std::sort(order.begin(), order.end());
  std::vector<PathVertex> ordered;
  ordered.reserve(order.size());
  for (const auto& [key, i] : order) vertices.copy(i, ordered.emplace_back());
  return ordered;
}

void TileCollector::requireOpen(uint32_t tile) const {
  if (m_tiles[tile].done)
    throw std::logic_error("odisAddSamples: a sample came twice, or a vertex after all samples of its tile");
}

void TileCollector::addToTile(uint32_t index, ArrayView<const FrameSample> samples, TileVertices vertices) {
  assert(index < tileCount());
  Tile& tile = m_tiles[index];
  const std::lock_guard lock(tile.mutex);
  requireOpen(index);
  const bool nothingWaits = tile.samples.empty() && tile.vertices.empty();
  tile.done = !samples.empty() && tile.samples.size() + samples.size() == tile.claims.due().all;
  if (tile.done) {
    m_waitingBytes -= tile.claims.bytes();
    tile.claims.end();
  }
  if (tile.done && nothingWaits) return handOn(index, samples, vertices);
  const uint64_t bytes = samples.size() * sizeof(FrameSample) + vertices.size() * sizeof(PathVertex);
  tile.samples.insert(tile.samples.end(), samples.begin(), samples.end());
  if (tile.vertices.empty())
    tile.vertices = vertices.take();
  else
    tile.vertices.insert(tile.vertices.end(), vertices.view().begin(), vertices.view().end());
  m_waitingBytes += bytes;
  if (tile.done) handOnWaiting(index);
}

void TileCollector::handOnWaiting(uint32_t index) {
  const std::vector<FrameSample> samples = std::exchange(m_tiles[index].samples, {});
  const std::vector<PathVertex> vertices = std::exchange(m_tiles[index].vertices, {});
  m_waitingBytes -= samples.size() * sizeof(FrameSample) + vertices.size() * sizeof(PathVertex);
  // Lent: having grown, they hold more memory than they need.
  TileVertices lent(vertices);
  handOn(index, samples, lent);
}

void TileCollector::skip(const std::vector<uint8_t>& done) {
  for (uint32_t t = 0; t < tileCount(); ++t) m_tiles[t].done = done[t] != 0;
}

std::vector<uint8_t> TileCollector::done() const {
  std::vector<uint8_t> done;
  for (uint32_t t = 0; t < tileCount(); ++t) done.push_back(m_tiles[t].done);
  return done;
}

TileCollector::LeftOut TileCollector::endPass() {
  for (uint32_t t = 0; t < tileCount(); ++t) {
    Tile& tile = m_tiles[t];
    m_waitingBytes -= tile.claims.bytes();
    tile.claims.end();
    if (tile.samples.empty() && tile.vertices.empty()) continue;
    handOnWaiting(t);
  }
  return {m_notDue, m_twice};
}

void TileCollector::handOn(uint32_t tile, ArrayView<const FrameSample> samples, TileVertices& vertices) {
  // Sums over a pixel depend on the order of its own samples alone.
  bool inOrder = m_tiles[tile].claims.areInOrder();
  if (!inOrder) {
    uint32_t next[kTileSize * kTileSize] = {};
    uint32_t pixel = ~0u, place = 0;
    inOrder = true;
    for (const FrameSample& s : samples) {
      if (s.pixel != pixel) place = m_grid.placeInTile(pixel = s.pixel);
      inOrder = inOrder && s.sample >= next[place];
      next[place] = s.sample + 1;
    }
  }
  std::vector<FrameSample> orderedSamples;
  if (!inOrder) {
    orderedSamples.assign(samples.begin(), samples.end());
    std::sort(orderedSamples.begin(), orderedSamples.end(), [](const FrameSample& a, const FrameSample& b) {
      return std::tie(a.pixel, a.sample) < std::tie(b.pixel, b.sample);
    });
    samples = orderedSamples;
  }
  const VertexArray given(vertices.view());
  Order order = orderOf(given, given.size(), [](size_t k) { return k; });
  const bool isSorted = std::is_sorted(order.begin(), order.end());
  if (!isSorted) std::sort(order.begin(), order.end());
  const uint64_t twice = leaveOutTwice(order);
  if (isSorted && twice == 0) return m_sink(tile, samples, vertices);
  m_twice += twice;
  TileVertices ordered(copyInOrder(given, std::move(order)));
  m_sink(tile, samples, ordered);
}

}  // namespace odis::core
