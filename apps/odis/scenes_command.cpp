// odis scenes: generate, sheet
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>

#include "command.h"
#include "console.h"
#include "counter.h"
#include "learn/scenes/generate.h"
#include "learn/scenes/sheet.h"
#include "output.h"
#include "render/files/replace_file.h"
#include "render/image/write.h"
#include "suggest.h"
#include "validators.h"

namespace odis::app {

namespace {

struct ScenesArguments {
  uint64_t seed = 0;
  int count = 1;
  std::string kind, output, hdri, textures, furniture, folder;
  learn::SheetOptions sheet;
  float exposure = 0;
  bool quiet = false;
};

const learn::Kind* kindNamed(const std::string& name) {
  if (name.empty()) return nullptr;
  if (const learn::Kind* kind = learn::findKind(name)) return kind;
  std::vector<std::string> names;
  std::string list;
  for (const learn::Kind& kind : learn::kinds()) {
    names.emplace_back(kind.name);
    list += (list.empty() ? "" : ", ") + std::string(kind.name);
  }
  const std::string meant = nearest(name, names);
  throw UsageError(fmt::format("--kind: found \"{}\", expected one of {}{}", name, list,
                               meant.empty() ? "" : "\nDid you mean " + meant + "?"));
}

int generate(const ScenesArguments& a) {
  const learn::Kind* only = kindNamed(a.kind);
  if (a.seed > kSeed.most - uint64_t(a.count - 1))
    throw UsageError(fmt::format("--count: found {}, expected seeds that end before 2^64", a.count));
  const learn::Assets assets(a.hdri, a.textures, a.furniture);
  const auto kindAt = [&](uint64_t seed) -> const learn::Kind& { return only ? *only : learn::kindOf(seed); };
  // Nothing is made if something of it is there that was made in another way.
  for (uint64_t i = 0; i < uint64_t(a.count) && std::filesystem::exists(a.output); ++i)
    learn::checkScene(a.seed + i, kindAt(a.seed + i), assets, a.output);
  render::makeFolder(a.output);
  const InterruptScope interruptible;
  Counter counter(size_t(a.count), a.quiet);
  for (int i = 0; i < a.count && !InterruptScope::interrupted(); ++i) {
    const uint64_t seed = a.seed + uint64_t(i);
    const learn::Kind& kind = kindAt(seed);
    const bool made = learn::generateScene(seed, kind, assets, a.output);
    const std::string name = learn::sceneName(seed, kind);
    if (made)
      counter.done(name);
    else
      counter.skipped(name + ": is there already");
  }
  return InterruptScope::exitCode();
}

std::vector<std::string> filesBelow(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    files.push_back(entry.path().string());
  return files;
}

int sheet(const ScenesArguments& a) {
  Outputs outputs;
  outputs.add(a.output, {".png"});
  const std::vector<std::string> names = learn::scenesIn(a.folder);
  if (names.empty())
    throw UsageError(
        fmt::format("the folder \"{}\" holds no scenes, expected folders with a scene.xml", a.folder));
  for (const std::string& name : names) outputs.rejectInputs(filesBelow(a.folder + "/" + name));
  const InterruptScope interruptible;
  ConsoleProgress progress(true);
  Counter counter(names.size(), a.quiet);
  learn::SheetPainter painter(a.sheet, names.size());
  for (const std::string& name : names) {
    if (!painter.add(a.folder, name, progress)) break;
    counter.done(name);
  }
  if (InterruptScope::interrupted() && std::filesystem::is_regular_file(a.output)) {
    say(fmt::format("interrupted: {} stays as it was, nothing is written\n", a.output));
    return InterruptScope::exitCode();
  }
  const learn::Canvas& sheet = painter.sheet();
  render::writePng(a.output, sheet.width, sheet.height, sheet.pixels.data(), a.exposure);
  return InterruptScope::exitCode();
}

}  // namespace

Command addScenesCommand(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("scenes", "Make scenes to learn from, and look at them");
  app->require_subcommand(1);
  const auto a = std::make_shared<ScenesArguments>();

  CLI::App* sub =
      app->add_subcommand("generate", "Make scenes: Mitsuba files, a folder each, two views each");
  std::string list = "Kinds:";
  for (const learn::Kind& kind : learn::kinds()) list += fmt::format("\n  {:<12} {}", kind.name, kind.what);
  sub->footer(list);
  sub->add_option("--seed", a->seed, "Of the first scene; the others have the next numbers")
      ->check(within(kSeed))
      ->capture_default_str();
  sub->add_option("--count", a->count, "How many")->check(within(1, 100'000'000))->capture_default_str();
  sub->add_option("-o,--output", a->output, "Folder to make them in; what is there already is left alone")
      ->required();
  sub->add_option("--kind", a->kind, "All of this kind; default: of all kinds");
  sub->add_option("--hdri", a->hdri, "Folder of environment maps (HDR, EXR); default: drawn skies");
  sub->add_option("--textures", a->textures, "Folder of textures (PNG, JPEG) for walls, floors, ...");
  sub->add_option("--furniture", a->furniture, "Folder of OBJ models, as scripts/furniture makes it");
  sub->add_flag("-q,--quiet", a->quiet, "Print errors only");

  sub = app->add_subcommand("sheet", "Render all scenes of a folder small, into one PNG with their names");
  sub->add_option("FOLDER", a->folder, "Folder of scenes")->required();
  sub->add_option("-o,--output", a->output, "PNG to write")->required();
  sub->add_option("--spp", a->sheet.spp, "Samples per pixel")->check(within(1, 65536))->capture_default_str();
  sub->add_option("--width", a->sheet.width, "Of a picture, in pixels")
      ->check(within(16, 2048))
      ->capture_default_str();
  sub->add_option("--columns", a->sheet.columns, "Pictures in a row")
      ->check(within(1, 100))
      ->capture_default_str();
  sub->add_option("--exposure", a->exposure, "In stops")->check(within(kStops))->capture_default_str();
  sub->add_flag("-q,--quiet", a->quiet, "Print errors only");
  return {app, [a, app] { return app->got_subcommand("generate") ? generate(*a) : sheet(*a); }};
}

}  // namespace odis::app
