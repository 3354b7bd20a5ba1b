#include "learn/data/folder_settings.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "learn/data/dataset.h"
#include "learn/scenes/generate.h"
#include "render/files/read_json.h"
#include "render/files/replace_file.h"

namespace odis::learn {

namespace fs = std::filesystem;

namespace {

constexpr const char* kAssets = "assets";

std::string settingsFile(const std::string& folder) {
  return (fs::path(folder) / "settings.json").string();
}

// What a folder says that its shards are made with; nothing if it does not say.
std::optional<nlohmann::json> readSettings(const std::string& folder) {
  const std::string path = settingsFile(folder);
  if (!fs::exists(path)) return {};
  try {
    const auto settings = render::readJson<nlohmann::json>(path);
    if (settings.is_object()) return settings;
  } catch (const render::ReadError& error) {
    throw ShardError(fmt::format("{}: cannot be read: {}", path, error.what()));
  }
  throw ShardError(fmt::format("{}: expected an object of settings", path));
}

// The options of `odis dataset generate` that give the settings, as far as there are such.
std::string optionsText(nlohmann::json settings) {
  if (!settings.is_object()) return "unknown settings";
  const std::string scenes = settings.contains(kAssets) ? "--seeds" : "--scenes";
  settings.erase(kAssets);
  const DataSettings none, quick = DataSettings::quick(), quality = DataSettings::quality();
  for (const auto& [candidate, options] :
       {std::pair(none, ""), {quick, " --quick"}, {quality, " --quality"}}) {
    if (settings == nlohmann::json(toJson(candidate))) return scenes + options;
    if (settings == nlohmann::json(toJson(candidate.incidentRadiance())))
      return scenes + options + " --kind incident-radiance";
  }
  return scenes + " and the settings " + settings.dump();
}

// `what` was made with `found`.
void expectSame(const std::string& folder, const std::string& what, const nlohmann::json& found,
                const nlohmann::json& expected) {
  if (found == expected) return;
  std::string before = optionsText(found), now = optionsText(expected);
  if (before == now) {
    before = "other --hdri, --textures or --furniture";
    now = "these";
  }
  throw GenerateError(
      fmt::format("{}: {} made with {}, not with {}: expected another folder, or the same options", folder,
                  what, before, now));
}

}  // namespace

nlohmann::ordered_json shardSettings(const DataSettings& settings, const Assets& assets, bool generated) {
  nlohmann::ordered_json made = toJson(settings);
  if (generated) made[kAssets] = assets.fingerprint();
  return made;
}

void checkFolder(const std::string& folder, const nlohmann::ordered_json& settings,
                 const std::vector<std::string>& names) {
  if (!fs::is_directory(folder)) return;
  if (fs::exists(fs::path(folder) / "checkpoint"))
    throw GenerateError(
        fmt::format("{}: holds a training (`odis train`), expected a folder for shards", folder));
  const std::optional<nlohmann::json> claimed = readSettings(folder);
  if (claimed) expectSame(folder, "by its settings.json, shards are", *claimed, settings);
  for (const std::string& name : claimed ? names : shardsIn(folder)) {
    const std::string path = shardFile(folder, name);
    if (!fs::exists(path)) continue;
    nlohmann::json header;
    try {
      header = ShardHeader(path).header();
    } catch (const ShardError&) {
      continue;  // damaged: that is said where it is to be made
    }
    expectSame(folder, name + ".shard is", header.value("settings", nlohmann::json()), settings);
  }
}

void claimFolder(const std::string& folder, const nlohmann::ordered_json& settings,
                 const std::vector<std::string>& names) {
  checkFolder(folder, settings, names);
  render::makeFolder(folder);
  if (!render::writeNewFile(settingsFile(folder), nlohmann::json(settings).dump(1) + "\n"))
    checkFolder(folder, settings, {});
}

nlohmann::json commonSettings(const std::vector<std::string>& folders) {
  nlohmann::json common;
  for (const std::string& folder : folders)
    for (const std::string& name : shardsIn(folder)) {
      const ShardHeader shard(shardFile(folder, name));
      const nlohmann::json settings = shard.header().value("settings", nlohmann::json());
      if (common.is_null()) common = settings;
      expectSame(folder, name + ".shard is", settings, common);
    }
  return common;
}

}  // namespace odis::learn
