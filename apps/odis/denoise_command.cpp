// odis denoise
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <map>
#include <memory>

#include "command.h"
#include "console.h"
#include "denoising.h"
#include "eval/denoiser_layers.h"
#include "output.h"
#include "validators.h"

namespace odis::app {

namespace {

using eval::LayeredImage;

struct DenoiseArguments {
  std::string image, output, png, layer, albedo, normal, albedoLayer, normalLayer;
  std::string auxiliaries = "prefiltered";
  float exposure = 0;
  int threads = 0;
  bool quiet = false;
};

// What the denoiser takes of the files.
struct DenoiserImages {
  std::vector<render::Rgb> color, albedo;
  std::vector<render::Vec3> normal;
};

// An error of a file says which one.
template <typename Work>
auto about(const std::string& file, Work work) {
  try {
    return work();
  } catch (const eval::ImageError& error) {
    throw eval::ImageError(file + ": " + error.what());
  }
}

void rejectDisplayed(const std::string& path) {
  for (const char* ending : {".png", ".jpg", ".jpeg", ".tga", ".bmp"})
    if (endsWith(path, ending))
      throw eval::ImageError(path + ": found an image of 8 bits, as a screen shows it; expected linear colours "
                                    "as they were rendered, in an .exr or .hdr file");
}

// A layer of a further file, if one is named, else of the image, if it has one; empty otherwise.
std::vector<render::Rgb> auxiliary(const LayeredImage& image, const std::string& imageFile,
                                   const std::string& file, const std::string& chosenLayer,
                                   const std::optional<std::string>& foundLayer,
                                   std::string (*find)(const LayeredImage&)) {
  if (file.empty()) {
    if (chosenLayer.empty() && !foundLayer) return {};
    const std::string& layer = chosenLayer.empty() ? *foundLayer : chosenLayer;
    return about(imageFile, [&] { return eval::layerColor(image, layer).pixels; });
  }
  const LayeredImage other = eval::readChannels(file);
  if (const std::string difference = eval::windowDifference(image, other); !difference.empty())
    throw eval::ImageError(fmt::format("{}: {} as {} has", file, difference, imageFile));
  return about(file, [&] {
    return eval::layerColor(other, chosenLayer.empty() ? find(other) : chosenLayer).pixels;
  });
}

DenoiserImages imagesOf(const DenoiseArguments& a, const LayeredImage& image) {
  eval::DenoiserLayers layers;
  about(a.image, [&] { layers = eval::findDenoiserLayers(image); });
  if (!a.layer.empty()) layers.color = a.layer;
  DenoiserImages images;
  images.color = about(a.image, [&] { return eval::layerColor(image, layers.color).pixels; });
  if (a.auxiliaries == "none") return images;
  images.albedo =
      auxiliary(image, a.image, a.albedo, a.albedoLayer, layers.albedo, eval::findAlbedoLayer);
  for (const render::Rgb& n :
       auxiliary(image, a.image, a.normal, a.normalLayer, layers.normal, eval::findNormalLayer))
    images.normal.emplace_back(n.x, n.y, n.z);
  return images;
}

void setLayer(LayeredImage& image, const std::string& prefix, const std::vector<render::Rgb>& pixels) {
  for (int c = 0; c < 3; ++c) {
    std::vector<float>& plane = image.channels[prefix + "RGB"[c]];
    plane.clear();
    for (const render::Rgb& pixel : pixels) plane.push_back(pixel[c]);
  }
}

int runDenoise(const DenoiseArguments& a) {
  rejectDisplayed(a.image);
  Outputs outputs;
  outputs.add(a.output, {".exr", ".png"});
  if (!a.png.empty()) outputs.add(a.png, {".png"});
  outputs.rejectInputs({a.image, a.albedo, a.normal});
  const render::Denoiser denoiser(a.threads);
  LayeredImage image = eval::readChannels(a.image);
  DenoiserImages images = imagesOf(a, image);
  if (images.albedo.empty() && a.auxiliaries != "none" && !a.quiet)
    say(fmt::format("warning: {}: found no albedo: denoised by its colours alone\n", a.image));
  if (images.albedo.empty()) images.normal.clear();

  static const std::map<std::string, render::Auxiliaries> kAuxiliaries{
      {"prefiltered", render::Auxiliaries::prefiltered},
      {"noisy", render::Auxiliaries::noisy},
      {"none", render::Auxiliaries::none}};
  const InterruptScope interruptible;
  ConsoleProgress progress(a.quiet);
  Denoising denoising;
  const int width = image.window.width, height = image.window.height;
  const auto colors = denoiseColors(denoiser, {width, height, images.color, images.albedo, images.normal},
                                    kAuxiliaries.at(a.auxiliaries), progress, denoising);
  if (!colors) return InterruptScope::exitCode();
  if (endsWith(a.output, ".png"))
    render::writePng(a.output, width, height, colors->data(), a.exposure);
  else {
    setLayer(image, "noisy.", images.color);
    setLayer(image, "", *colors);
    for (const auto& [key, text] : denoisingMetadata(denoising)) image.metadata[key] = text;
    eval::writeLayered(a.output, image);
  }
  if (!a.png.empty()) render::writePng(a.png, width, height, colors->data(), a.exposure);
  return InterruptScope::exitCode();
}

}  // namespace

Command addDenoiseCommand(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("denoise", "Denoise a rendered image with Open Image Denoise");
  app->footer(
      "Layers of `odis render --denoise` or `--aov albedo,normal` are found by their names, so are those of\n"
      "Cycles, Mitsuba and pbrt. OUTPUT has all channels of IMAGE, R, G and B being denoised, and the colours\n"
      "before that as the layer noisy. More: docs/denoising.md.");
  const auto a = std::make_shared<DenoiseArguments>();
  app->add_option("IMAGE", a->image, "EXR or HDR file")->required();
  app->add_option("-o,--output", a->output, "Image to write, .exr or .png")->required();
  app->add_option("--png", a->png, "Write a PNG for a look as well");
  app->add_option("--exposure", a->exposure, "Of the PNG, in stops")
      ->check(within(kStops))
      ->capture_default_str();
  app->add_option("--aux", a->auxiliaries,
                  "Albedo and normals: denoised first, taken as they are, or not taken at all")
      ->check(CLI::IsMember({"prefiltered", "noisy", "none"}))
      ->capture_default_str();
  app->add_option("--albedo", a->albedo, "File that has the albedo; default: a layer of IMAGE");
  app->add_option("--normal", a->normal, "File that has the normals; default: a layer of IMAGE");
  app->add_option("--layer", a->layer, "Which layer holds the colours, as in noisy of noisy.R");
  app->add_option("--albedo-layer", a->albedoLayer, "Which layer holds the albedo");
  app->add_option("--normal-layer", a->normalLayer, "Which layer holds the normals");
  app->add_option("--threads", a->threads, "0: one a core")->check(within(kThreadCount))->capture_default_str();
  app->add_flag("-q,--quiet", a->quiet, "Print errors only");
  return {app, [a] { return runDenoise(*a); }};
}

}  // namespace odis::app
