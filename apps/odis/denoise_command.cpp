// odis denoise
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <map>
#include <memory>

#include "command.h"
#include "console.h"
#include "denoising.h"
#include "effects.h"
#include "eval/denoiser_layers.h"
#include "output.h"
#include "render/image/copy_exr.h"
#include "render/integrators/job.h"
#include "validators.h"

namespace odis::app {

namespace {

using eval::LayeredImage;

struct DenoiseArguments {
  std::string image, output, png, layer, albedo, normal, albedoLayer, normalLayer;
  std::string auxiliaries;
  float exposure = 0;
  int threads = 0;
  bool quiet = false;
};

// What the denoiser takes of the files.
struct DenoiserImages {
  std::vector<render::Rgb> color, albedo;
  std::vector<render::Vec3> normal;
};

using FindLayer = std::optional<std::string> (*)(const LayeredImage&);

void rejectDisplayed(const std::string& path) {
  for (const char* ending : {".png", ".jpg", ".jpeg", ".tga", ".bmp"})
    if (endsWith(path, ending))
      throw eval::ImageError(path +
                             ": found an image of 8 bits, as a screen shows it; expected linear colours as "
                             "they were rendered, in an .exr or .hdr file");
}

std::vector<render::Rgb> pixelsOf(const std::string& file, const LayeredImage& image,
                                  const std::string& layer) {
  try {
    return eval::layerColor(image, layer).pixels;
  } catch (const eval::ImageError& error) {
    throw eval::ImageError(file + ": " + error.what());
  }
}

void requireSameWindow(const std::string& file, const LayeredImage& image, const std::string& otherFile,
                       const LayeredImage& other) {
  const auto text = [](const render::ImageWindow& w) {
    return fmt::format("{} x {} pixels at {},{}", w.width, w.height, w.x, w.y);
  };
  const std::string expected = text(image.window), found = text(other.window);
  if (found != expected)
    throw eval::ImageError(
        fmt::format("{}: has {}, expected {} as {} has", otherFile, found, expected, file));
}

// Albedo or normals: the chosen layer, else the one that is found by its name, of a file of their own if one
// is named. Empty if the image has none.
std::vector<render::Rgb> auxiliary(const std::string& imageFile, const LayeredImage& image,
                                   const std::string& file, const std::string& layer, FindLayer find) {
  if (file.empty()) {
    const std::optional<std::string> found = layer.empty() ? find(image) : layer;
    return found ? pixelsOf(imageFile, image, *found) : std::vector<render::Rgb>();
  }
  const LayeredImage other = eval::readChannels(file);
  requireSameWindow(imageFile, image, file, other);
  return pixelsOf(file, other, layer.empty() ? find(other).value_or("") : layer);
}

// How albedo and normals are taken. If nobody says, those that `odis render --denoise` made are clean.
std::string auxiliariesOf(const DenoiseArguments& a, const LayeredImage& image) {
  if (!a.auxiliaries.empty()) return a.auxiliaries;
  const auto found = image.metadata.find("odis:denoiserAuxiliaries");
  const bool clean = found != image.metadata.end() && endsWith(found->second, ", clean");
  return clean && a.albedo.empty() && a.normal.empty() ? "clean" : "prefiltered";
}

std::string colorLayerOf(const DenoiseArguments& a, const LayeredImage& image) {
  return a.layer.empty() ? eval::findColorLayer(image).value_or("") : a.layer;
}

DenoiserImages imagesOf(const DenoiseArguments& a, const LayeredImage& image) {
  DenoiserImages images;
  images.color = pixelsOf(a.image, image, colorLayerOf(a, image));
  if (a.auxiliaries == "none") return images;
  images.albedo = auxiliary(a.image, image, a.albedo, a.albedoLayer, eval::findAlbedoLayer);
  for (const render::Rgb& n : auxiliary(a.image, image, a.normal, a.normalLayer, eval::findNormalLayer))
    images.normal.emplace_back(n.x, n.y, n.z);
  return images;
}

// The channels of a layer, which have the type of those of another.
void addLayer(const std::string& layer, const std::vector<render::Rgb>& pixels, const std::string& like,
              render::ExrChanges& changes) {
  for (int c = 0; c < 3; ++c) {
    render::NewChannel& channel = changes.channels.emplace_back();
    channel.name = layer + "RGB"[c];
    channel.like = like;
    for (const render::Rgb& pixel : pixels) channel.pixels.push_back(pixel[c]);
  }
}

// What differs in the denoised file. A layer of one channel becomes one of three.
render::ExrChanges changesOf(const eval::DenoisedPlace& place, const LayeredImage& image,
                             const std::vector<render::Rgb>& noisy, const std::vector<render::Rgb>& denoised,
                             const Denoising& denoising) {
  render::ExrChanges changes;
  changes.part = place.part;
  std::string like;
  for (const auto& [name, at] : image.places)
    if (at.part == place.part && (at.name == place.layer + "R" || at.name == place.layer + "Y"))
      like = at.name;
  if (!place.kept.empty()) addLayer(place.kept, noisy, like, changes);
  addLayer(place.layer, denoised, like, changes);
  if (like == place.layer + "Y") changes.removed.push_back(like);
  changes.metadata = denoisingMetadata(denoising);
  return changes;
}

// Files of formats that hold nothing but colours become EXR files.
void writeDenoised(const DenoiseArguments& a, LayeredImage& image, const render::ExrChanges& changes) {
  if (!image.places.empty()) return render::copyExr(a.image, a.output, changes);
  for (const render::NewChannel& channel : changes.channels) image.channels[channel.name] = channel.pixels;
  image.metadata = changes.metadata;
  eval::writeLayered(a.output, image);
}

// Options that would change nothing.
void requireEffects(const DenoiseArguments& a) {
  const std::pair<const char*, bool> ofAuxiliaries[] = {{"--albedo", !a.albedo.empty()},
                                                        {"--normal", !a.normal.empty()},
                                                        {"--albedo-layer", !a.albedoLayer.empty()},
                                                        {"--normal-layer", !a.normalLayer.empty()}};
  for (const auto& [option, isGiven] : ofAuxiliaries)
    if (isGiven && a.auxiliaries == "none")
      throw UsageError(fmt::format("{}: has no effect with --aux none", option));
  requirePngToExpose(a.exposure, a.png, a.output);
}

int runDenoise(const DenoiseArguments& a) {
  const render::Stopwatch watch;
  rejectDisplayed(a.image);
  requireEffects(a);
  Outputs outputs;
  outputs.add(a.output, {".exr", ".png"});
  if (!a.png.empty()) outputs.add(a.png, {".png"});
  outputs.rejectInputs({a.image, a.albedo, a.normal});
  LayeredImage image = eval::readChannels(a.image);
  DenoiserImages images = imagesOf(a, image);
  const render::Denoiser denoiser(a.threads);
  if (const auto film = image.metadata.find("odis:film");
      film != image.metadata.end() && film->second == "splat" && !a.quiet)
    sayWarning(fmt::format(
        "{}: was splatted: neighbouring pixels share their noise, which the denoiser takes for "
        "detail; images of `odis render --film pixels` have about a tenth of the error afterwards",
        a.image));
  if (images.albedo.empty() && a.auxiliaries != "none" && !a.quiet)
    sayWarning(fmt::format("{}: found no albedo: denoised by its colours alone{}", a.image,
                           images.normal.empty() ? "" : ", without the normals"));
  if (images.albedo.empty()) images.normal.clear();

  static const std::map<std::string, render::Auxiliaries> kAuxiliaries{
      {"clean", render::Auxiliaries::clean},
      {"prefiltered", render::Auxiliaries::prefiltered},
      {"noisy", render::Auxiliaries::noisy},
      {"none", render::Auxiliaries::none}};
  const InterruptScope interruptible;
  ConsoleProgress progress(a.quiet);
  Denoising denoising;
  const int width = image.window.width, height = image.window.height;
  const auto colors = denoiseColors(denoiser, {width, height, images.color, images.albedo, images.normal},
                                    kAuxiliaries.at(auxiliariesOf(a, image)), progress, denoising);
  if (!colors) return InterruptScope::exitCode();
  const WrittenFiles files({a.output, a.png});
  const eval::DenoisedPlace place = eval::findDenoisedPlace(image, colorLayerOf(a, image));
  if (endsWith(a.output, ".png"))
    render::writePng(a.output, width, height, colors->data(), a.exposure);
  else
    writeDenoised(a, image, changesOf(place, image, images.color, *colors, denoising));
  if (!a.png.empty()) render::writePng(a.png, width, height, colors->data(), a.exposure);
  if (!a.quiet)
    say(files.text(fmt::format("after {}, {}R, G, B denoised", durationText(watch.seconds()), place.layer)));
  return InterruptScope::exitCode();
}

}  // namespace

Command addDenoiseCommand(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("denoise", "Denoise a rendered image with Open Image Denoise");
  app->footer(
      "Layers of `odis render --denoise` or `--aov albedo,normal` are found by their names, so are those of\n"
      "Cycles, Mitsuba and pbrt. OUTPUT has all parts and channels of IMAGE; what viewers show (R, G and B,\n"
      "ViewLayer.Combined) is denoised, and the layer noisy has it as it was. More: docs/denoising.md.");
  const auto a = std::make_shared<DenoiseArguments>();
  app->add_option("IMAGE", a->image, "EXR or HDR file")->required();
  app->add_option("-o,--output", a->output, "Image to write, .exr or .png")->required();
  app->add_option("--png", a->png, "Write a PNG for a look as well");
  app->add_option("--exposure", a->exposure, "Of the PNG, in stops")
      ->check(within(kStops))
      ->capture_default_str();
  app->add_option(
         "--aux", a->auxiliaries,
         "Albedo and normals: taken as free of noise, denoised first, taken as noisy, or not taken at all; "
         "default: clean if they are of `odis render --denoise`, else prefiltered")
      ->check(CLI::IsMember({"clean", "prefiltered", "noisy", "none"}));
  app->add_option("--albedo", a->albedo, "File that has the albedo; default: a layer of IMAGE");
  app->add_option("--normal", a->normal, "File that has the normals; default: a layer of IMAGE");
  app->add_option("--layer", a->layer, "Which layer holds the colours, as in noisy of noisy.R");
  app->add_option("--albedo-layer", a->albedoLayer, "Which layer holds the albedo");
  app->add_option("--normal-layer", a->normalLayer, "Which layer holds the normals");
  app->add_option("--threads", a->threads, "0: one a core")
      ->check(within(kThreadCount))
      ->capture_default_str();
  app->add_flag("-q,--quiet", a->quiet, "Print errors only");
  return {app, [a] { return runDenoise(*a); }};
}

}  // namespace odis::app
