// All examples of many shards in memory, and batches of them: a function of the shards, a seed and the step
// alone.
#pragma once

#include <string>
#include <vector>

#include "learn/train/examples.h"
#include "odis/models/direction_features.h"
#include "odis/models/light_features.h"

namespace odis::learn {

// What a network that makes maps is given, and what it should have known: row by row, an example each.
struct DirectionBatch {
  size_t count = 0;
  std::vector<float> scalars;  // [count][kCellScalars]
  std::vector<float> basis;    // [count][kBasisMaps][texel]
  std::vector<float> there;    // [count][kBasisMaps]: 1 or 0
  // Of a diffuse surface with the cell's mean normal: what turns a share of radiance times cosine into
  // radiance, and how often the surface draws each texel.
  std::vector<float> inverseCosine, diffuse;  // [count][texel]
  std::vector<float> mass, square;            // [count][texel]: ViewExamples
};

// The same for a network that chooses among groups of lights.
struct LightBatch {
  size_t count = 0;
  std::vector<float> pairs;        // [count][group][kPairFeatures]
  std::vector<float> formula;      // [count][group]: shares; zero of groups that are not there
  std::vector<float> rms;          // [count][group]: ViewExamples::lightRms, over their sum
  std::vector<float> probability;  // [count][group]: if nothing is learned
};

class ExamplePool {
 public:
  // Keeps what it makes of shards in this folder, to find it there again.
  explicit ExamplePool(std::string folder) : m_folder(std::move(folder)) {}

  // Adds the examples of shards, in this order, by all cores. Throws ShardError, WriteError.
  void add(const std::vector<std::string>& shardFiles);
  // Examples that there is something to learn from.
  size_t size() const { return m_usable.size(); }
  // Those of them where there are several groups of lights and one gives something.
  size_t lightSize() const { return m_lit.size(); }

  // Tells one set of shards from another: a CRC-32 over their headers, in order.
  uint32_t fingerprint() const { return crc32(m_origins); }

  // `count` examples at random, drawn anew for each step. The pool must not be empty.
  void draw(uint64_t seed, uint64_t step, size_t count, double shiftProbability, DirectionBatch& batch) const;
  // The same of examples with lights, of which there must be some.
  void draw(uint64_t seed, uint64_t step, size_t count, LightBatch& batch) const;

 private:
  std::vector<ViewExamples> load(const std::string& shardFile, std::string& origin) const;

  std::string m_folder, m_origins;
  std::vector<ViewExamples> m_views;
  using Place = std::pair<uint32_t, uint32_t>;  // view and example
  std::vector<Place> m_usable, m_lit;
};

}  // namespace odis::learn
