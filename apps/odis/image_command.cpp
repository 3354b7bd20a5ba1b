// odis image: info, convert, diff, average, merge
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <map>
#include <memory>

#include "command.h"
#include "eval/difference.h"
#include "eval/layers.h"
#include "output.h"
#include "validators.h"

namespace odis::app {

namespace {

using eval::LayeredImage;

struct ImageArguments {
  std::vector<std::string> images;
  std::string output, layer, kind = "absolute", toneMap = "filmic";
  float exposure = 0;
  double full = 0;
};

int info(const ImageArguments& a) {
  for (const std::string& path : a.images) {
    const LayeredImage image = eval::readChannels(path);
    const render::ImageWindow& w = image.window;
    fmt::print("{}: {} x {} pixels", path, w.width, w.height);
    if (w.width != w.fullWidth || w.height != w.fullHeight)
      fmt::print(" at {},{} of {} x {}", w.x, w.y, w.fullWidth, w.fullHeight);
    fmt::print("\n  {:<16} {:>12} {:>12} {:>12}\n", "channel", "least", "mean", "most");
    for (const auto& [name, values] : image.channels) {
      const eval::ChannelSummary s = eval::summarizeChannel(values);
      fmt::print("  {:<16} {:>12.6g} {:>12.6g} {:>12.6g}", name, s.least, s.mean, s.most);
      if (s.nonFinite > 0) fmt::print("  {} not finite", s.nonFinite);
      fmt::print("\n");
    }
    for (const auto& [key, text] : image.metadata) fmt::print("  {}: {}\n", key, text);
  }
  return kOk;
}

void writeColorAs(const std::string& path, const eval::ColorImage& image, float exposure,
                  render::ToneMap toneMap) {
  if (endsWith(path, ".png")) {
    render::writePng(path, image.width, image.height, image.pixels.data(), exposure, toneMap);
    return;
  }
  eval::ColorImage scaled = image;
  for (render::Rgb& pixel : scaled.pixels) pixel *= std::exp2(exposure);
  eval::writeColor(path, scaled);
}

// The output can be written, and is none of the images that are read.
void checkBeside(const ImageArguments& a, const std::vector<std::string>& inputs,
                 std::initializer_list<const char*> endings) {
  Outputs outputs;
  outputs.add(a.output, endings);
  outputs.rejectInputs(inputs);
}

int convert(const ImageArguments& a) {
  checkBeside(a, a.images, {".png", ".exr"});
  const eval::ColorImage image = eval::readColor(a.images.front(), a.layer);
  writeColorAs(a.output, image, a.exposure,
               a.toneMap == "clamp" ? render::ToneMap::clamp : render::ToneMap::filmic);
  return kOk;
}

int diff(const ImageArguments& a) {
  checkBeside(a, a.images, {".png", ".exr"});
  static const std::map<std::string, eval::DifferenceKind> kKinds{
      {"signed", eval::DifferenceKind::signedColor},
      {"absolute", eval::DifferenceKind::absolute},
      {"relative", eval::DifferenceKind::relative},
      {"flip", eval::DifferenceKind::flip}};
  const eval::ColorImage first = eval::readColor(a.images[0], a.layer),
                         second = eval::readColor(a.images[1], a.layer);
  eval::ColorImage difference;
  try {
    difference = eval::difference(first, second, kKinds.at(a.kind));
  } catch (const std::invalid_argument& error) {
    throw eval::ImageError(fmt::format("{}, {}: {}", a.images[0], a.images[1], error.what()));
  }
  const size_t differing = eval::differingPixels(first, second);
  if (differing == 0)
    fmt::print("the images are equal\n");
  else
    fmt::print("{} of {} pixels differ\n", differing, first.pixels.size());
  if (endsWith(a.output, ".png")) {
    const double full = a.full > 0 ? a.full : a.kind == "flip" ? 1 : eval::heatMapEnd(difference);
    if (differing > 0) fmt::print("the colours end at {:.4g}\n", full);
    difference = eval::heatMap(difference, a.kind == "signed", full);
  }
  writeColorAs(a.output, difference, 0, render::ToneMap::clamp);
  return kOk;
}

int average(const ImageArguments& a) {
  checkBeside(a, a.images, {".exr"});
  std::vector<LayeredImage> images;
  for (const std::string& path : a.images) images.push_back(eval::readChannels(path));
  eval::writeLayered(a.output, eval::average(images));
  return kOk;
}

int merge(const ImageArguments& a) {
  std::vector<std::string> names, files;
  for (const std::string& text : a.images) {
    const size_t equals = text.find('=');
    const bool named = equals != std::string::npos;
    names.push_back(named ? text.substr(0, equals) : "");
    files.push_back(named ? text.substr(equals + 1) : text);
  }
  checkBeside(a, files, {".exr"});
  std::vector<std::pair<std::string, LayeredImage>> images;
  for (size_t i = 0; i < files.size(); ++i) images.emplace_back(names[i], eval::readChannels(files[i]));
  eval::writeLayered(a.output, eval::merge(images));
  return kOk;
}

}  // namespace

Command addImageCommand(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("image", "Look into images, convert, subtract, average, merge them");
  app->require_subcommand(1);
  const auto a = std::make_shared<ImageArguments>();
  const auto add = [&](const char* name, const char* help, const char* images, int count, bool output) {
    CLI::App* sub = app->add_subcommand(name, help);
    CLI::Option* files = sub->add_option("IMAGES", a->images, images)->required();
    if (count > 0) files->expected(count);
    if (output) sub->add_option("-o,--output", a->output, "File to write")->required();
    return sub;
  };
  add("info", "Size, channels with their ranges, metadata", "EXR, PNG, JPEG, TGA, BMP or HDR files", 0,
      false);
  CLI::App* sub = add("convert", "Write one layer as PNG or EXR", "The image", 1, true);
  sub->add_option("--layer", a->layer,
                  "Which layer, as in albedo of albedo.R; default: as for `odis metrics`");
  sub->add_option("--exposure", a->exposure, "In stops")->check(within(kStops))->capture_default_str();
  sub->add_option("--tone-map", a->toneMap, "Of PNGs: highlights rolled off or clamped")
      ->check(CLI::IsMember({"filmic", "clamp"}))
      ->capture_default_str();
  sub = add("diff", "Where two images differ: numbers as EXR, false colours as PNG", "Image and reference", 2,
            true);
  sub->add_option("--layer", a->layer, "Which layer; default: as for `odis metrics`");
  sub->add_option("--kind", a->kind, "signed: I - R; relative: as relMSE sums it; flip: as FLIP averages it")
      ->check(CLI::IsMember({"signed", "absolute", "relative", "flip"}))
      ->capture_default_str();
  sub->add_option("--full", a->full, "Where the colours end; default: 99 % of the pixels are below, FLIP: 1")
      ->check(within(1e-30, 1e30));
  add("average", "The mean of images of one size, channel by channel", "EXR files", 0, true);
  add("merge", "The layers of several images in one", "EXR files; name=FILE puts name. before its channels",
      0, true);
  return {app, [a, app] {
            static const std::map<std::string, int (*)(const ImageArguments&)> kCommands{
                {"info", info}, {"convert", convert}, {"diff", diff}, {"average", average}, {"merge", merge}};
            return kCommands.at(app->get_subcommands().front()->get_name())(*a);
          }};
}

}  // namespace odis::app
