// The manifest of a data set: made from its shards, and compared with them.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <mutex>
#include <set>

#include "learn/data/dataset.h"
#include "render/files/read_json.h"
#include "render/files/replace_file.h"

namespace odis::learn {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

constexpr int kManifestFormat = 1;
constexpr const char* kManifestName = "manifest.json";

// Calls visit(i) for every number below `count`, many at once, and reports those that are done.
template <class Visit>
void forAll(size_t count, const CountProgress& progress, const Visit& visit) {
  std::mutex mutex;
  size_t done = 0;
  tbb::parallel_for(size_t(0), count, [&](size_t i) {
    visit(i);
    const std::lock_guard lock(mutex);
    progress(++done, count);
  });
}

std::string crcText(const std::string& bytes) {
  return fmt::format("{:08x}", crc32(bytes));
}

// What the manifest says of a shard, but for its settings.
Json describe(const ShardReader& shard, const std::string& bytes) {
  const nlohmann::json& header = shard.header();
  uint64_t vertices = 0, targets = 0, pixels = 0;
  const nlohmann::json& views = header.at("views");
  for (size_t view = 0; view < views.size(); ++view) {
    pixels += render::wholeNumber(views[view].at("width")) * render::wholeNumber(views[view].at("height"));
    targets += render::wholeNumber(views[view].at("targets"));
    for (size_t pilot = 0; pilot < render::wholeNumber(views[view].at("pilots")); ++pilot)
      vertices += shard.shape(pilotPrefix(view, pilot) + "pdf").at(0);
  }
  return {{"name", header.at("name")},   {"seed", header.at("seed")},
          {"split", header.at("split")}, {"kind", header.at("scene").value("kind", "")},
          {"views", views.size()},       {"pixels", pixels},
          {"vertices", vertices},        {"targets", targets},
          {"bytes", bytes.size()},       {"crc32", crcText(bytes)}};
}

ShardError noFolder(const std::string& folder) {
  return ShardError(fmt::format("{}: there is no such folder", folder));
}

fs::directory_iterator entriesOf(const std::string& folder) {
  if (!fs::is_directory(folder)) throw noFolder(folder);
  return fs::directory_iterator(folder);
}

// Files of shards that were never finished.
std::vector<std::string> halfMade(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : entriesOf(folder))
    if (entry.path().filename().string().find(".shard.part-") != std::string::npos)
      names.push_back(entry.path().string());
  return names;
}

// The shard that a half-made file would have become.
std::string wholeOf(const std::string& half) {
  return half.substr(0, half.rfind(".part-"));
}

std::string whatIsWrong(const std::string& path, const std::string& bytes) {
  try {
    ShardReader(path, bytes).verify();
  } catch (const ShardError& e) {
    return e.what();
  }
  return fmt::format("{}: is another shard than the manifest's", path);
}

}  // namespace

std::vector<std::string> shardsIn(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : entriesOf(folder))
    if (entry.path().extension() == ".shard") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

void gatherShards(const std::vector<std::string>& folders, const std::string& into,
                  const CountProgress& progress) {
  std::vector<std::pair<std::string, std::string>> files;
  for (const std::string& folder : folders)
    for (const std::string& name : shardsIn(folder)) files.emplace_back(folder, name);
  size_t done = 0;
  for (const auto& [folder, name] : files) {
    const std::string from = shardFile(folder, name), to = shardFile(into, name);
    std::error_code error;
    if (fs::exists(to)) {
      if (!fs::equivalent(from, to, error) && shardBytes(from) != shardBytes(to))
        throw ShardError(fmt::format("{} and {} have the same name and are not the same", from, to));
    } else {
      fs::create_hard_link(fs::canonical(from), to, error);
      if (error) render::writeFile(to, shardBytes(from));
    }
    progress(++done, files.size());
  }
}

void removeLeftOvers(const std::string& folder) {
  std::error_code ignored;
  for (const std::string& half : halfMade(folder))
    if (fs::exists(wholeOf(half))) fs::remove(half, ignored);
}

FolderReport describeShards(const std::string& folder, const CountProgress& progress) {
  const std::vector<std::string> names = shardsIn(folder);
  std::vector<Json> shards(names.size());
  std::vector<nlohmann::json> settings(names.size());
  std::vector<std::string> software(names.size()), faults(names.size());
  forAll(names.size(), progress, [&](size_t i) {
    const std::string path = shardFile(folder, names[i]);
    try {
      const std::string bytes = shardBytes(path);
      const ShardReader shard(path, bytes);
      shard.verify();
      shards[i] = describe(shard, bytes);
      settings[i] = shard.header().at("settings");
      shard.header().at("software").get_to(software[i]);
    } catch (const nlohmann::json::exception& e) {
      faults[i] = fmt::format("{}: the header is not as expected: {}", path, render::jsonReason(e));
    } catch (const std::exception& e) {
      faults[i] = e.what();
    }
  });

  FolderReport result;
  Json all = Json::array();
  std::set<std::string> versions;
  const nlohmann::json* common = nullptr;
  for (size_t i = 0; i < names.size(); ++i) {
    if (!faults[i].empty()) {
      result.complaints.push_back(faults[i]);
      continue;
    }
    if (!common) common = &settings[i];
    if (settings[i] != *common) {
      result.complaints.push_back(fmt::format("{}: was made with other settings than the others: {}",
                                              shardFile(folder, names[i]), settings[i].dump()));
      continue;
    }
    versions.insert(software[i]);
    all.push_back(std::move(shards[i]));
  }
  result.manifest = {{"format", kManifestFormat},
                     {"software", versions},
                     {"settings", common ? Json(*common) : Json::object()},
                     {"shards", std::move(all)}};
  return result;
}

FolderReport checkShards(const std::string& folder, const CountProgress& progress) {
  FolderReport result;
  result.manifest = readManifest(folder);
  const Json& shards = result.manifest.at("shards");
  std::vector<std::string> faults(shards.size());
  std::set<std::string> known;
  for (const Json& shard : shards) known.insert(shard.at("name").get<std::string>());
  forAll(shards.size(), progress, [&](size_t i) {
    const std::string path = shardFile(folder, shards[i].at("name"));
    const auto size = render::wholeNumber(shards[i].at("bytes"));
    if (!fs::exists(path)) {
      faults[i] = fmt::format("{}: is missing", path);
      return;
    }
    try {
      const std::string bytes = shardBytes(path);
      if (bytes.size() != size)
        faults[i] = fmt::format("{}: found {} bytes, expected {}", path, bytes.size(), size);
      else if (crcText(bytes) != shards[i].at("crc32").get<std::string>())
        faults[i] = whatIsWrong(path, bytes);
    } catch (const ShardError& e) {
      faults[i] = e.what();
    }
  });
  for (std::string& fault : faults)
    if (!fault.empty()) result.complaints.push_back(std::move(fault));
  for (const std::string& name : shardsIn(folder))
    if (!known.contains(name))
      result.complaints.push_back(fmt::format("{}: is not in the manifest", shardFile(folder, name)));
  for (const std::string& path : halfMade(folder))
    result.complaints.push_back(fmt::format("{}: was left half-made, or is being made", path));
  return result;
}

nlohmann::ordered_json readManifest(const std::string& folder) {
  const std::string path = (fs::path(folder) / kManifestName).string();
  if (!fs::exists(folder)) throw noFolder(folder);
  if (!fs::exists(path))
    throw ShardError(
        fmt::format("{}: there is no manifest; \"odis dataset merge {}\" makes it", path, folder));
  Json manifest;
  try {
    manifest = render::readJson<Json>(path);
  } catch (const render::ReadError& error) {
    throw ShardError(fmt::format("{}: cannot be read: {}", path, error.what()));
  }
  const auto isShard = [](const Json& shard) {
    return shard.is_object() && shard.contains("name") && shard["name"].is_string() &&
           shard.contains("bytes") && shard["bytes"].is_number_unsigned() && shard.contains("crc32") &&
           shard["crc32"].is_string();
  };
  if (!manifest.is_object() || manifest.value("format", Json()) != kManifestFormat ||
      !manifest.contains("shards") || !manifest["shards"].is_array() ||
      !std::all_of(manifest["shards"].begin(), manifest["shards"].end(), isShard))
    throw ShardError(fmt::format("{}: is no manifest of format {}", path, kManifestFormat));
  return manifest;
}

// A line a shard, so that it can be read and compared line by line.
void writeManifest(const std::string& folder, const nlohmann::ordered_json& manifest) {
  constexpr auto kReplace = Json::error_handler_t::replace;
  std::string text = "{\n";
  for (const auto& [key, value] : manifest.items()) {
    if (key == "shards") continue;
    text += fmt::format(" \"{}\": {},\n", key, value.dump(-1, ' ', false, kReplace));
  }
  text += " \"shards\": [";
  const char* separator = "\n";
  for (const Json& shard : manifest.at("shards")) {
    text += separator + ("  " + shard.dump(-1, ' ', false, kReplace));
    separator = ",\n";
  }
  text += "\n ]\n}\n";
  render::writeFile((fs::path(folder) / kManifestName).string(), text);
}

std::vector<std::string> missingShards(const std::vector<ShardSource>& sources,
                                       const nlohmann::ordered_json& manifest) {
  std::set<std::string> there;
  for (const Json& shard : manifest.at("shards")) there.insert(shard.at("name").get<std::string>());
  std::vector<std::string> missing;
  for (const ShardSource& source : sources)
    if (!there.contains(source.name)) missing.push_back(source.name);
  return missing;
}

}  // namespace odis::learn
