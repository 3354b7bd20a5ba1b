#include "dataset_preview.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>

#include "learn/data/dataset.h"
#include "learn/data/preview.h"
#include "output.h"
#include "render/image/write.h"
#include "validators.h"

namespace odis::app {

namespace {

struct PreviewArguments {
  std::string path, output;
  int count = 12;
  float exposure = 0;
};

int preview(const PreviewArguments& a) {
  Outputs outputs;
  outputs.add(a.output, {".png"});
  std::vector<std::string> shards{a.path};
  if (std::filesystem::is_directory(a.path)) {
    shards.clear();
    for (const std::string& name : learn::shardsIn(a.path)) shards.push_back(learn::shardFile(a.path, name));
    if (shards.empty()) throw UsageError(fmt::format("the folder \"{}\" holds no shards", a.path));
  }
  outputs.rejectInputs(shards);
  const learn::Canvas canvas = learn::previewOf(shards, a.count);
  render::writePng(a.output, canvas.width, canvas.height, canvas.pixels.data(), a.exposure);
  return kOk;
}

}  // namespace

Command addDatasetPreview(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("preview", "Draw some of the maps, next to what the pilots say");
  app->footer(
      "A row a target: the first pilot's image with the target in red; of the cell around it, what the "
      "pilots'\n"
      "vertices say arrives, times the cosine; the same of the reference; what is scattered and its root "
      "mean\n"
      "square, what lights emit, the density with which next-event estimation finds them, how many rays a "
      "sample\n"
      "costs; for each group of lights the root mean square of its estimate, orange with the weight of MIS "
      "and\n"
      "grey without. Maps are equal-area octahedral squares with +z in the middle, blue where nothing is "
      "sampled.");
  const auto a = std::make_shared<PreviewArguments>();
  app->add_option("PATH", a->path, "Folder of shards, or a shard")->required();
  app->add_option("-o,--output", a->output, "PNG to write")->required();
  app->add_option("--count", a->count, "How many targets")->check(within(1, 500))->capture_default_str();
  app->add_option("--exposure", a->exposure, "In stops")->check(within(kStops))->capture_default_str();
  return {app, [a] { return preview(*a); }};
}

}  // namespace odis::app
