// What paths have brought since a field was last updated.
#pragma once

#include <odis/odis.hpp>

#include <array>
#include <atomic>
#include <mutex>
#include <vector>

#include "openpgl/openpgl.h"

// The type behind Open PGL's handle. Any thread may add; what is kept does not depend on the order. About
// kMostVertices are kept at most (188 bytes each): of more, paths are left out by their numbers.
struct SampleStorage {
 public:
  static constexpr size_t kMostVertices = size_t(1) << 21;

  void add(odis::ArrayView<const odis::PathVertex> path);
  void add(const PGLSampleData& sample);
  void add(const PGLZeroValueSampleData& sample);
  void clear();

  // The number of vertices.
  size_t size() const { return m_count; }
  // All vertices, path after path in the order of the paths' numbers.
  std::vector<odis::PathVertex> vertices();
  // What they say of radiance that arrives.
  std::vector<PGLSampleData> samples();

 private:
  // The vertices of a path in its shard.
  struct Path {
    uint64_t number;
    uint32_t begin, count;
  };
  // Threads add to different shards, mostly.
  struct Shard {
    std::mutex mutex;
    std::vector<odis::PathVertex> vertices;
    std::vector<Path> paths;
  };
  Shard& ofThisThread();
  bool keeps(uint64_t number) const;
  void thinOut();
  size_t removeFrom(Shard& shard) const;

  std::array<Shard, 64> m_shards;
  std::atomic<size_t> m_count{0};
  std::atomic<uint32_t> m_thinning{0};  // of 2 to the power of this many paths one is kept
  std::mutex m_thinningMutex;
};
