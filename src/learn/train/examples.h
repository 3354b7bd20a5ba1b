// What networks learn from: for each target of a shard the statistics of its cell and of those around it,
// as pilots of several sizes make them, and what should have been known.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "learn/data/shard_file.h"
#include "odis/cells/statistics.h"

namespace odis::learn {

// Statistics as they are kept: what CellStatistics has beside its arrays.
struct KeptStatistics {
  float level = 0, count = 0, sum = 0, sumSquares = 0, normal[3] = {};
};
inline constexpr size_t kKeptNumbers = sizeof(KeptStatistics) / sizeof(float);

// How many pilots of a view the inputs are made from: one, two, all of them.
inline constexpr int kInputVariants = 3;

// The examples of a view, one after the other. Radiance is in units of the view's mean luminance.
struct ViewExamples {
  size_t count = 0;   // of examples
  size_t groups = 0;  // of lights

  // For each variant and example: its chain, finest first. A level that is not there has a count of zero.
  std::vector<KeptStatistics> statistics;  // [variant][example][level]
  std::vector<Half> histograms;            // [variant][example][level][texel], with the sum 1 or 0
  std::vector<Half> around;                // [variant][example][first level: 0, 1][2][texel], likewise
  std::vector<float> lightSquares;         // [variant][example][level][group], sums

  // What arrives at a cell and next-event estimation does not cover, times the cosine: its mean and its
  // mean square for each texel. Over their sums.
  std::vector<Half> mass, square;  // [example][texel]
  // What next-event estimation that chooses the group gives: root of the mean square; probability of the
  // group if nothing is learned.
  std::vector<float> lightRms, lightProbability;  // [example][group]

  // The chain of an example, `storage` holding what it points to. With `shift` it begins at the parent.
  struct Storage {
    std::array<core::CellStatistics, kCellLevels> cells;
    core::Surroundings around;
  };
  core::CellChain chain(int variant, size_t example, bool shift, Storage& storage) const;
};

// The examples of each view of a shard. Throws ShardError.
std::vector<ViewExamples> makeExamples(const ShardReader& shard);

// Examples as arrays of a file of their own.
void addColumns(ShardWriter& writer, const std::string& prefix, const ViewExamples& examples);
ViewExamples readExamples(const ShardReader& reader, const std::string& prefix);

}  // namespace odis::learn
