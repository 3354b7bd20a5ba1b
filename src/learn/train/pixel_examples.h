// What the network at pixels learns from (docs/training-pixels.md): for each target of a data set of incident
// radiance what each pilot saw around it, as the library describes it, and the map that really arrives.
#pragma once

#include <string>
#include <vector>

#include "learn/data/shard_file.h"
#include "learn/train/config.h"
#include "odis/pixels/neighbourhood.h"

namespace odis::learn {

inline constexpr size_t kPixelMapNumbers = size_t(kMapTexels) * core::kPixelChannels;

// Some examples, one after another. Texels row by row of the octahedral square.
struct PixelBatch {
  size_t count = 0;
  std::vector<float> maps;          // [count][channel][row][column]: the input
  std::vector<float> scalars;       // [count][kPixelScalars]
  std::vector<float> mass, square;  // [count][texel]: what arrives and its mean square, each over its sum
};

// The symmetries of the octahedral square that take texels to texels: of the directions' x and y axes, their
// exchange, and of the z axis. [symmetry][texel]: where the texel's value comes from.
inline constexpr int kMapSymmetries = 16;
const std::array<std::array<uint8_t, kMapTexels>, kMapSymmetries>& mapSymmetries();

class PixelExamples {
 public:
  // `histograms`: keeps what core::histogramOf() makes of each example, too.
  PixelExamples(const TrainConfig& config, bool histograms)
      : m_config(&config), m_keepHistograms(histograms) {}

  // Adds the examples of shards, in this order, by all cores. Throws ShardError.
  void add(const std::vector<std::string>& shardFiles);
  // Of targets; each has as many inputs as its view has pilots.
  size_t size() const { return m_targets.size(); }
  // Tells one set of shards from another.
  uint32_t fingerprint() const;
  uint64_t bytes() const;

  // `count` inputs at random, drawn anew for each step, turned by symmetries. There must be some.
  void draw(uint64_t seed, uint64_t step, size_t count, PixelBatch& batch) const;
  // The first input of targets [first, first + count), as they are.
  void take(size_t first, size_t count, PixelBatch& batch) const;
  // [texel], row by row, of a target's first input.
  std::vector<float> histogram(size_t target) const;

 private:
  struct Target {
    uint32_t firstInput, inputs;
  };
  // Those of a shard.
  struct Made {
    std::vector<Half> inputs;      // [input][kPixelMapNumbers + kPixelScalars], as core::describe() has them
    std::vector<Half> histograms;  // [input][texel]
    std::vector<Half> maps;        // [target][mass, square][texel]
    std::vector<uint32_t> inputsOf;  // [target]
    std::string origin;
  };
  Made make(const std::string& shardFile) const;
  void fill(size_t row, size_t target, uint32_t input, int symmetry, PixelBatch& batch) const;
  friend class PixelExampleMaker;

  const TrainConfig* m_config;
  bool m_keepHistograms;
  std::vector<Half> m_inputs, m_histograms, m_maps;
  std::vector<Target> m_targets;
  std::string m_origins;
};

}  // namespace odis::learn
