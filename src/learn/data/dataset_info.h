// What a data set holds, in words.
#pragma once

#include <string>

#include "learn/data/shard_header.h"

namespace odis::learn {

// Scenes, views, vertices, targets and bytes, by split and by kind. Throws nlohmann::json::exception for
// what is no manifest.
std::string datasetText(const nlohmann::ordered_json& manifest);
// The scene of a shard, its views, and how many bytes each group of arrays takes. Throws ShardError.
std::string shardText(const ShardHeader& shard);

}  // namespace odis::learn
