// Data sets: folders of shards, made by any number of processes, and the manifest that says what belongs to
// one.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "learn/data/make_shard.h"

namespace odis::learn {

// The generated scenes of these seeds, both included.
std::vector<ShardSource> seedSources(uint64_t first, uint64_t last);
// The scenes of a folder: its sub-folders with a scene.xml. Those that odis made have their seeds, others
// those of their names. Throws GenerateError if there is none.
std::vector<ShardSource> folderSources(const std::string& folder);
// The parts from `first` to `last`, counted from 1, of all sources cut into `count` parts as even as can be.
std::vector<ShardSource> partOf(const std::vector<ShardSource>& sources, int first, int last, int count);

// Told of every shard, from any thread but never two at once.
class ShardObserver {
 public:
  virtual ~ShardObserver() = default;
  virtual void done(const ShardSource& source, bool made) = 0;
  virtual void failed(const ShardSource& source, const std::string& why) = 0;
  virtual bool cancelled() const { return false; }
};

// Makes all shards that are not there, in any order, `jobs` at a time, each by one thread. A scene that
// can't be used fails alone. Throws WriteError, after which nothing new begins.
void makeShards(const std::vector<ShardSource>& sources, const DataSettings& settings, const Assets& assets,
                const std::string& folder, int jobs, ShardObserver& observer);

// The shards of a folder, by name.
std::vector<std::string> shardsIn(const std::string& folder);

// What a folder holds, and what there is to complain about.
struct FolderReport {
  nlohmann::ordered_json manifest;
  std::vector<std::string> complaints;  // each names the file
};
// Called with how many shards are done, from any thread but never two at once.
using CountProgress = std::function<void(size_t done, size_t total)>;

// Puts the shards of other folders into this one: linked where that can be done, else copied. Throws
// WriteError, and ShardError if two of them have the same name and are not the same.
void gatherShards(const std::vector<std::string>& folders, const std::string& into,
                  const CountProgress& progress);
// Removes half-made files of shards that are there: those of killed processes, and those of processes on
// any machine that make the same shard in vain (makeShard).
void removeLeftOvers(const std::string& folder);
// Reads and unpacks all shards of a folder and describes them in a manifest. Shards that are damaged or
// were made with other settings than the first are complained about, and left out.
FolderReport describeShards(const std::string& folder, const CountProgress& progress);
// Compares the shards with the folder's manifest: size and CRC-32, too few and too many, files left
// half-made. Throws ShardError if there is no manifest.
FolderReport checkShards(const std::string& folder, const CountProgress& progress);

// Throws ShardError if there is none or if it is not one.
nlohmann::ordered_json readManifest(const std::string& folder);
// Throws WriteError.
void writeManifest(const std::string& folder, const nlohmann::ordered_json& manifest);
// The names of the sources that the manifest has no shard of.
std::vector<std::string> missingShards(const std::vector<ShardSource>& sources,
                                       const nlohmann::ordered_json& manifest);

}  // namespace odis::learn
