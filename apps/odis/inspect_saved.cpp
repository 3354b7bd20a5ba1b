#include "inspect_saved.h"

#include <fmt/format.h>

#include <filesystem>

#include "command.h"
#include "learn/inspect/saved_output.h"
#include "output.h"

namespace odis::app {

namespace {

void writeSavedPicture(const std::string& path, const learn::SavedInspection& saved,
                       const std::string& title) {
  if (saved.cell) return writeCanvas(path, learn::drawCell(*saved.cell, title, mapColorsOf(path)));
  if (!saved.frame) return writeCanvas(path, learn::drawGuide(*saved.guide, title, mapColorsOf(path)));
  writeColors(path, int(saved.frame->width), int(saved.frame->height), saved.frame->image,
              render::ToneMap::filmic);
}

}  // namespace

learn::MapColors mapColorsOf(const std::string& picture) {
  return endsWith(picture, ".png") ? learn::MapColors::stops : learn::MapColors::values;
}

void writeCanvas(const std::string& path, const learn::Canvas& canvas) {
  writeColors(path, canvas.width, canvas.height, canvas.pixels, render::ToneMap::clamp);
}

void showSaved(const SavedArguments& a) {
  Outputs outputs;
  if (!a.output.empty()) outputs.add(a.output, {".png", ".exr"});
  if (!a.json.empty()) outputs.add(a.json, {".json"});
  outputs.rejectInputs({a.file});
  learn::SavedInspection saved = learn::inspectSaved(core::Archive::load(a.file));
  if ((saved.vertices || saved.builder) && !a.output.empty())
    throw UsageError(fmt::format("-o: \"{}\" holds {}, of which there is no picture", a.file,
                                 saved.vertices ? "vertices" : "a builder"));
  if (a.point) saved.cell = learn::inspectCell(saved, *a.point, a.normal);
  const std::string title = std::filesystem::path(a.file).filename().string();
  if (!a.output.empty()) writeSavedPicture(a.output, saved, title);
  if (!a.json.empty()) writeText(a.json, learn::toJson(saved).dump(1) + "\n");
  fmt::print("{}", learn::savedText(saved, title));
}

}  // namespace odis::app
