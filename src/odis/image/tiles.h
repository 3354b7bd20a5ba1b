// Brings what hosts deliver, in any order and in portions of any size, into one order: tile by tile.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "odis/image/tile_claims.h"
#include "odis/image/tile_order.h"
#include "odis/image/tile_vertices.h"
#include "odis/record/vertex_source.h"
#include "odis/tiles.h"
#include "odis/work/tasks.h"

namespace odis::core {

using SampleRange = OdisSampleRange;
using FrameSample = OdisFrameSample;

// Collects the samples of a pass.
class TileCollector {
 public:
  // Called once for each tile that has samples, by any thread: a pixel's samples in the order of their
  // numbers, vertices in the order of pixel, sample, depth.
  using Sink = std::function<void(uint32_t tile, ArrayView<const FrameSample>, TileVertices&)>;
  // The samples of a pixel that are due in the pass.
  using Due = std::function<SampleRange(uint32_t pixel)>;

  // Collects for an image of this size with these tiles. The tiles of a large call are shared out as `tasks`;
  // null: they are taken one after another.
  explicit TileCollector(const TileGrid& grid, std::shared_ptr<const Tasks> tasks = nullptr);
  uint32_t tileCount() const { return m_grid.tileCount(); }

  void beginPass(Due due, Sink sink);
  // Thread-safe. Throws std::out_of_range for samples that are not due, std::logic_error for samples that
  // come twice and for vertices of a tile that is complete; nothing is taken then.
  void add(ArrayView<const FrameSample> samples, const VertexSource& vertices);
  // How many samples have not come yet.
  uint64_t missing() const;
  // Vertices that were left out: because their samples are not due, or because they came before.
  struct LeftOut {
    uint64_t notDue = 0, twice = 0;
  };
  // Hands on the tiles that lack samples.
  LeftOut endPass();

  // Whether all samples of a pixel's tile are in.
  bool isDone(uint32_t pixel) const { return m_tiles[m_grid.tileOf(pixel)].done; }
  // Takes tiles as done whose samples are in already.
  void skip(const std::vector<uint8_t>& done);
  // [tile] which are.
  std::vector<uint8_t> done() const;

  // What waits for the rest of its tile.
  uint64_t bytes() const { return m_waitingBytes; }

 private:
  // What waits for the rest of its tile.
  struct Tile {
    std::mutex mutex;
    std::vector<FrameSample> samples;
    std::vector<PathVertex> vertices;
    TileClaims claims;  // without samples that are due: not counted yet
    std::atomic<bool> done{false};
  };
  // What vertices are sorted by: first a number made of pixel, sample and depth, then the index at which they
  // came.
  using Order = std::vector<std::pair<uint64_t, size_t>>;
  SamplesDue samplesDue(uint32_t tile) const;
  bool allIn(uint32_t tile, ArrayView<const FrameSample> samples, ArrayView<const PathVertex> vertices) const;
  template <class Body>
  void forEach(bool byThreads, size_t count, const Body& body) const;
  template <class IdentityAt>
  std::vector<uint32_t> tilesOf(bool byThreads, size_t count, const IdentityAt& identityAt) const;
  template <class IndexAt>
  Order orderOf(const VertexSource& vertices, size_t count, const IndexAt& indexAt) const;
  static uint64_t leaveOutTwice(Order& order);
  static std::vector<PathVertex> copyInOrder(const VertexSource& vertices, Order order);
  void requireOpen(uint32_t tile) const;
  template <class SampleAt>
  struct SlotsOf;
  template <class SampleAt>
  size_t claim(uint32_t tile, size_t count, const SampleAt& sampleAt);
  template <class SampleAtOf>
  void claimAll(bool byThreads, ArrayView<const uint32_t> tiles, const TileOrder& order,
                const SampleAtOf& sampleAtOf);
  void addTiles(ArrayView<const FrameSample> samples, const VertexSource& vertices);
  void addToTile(uint32_t tile, ArrayView<const FrameSample> samples, TileVertices vertices);
  void handOnWaiting(uint32_t tile);
  void handOn(uint32_t tile, ArrayView<const FrameSample> samples, TileVertices& vertices);

  TileGrid m_grid;
  Due m_due;
  Sink m_sink;
  std::unique_ptr<Tile[]> m_tiles;
  std::shared_ptr<const Tasks> m_tasks;
  std::atomic<uint64_t> m_notDue{0}, m_twice{0};
  std::atomic<uint64_t> m_waitingBytes{0};
};

}  // namespace odis::core
