// All examples of many shards in memory, and batches of them: a function of the shards, a seed and the step alone.
#pragma once

#include <string>
#include <vector>

#include "learn/train/examples.h"
#include "odis/features/cell_features.h"

namespace odis::learn {

// What a network that makes maps is given, and what it should have known: row by row, an example each.
struct DirectionBatch {
  size_t count = 0;
  std::vector<float> scalars;  // [count][kCellScalars]
  std::vector<float> basis;    // [count][kBasisMaps][texel]
  std::vector<float> there;    // [count][kBasisMaps]: 1 or 0
  // Of a diffuse surface with the cell's mean normal: what turns a share of radiance times cosine into radiance, and how
  // often the surface draws each texel.
  std::vector<float> perCosine, diffuse;  // [count][texel]
  std::vector<float> mass, square;        // [count][texel]: ViewExamples
};

class ExamplePool {
 public:
  // Keeps what it makes of shards in this folder, to find it there again.
  explicit ExamplePool(std::string folder) : m_folder(std::move(folder)) {}

  // Adds the examples of shards, in this order, by all cores. Throws ShardError, WriteError.
  void add(const std::vector<std::string>& shardFiles);
  // Examples that there is something to learn from.
  size_t size() const { return m_usable.size(); }

  // Tells one set of shards from another: a CRC-32 over theirs, in order.
  uint32_t fingerprint() const { return crc32(m_origins); }

  // `count` examples at random, drawn anew for each step. The pool must not be empty.
  void draw(uint64_t seed, uint64_t step, size_t count, double shiftProbability, DirectionBatch& batch) const;

 private:
  std::vector<ViewExamples> load(const std::string& shardFile, std::string& origin) const;

  std::string m_folder, m_origins;
  std::vector<ViewExamples> m_views;
  std::vector<std::pair<uint32_t, uint32_t>> m_usable;  // view and example
};

}  // namespace odis::learn
