#include "dataset_manifest.h"

#include <fmt/format.h>

#include <memory>

#include "command.h"
#include "console.h"
#include "counter.h"
#include "learn/data/dataset_info.h"

namespace odis::app {

learn::CountProgress countingOn(bool quiet) {
  if (quiet) return [](size_t, size_t) {};
  return [counter = std::shared_ptr<Counter>()](size_t, size_t total) mutable {
    if (!counter) counter = std::make_shared<Counter>(total, false);
    counter->done("shards read");
  };
}

int complain(const std::vector<std::string>& complaints) {
  for (const std::string& text : complaints) say(fmt::format("error: {}\n", text));
  return complaints.empty() ? kOk : kSceneError;
}

int collectManifest(const std::string& folder, const std::vector<learn::ShardSource>& expected, bool quiet) {
  learn::removeLeftOvers(folder);
  learn::FolderReport found = learn::describeShards(folder, countingOn(quiet));
  for (const std::string& name : learn::missingShards(expected, found.manifest))
    found.complaints.push_back(learn::shardFile(folder, name) + ": is missing");
  // A manifest of less than all would make the rest look as if it did not belong.
  if (const int code = complain(found.complaints); code != kOk) return code;
  learn::writeManifest(folder, found.manifest);
  fmt::print("{}", learn::datasetText(found.manifest));
  return kOk;
}

}  // namespace odis::app
