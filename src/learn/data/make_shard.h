// From a scene to the shard of the data set that holds its views.
#pragma once

#include <optional>
#include <string>

#include "learn/data/windows.h"
#include "learn/scenes/kinds.h"

namespace odis::learn {

struct DataSettings {
  int pixels = 14400;  // of a view, about; four pilots are as many paths as that of an image of 640 x 360
  int pilots = 4;
  TargetSettings targets;
  WindowSettings windows;  // of a data set of incident radiance; none in one of cells

  static DataSettings quick();    // for tests and a first look
  static DataSettings quality();  // as many pixels as one renders, more targets, smoother ones
  // These settings for the other kind of data set: reference maps of incident radiance at pixels, and pilots
  // of what is around them.
  DataSettings incidentRadiance() const;
};
// As it stands in shards and manifests.
nlohmann::ordered_json toJson(const DataSettings& settings);

// A scene is on one side by a hash of its seed, with all that is made of it: nine of ten to learn from, the
// others to validate. Scenes that have no seed have a hash of their name in its place.
enum class Split { train, validation };
Split splitOf(uint64_t seed);
const char* splitName(Split split);
uint64_t seedOfName(const std::string& name);

// What a shard is made of: the seed of a scene to be generated, or a folder with one.
struct ShardSource {
  std::string name;  // the shard's file is NAME.shard
  uint64_t seed = 0;
  const Kind* kind = nullptr;  // null: from the folder
  std::string folder;          // with a scene.xml and maybe a scene-b.xml
};
std::string shardFile(const std::string& folder, const std::string& name);

// What the generator says of the scene in a folder; an empty object if it did not make it.
nlohmann::ordered_json sceneJson(const std::string& folder);

// Makes the shard in the folder, unless it is there, or another process was quicker: a function of source,
// settings and assets. Returns whether it was made. Throws SceneError, GenerateError (another shard of that
// name is there), WriteError.
bool makeShard(const ShardSource& source, const DataSettings& settings, const Assets& assets,
               const std::string& folder);

// Removes what processes of this machine left half-made that were killed: in the folder, and among
// temporary files.
void removeAbandoned(const std::string& folder);

// The frame of a view of a shard, by its header. Throws ShardError.
ViewFrame viewFrame(const ShardReader& shard, size_t view);
// The pilots of a view, as many as its header says. Throws ShardError, nlohmann::json::exception.
std::vector<Pilot> readPilots(const ShardReader& shard, size_t view);
// What the names of a view's arrays begin with, and those of one of its pilots or its targets.
std::string pilotPrefix(size_t view, size_t pilot);
std::string targetPrefix(size_t view);

}  // namespace odis::learn
