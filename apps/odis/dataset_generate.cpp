#include "dataset_generate.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <thread>

#include "console.h"
#include "counter.h"
#include "dataset_manifest.h"
#include "dataset_range.h"
#include "learn/data/folder_settings.h"
#include "validators.h"

namespace odis::app {

namespace fs = std::filesystem;

namespace {

struct GenerateArguments {
  std::string scenes, seeds, shards, output, hdri, textures, furniture, kind = "cells";
  int of = 1, jobs = 0;
  bool quick = false, quality = false, dryRun = false, quiet = false;
};

// Shows what is done, and remembers what failed.
class GenerateObserver : public learn::ShardObserver {
 public:
  GenerateObserver(size_t total, bool quiet) : m_counter(total, quiet) {}
  void done(const learn::ShardSource& source, bool made) override {
    if (made)
      m_counter.done(source.name);
    else
      m_counter.skipped(source.name + ": is there already");
  }
  void failed(const learn::ShardSource& source, const std::string& why) override {
    ++m_failures;
    say(fmt::format("error: {}: {}\n", source.name, why));
    m_counter.skipped(source.name + ": failed");
  }
  bool cancelled() const override { return InterruptScope::interrupted(); }
  int failures() const { return m_failures; }

 private:
  Counter m_counter;
  int m_failures = 0;
};

std::vector<learn::ShardSource> sourcesOf(const GenerateArguments& a) {
  Range parts{1, uint64_t(a.of)};
  if (!a.shards.empty()) parts = parseRange("--shards", a.shards, {parts.first, parts.last});
  std::vector<learn::ShardSource> all;
  if (a.seeds.empty()) {
    all = learn::folderSources(a.scenes);
  } else {
    const Range seeds = parseRange("--seeds", a.seeds, kSeed);
    all = learn::seedSources(seeds.first, seeds.last);
  }
  return learn::partOf(all, int(parts.first), int(parts.last), a.of);
}

int generate(const GenerateArguments& a) {
  learn::DataSettings settings = a.quick     ? learn::DataSettings::quick()
                                 : a.quality ? learn::DataSettings::quality()
                                             : learn::DataSettings();
  if (a.kind == "incident-radiance") settings = settings.incidentRadiance();
  const learn::Assets assets(a.hdri, a.textures, a.furniture);
  const std::vector<learn::ShardSource> sources = sourcesOf(a);
  const auto made = learn::shardSettings(settings, assets, a.scenes.empty());
  std::vector<std::string> names;
  for (const learn::ShardSource& source : sources) names.push_back(source.name);
  if (a.dryRun) {
    learn::checkFolder(a.output, made, names);
    const auto isThere = [&](const std::string& name) {
      return fs::exists(learn::shardFile(a.output, name));
    };
    fmt::print("{} of {} shards are to be made\n",
               std::count_if(names.begin(), names.end(), std::not_fn(isThere)), names.size());
    return kOk;
  }
  learn::claimFolder(a.output, made, names);
  const int jobs = a.jobs > 0 ? a.jobs : int(std::max(1u, std::thread::hardware_concurrency()));

  const InterruptScope interruptible;
  GenerateObserver observer(sources.size(), a.quiet);
  learn::makeShards(sources, settings, assets, a.output, jobs, observer);
  if (observer.failures() > 0) {
    say(fmt::format("error: {} of {} scenes failed\n", observer.failures(), sources.size()));
    return kSceneError;
  }
  if (InterruptScope::interrupted()) return InterruptScope::exitCode();
  // Of a part nothing can be said of the whole: whoever runs the parts collects the manifest.
  if (a.shards.empty()) return collectManifest(a.output, sources, a.quiet);
  if (!a.quiet) say(fmt::format("When all parts are made: odis dataset merge {}\n", a.output));
  return kOk;
}

}  // namespace

Command addDatasetGenerate(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("generate", "Make shards: a scene each, with its pilots and targets");
  const auto a = std::make_shared<GenerateArguments>();
  CLI::Option* seeds =
      app->add_option("--seeds", a->seeds, "Of scenes to generate, as in `odis scenes generate`: FIRST-LAST");
  CLI::Option* scenes = app->add_option("--scenes", a->scenes, "Folder of scenes to use instead");
  scenes->excludes(seeds);
  app->add_option("-o,--output", a->output,
                  "Folder to make them in, whose shards are all made with the same options; those that are "
                  "there already are left alone")
      ->required();
  app->add_option("--shards", a->shards,
                  "Make these parts only, FIRST-LAST of the parts that --of cuts the seeds into");
  app->add_option("--of", a->of, "Into how many parts, for many machines: a part each")
      ->check(within(1, 1'000'000))
      ->capture_default_str();
  app->add_option("--jobs", a->jobs, "Shards to make at a time, a thread each; 0: one a core")
      ->check(within(kThreadCount))
      ->capture_default_str();
  app->add_option("--kind", a->kind,
                  "cells: what cells learn from; incident-radiance: maps at pixels, and their neighbourhoods")
      ->check(CLI::IsMember({"cells", "incident-radiance"}))
      ->capture_default_str();
  app->add_option("--hdri", a->hdri, "Folder of environment maps for generated scenes (HDR, EXR)");
  app->add_option("--textures", a->textures, "Folder of textures for them (PNG, JPEG)");
  app->add_option("--furniture", a->furniture,
                  "Folder of OBJ models for them, as scripts/furniture makes it");
  CLI::Option* quick = app->add_flag("--quick", a->quick, "Small pilots, few targets: for a first look");
  app->add_flag("--quality", a->quality, "Pilots as large as images, more and smoother targets")
      ->excludes(quick);
  app->add_flag("--dry-run", a->dryRun, "Say how many are to be made, or why none can be; make nothing");
  app->add_flag("-q,--quiet", a->quiet, "Print errors and the summary only");
  return {app, [a] {
            if (a->seeds.empty() == a->scenes.empty())
              throw UsageError("what to make shards of? expected --seeds or --scenes");
            return generate(*a);
          }};
}

}  // namespace odis::app
