// odis dataset: generate, merge, check, info, preview
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>

#include "command.h"
#include "console.h"
#include "dataset_generate.h"
#include "dataset_manifest.h"
#include "dataset_preview.h"
#include "dataset_range.h"
#include "learn/data/dataset.h"
#include "learn/data/dataset_info.h"
#include "learn/data/folder_settings.h"
#include "render/files/read_json.h"
#include "validators.h"

namespace odis::app {

namespace {

struct DatasetArguments {
  std::string folder, output, seeds;
  std::vector<std::string> folders;
  bool json = false, quiet = false;
};

int merge(const DatasetArguments& a) {
  std::string folder = a.output;
  if (folder.empty()) {
    if (a.folders.size() > 1) throw UsageError("several folders are merged into another one: expected -o");
    folder = a.folders.front();
  } else {
    const nlohmann::json settings = learn::commonSettings(a.folders);
    if (settings.is_null()) throw UsageError("there are no shards to merge");
    learn::claimFolder(folder, settings, {});
    learn::gatherShards(a.folders, folder, countingOn(a.quiet));
  }
  if (a.seeds.empty()) return collectManifest(folder, {}, a.quiet);
  const Range seeds = parseRange("--seeds", a.seeds, kSeed);
  return collectManifest(folder, learn::seedSources(seeds.first, seeds.last), a.quiet);
}

int check(const DatasetArguments& a) {
  const learn::FolderReport found = learn::checkShards(a.folder, countingOn(a.quiet));
  if (const int code = complain(found.complaints); code != kOk) {
    say(fmt::format("error: {} faults\n", found.complaints.size()));
    return code;
  }
  fmt::print("{} shards are as the manifest says\n", found.manifest.at("shards").size());
  return kOk;
}

int info(const DatasetArguments& a) {
  if (std::filesystem::is_directory(a.folder)) {
    const nlohmann::ordered_json manifest = learn::readManifest(a.folder);
    try {
      fmt::print("{}", a.json ? manifest.dump(1) + "\n" : learn::datasetText(manifest));
    } catch (const nlohmann::json::exception& error) {
      throw learn::ShardError(
          fmt::format("{}: the manifest is not as expected: {}", a.folder, render::jsonReason(error)));
    }
  } else {
    const learn::ShardHeader shard(a.folder);
    fmt::print("{}", a.json ? shard.header().dump(1) + "\n" : learn::shardText(shard));
  }
  return kOk;
}

}  // namespace

Command addDatasetCommand(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("dataset", "Make data to learn from: docs/dataset.md");
  app->require_subcommand(1);
  const auto a = std::make_shared<DatasetArguments>();
  const Command generator = addDatasetGenerate(*app);

  CLI::App* merging =
      app->add_subcommand("merge", "Collect shards: unpack all, write the folder's manifest.json");
  merging->add_option("FOLDER", a->folders, "Folders of shards")->required();
  merging->add_option("-o,--output", a->output,
                      "Gather them in this folder: linked where possible, else copied");
  merging->add_option("--seeds", a->seeds, "Fail if the scene of one of these is missing: FIRST-LAST");
  merging->add_flag("-q,--quiet", a->quiet, "Print errors and the summary only");

  CLI::App* checking = app->add_subcommand("check", "Compare the shards of a folder with its manifest");
  checking->add_option("FOLDER", a->folder, "Folder of a data set")->required();
  checking->add_flag("-q,--quiet", a->quiet, "Print errors and the summary only");

  CLI::App* asking = app->add_subcommand("info", "Say what a data set holds, or a shard");
  asking->add_option("PATH", a->folder, "Folder of a data set, or a shard")->required();
  asking->add_flag("--json", a->json, "Print the manifest, or the shard's header");

  const Command preview = addDatasetPreview(*app);
  return {app, [=] {
            if (generator.app->parsed()) return generator.run();
            if (preview.app->parsed()) return preview.run();
            if (merging->parsed()) return merge(*a);
            return checking->parsed() ? check(*a) : info(*a);
          }};
}

}  // namespace odis::app
