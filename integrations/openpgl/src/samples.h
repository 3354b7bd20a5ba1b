// What paths have brought since a field was last updated.
#pragma once

#include <odis/odis.hpp>

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

#include "openpgl/openpgl.h"

// Decides by a path's number whether the path is kept: one path in 2^halvings is. A storage shares it with the paths
// under way, so that no vertices are made of paths that it would drop.
class Thinning {
 public:
  bool keeps(uint64_t number) const { return (number & ((uint64_t(1) << m_halvings) - 1)) == 0; }
  void halve() { ++m_halvings; }
  bool isOver() const { return m_halvings >= 63; }
  void forget() { m_halvings = 0; }

 private:
  std::atomic<uint32_t> m_halvings{0};
};

// The type behind Open PGL's handle. Any thread may add; what is kept does not depend on the order. About
// kMostVertices are kept at most (188 bytes each), or as many as a field asks for: of more, paths are left out.
struct SampleStorage {
 public:
  static constexpr size_t kMostVertices = size_t(1) << 19;

  void add(odis::ArrayView<const odis::PathVertex> path);
  void add(const PGLSampleData& sample);
  void add(const PGLZeroValueSampleData& sample);
  void clear();

  // The number of vertices, and of those in volumes.
  size_t size() const { return m_count; }
  size_t inVolumes() const { return m_inVolumes; }
  // From the next sample on.
  void keepAtMost(size_t vertices) { m_most = vertices < kMostVertices ? vertices : kMostVertices; }
  std::shared_ptr<const Thinning> thinning() const { return m_thinning; }
  // All vertices, path after path in the order of the paths' numbers; until the next call.
  odis::ArrayView<const odis::PathVertex> vertices();
  // What they say of radiance that arrives.
  std::vector<PGLSampleData> samples();

 private:
  // Paths one after another, in blocks that stay where they are: memory that grows by copying costs as much as all
  // that is recorded.
  class Paths {
   public:
    struct Path {
      uint64_t number;
      odis::ArrayView<const odis::PathVertex> vertices;
    };
    void add(uint64_t number, odis::ArrayView<const odis::PathVertex> vertices);
    void clear();
    // Removes the paths that are not kept; returns the number of their vertices, and of those in volumes.
    std::array<size_t, 2> thinOut(const Thinning& thinning);
    const std::vector<Path>& all() const { return m_paths; }

   private:
    // Returns contiguous memory for this many vertices.
    odis::PathVertex* makeRoom(size_t vertices);

    struct Block {
      std::unique_ptr<odis::PathVertex[]> vertices;
      size_t size = 0, capacity = 0;
    };
    std::vector<Block> m_blocks;
    size_t m_current = 0;
    std::vector<Path> m_paths;
  };
  // Threads add to different shards, mostly.
  struct Shard {
    std::mutex mutex;
    Paths paths;
  };
  Shard& ofThisThread();
  void thinOut();

  std::array<Shard, 64> m_shards;
  std::atomic<size_t> m_count{0}, m_inVolumes{0}, m_most{kMostVertices};
  std::shared_ptr<Thinning> m_thinning = std::make_shared<Thinning>();
  std::mutex m_thinningMutex;
  std::vector<odis::PathVertex> m_sorted;
};
