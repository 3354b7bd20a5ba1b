#include "learn/data/dataset_info.h"

#include <fmt/format.h>

#include <map>

#include "render/files/read_json.h"

namespace odis::learn {

namespace {

// Sums over shards.
struct Totals {
  uint64_t scenes = 0, views = 0, vertices = 0, targets = 0, bytes = 0;
  void add(const nlohmann::ordered_json& shard) {
    ++scenes;
    views += render::wholeNumber(shard.at("views"));
    vertices += render::wholeNumber(shard.at("vertices"));
    targets += render::wholeNumber(shard.at("targets"));
    bytes += render::wholeNumber(shard.at("bytes"));
  }
};

std::string row(const std::string& name, const Totals& t) {
  return fmt::format("{:<14}{:>8}{:>8}{:>14}{:>11}{:>12.1f}{:>13.2f}\n", name, t.scenes, t.views, t.vertices,
                     t.targets, double(t.bytes) / 1e6,
                     t.views > 0 ? double(t.bytes) / 1e6 / double(t.views) : 0.0);
}

}  // namespace

std::string datasetText(const nlohmann::ordered_json& manifest) {
  Totals all;
  std::map<std::string, Totals> splits, kinds;
  for (const nlohmann::ordered_json& shard : manifest.at("shards")) {
    all.add(shard);
    splits[shard.at("split").get<std::string>()].add(shard);
    kinds[shard.at("kind").get<std::string>()].add(shard);
  }
  std::string text = fmt::format("{:<14}{:>8}{:>8}{:>14}{:>11}{:>12}{:>13}\n", "", "scenes", "views",
                                 "vertices", "targets", "MB", "MB a view");
  text += row("all", all);
  for (const auto& [name, totals] : splits) text += row(name, totals);
  if (kinds.size() > 1)
    for (const auto& [name, totals] : kinds) text += row("  " + (name.empty() ? "(others)" : name), totals);
  return text;
}

std::string shardText(const ShardHeader& shard) {
  const nlohmann::json& header = shard.header();
  std::string text;
  try {
    text += fmt::format("{}: {}, split {}, by {}\n", header.at("name").get<std::string>(),
                        header.at("scene").value("kind", "a scene of its own"),
                        header.at("split").get<std::string>(), header.at("software").get<std::string>());
    for (const nlohmann::json& view : header.at("views"))
      text += fmt::format("{}: {} x {} pixels, {} pilots, {} targets, {} groups of lights\n",
                          view.at("file").get<std::string>(), render::wholeNumber(view.at("width")),
                          render::wholeNumber(view.at("height")), render::wholeNumber(view.at("pilots")),
                          render::wholeNumber(view.at("targets")), view.at("lightGroups").size());
  } catch (const nlohmann::json::exception& e) {
    throw ShardError(
        fmt::format("{}: the header is not as expected: {}", shard.path(), render::jsonReason(e)));
  }
  // Arrays of the same name, whichever view and pilot they are of.
  std::map<std::string, uint64_t> bytes;
  for (const auto& [name, size] : shard.arrays()) {
    const bool target = name.find("/target/") != std::string::npos;
    bytes[(target ? "target/" : "pilot/") + name.substr(name.rfind('/') + 1)] += size;
  }
  for (const auto& [name, size] : bytes) text += fmt::format("{:<30}{:>12} B\n", name, size);
  return text;
}

}  // namespace odis::learn
