// What all shards of a folder have in common: how they are made.
#pragma once

#include <string>
#include <vector>

#include "learn/data/make_shard.h"

namespace odis::learn {

// The settings as headers of shards have them: of generated scenes with what is drawn from folders.
nlohmann::ordered_json shardSettings(const DataSettings& settings, const Assets& assets, bool generated);

// Throws GenerateError if the folder holds a shard that was made in another way, or is to hold such ones by
// its settings.json, or is a training's; ShardError if that file can't be read. Where there is a
// settings.json, the shards of `names` alone are looked into.
void checkFolder(const std::string& folder, const nlohmann::ordered_json& settings,
                 const std::vector<std::string>& names);
// The same, and from now on the folder takes no shards but those: settings.json says so. Of processes that
// begin at once with different settings one succeeds. Throws WriteError, too.
void claimFolder(const std::string& folder, const nlohmann::ordered_json& settings,
                 const std::vector<std::string>& names);
// The settings that all shards of the folders were made with; null if there is no shard. Throws GenerateError
// if they were not made alike, ShardError.
nlohmann::json commonSettings(const std::vector<std::string>& folders);

}  // namespace odis::learn
