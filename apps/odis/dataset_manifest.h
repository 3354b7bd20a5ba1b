// The manifest of a folder of shards, made and shown.
#pragma once

#include <string>
#include <vector>

#include "learn/data/dataset.h"

namespace odis::app {

// Shows how many shards are done, unless `quiet`.
learn::CountProgress countingOn(bool quiet);
// Prints complaints; kOk if there are none.
int complain(const std::vector<std::string>& complaints);

// Unpacks all shards of the folder, writes its manifest and prints what it holds. Without a manifest it
// ends if a shard is damaged or if one of `expected` is missing.
int collectManifest(const std::string& folder, const std::vector<learn::ShardSource>& expected, bool quiet);

}  // namespace odis::app
