#include "eval/denoiser_layers.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

namespace odis::eval {

namespace {

using Names = std::vector<std::string>;
const Names kColors{"noisy", "noisy image", "", "combined"};
const Names kAlbedos{"denoising albedo", "albedo"};
const Names kNormals{"denoising normal", "ns", "sh_normal", "nn", "normal", "n"};

// "denoising albedo" of "ViewLayer.Denoising Albedo".
std::string plainName(const std::string& layer) {
  std::string name = layer.substr(layer.rfind('.') + 1);
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name;
}

bool hasColor(const LayeredImage& image, const std::string& layer) {
  try {
    layerColor(image, layer);
    return true;
  } catch (const ImageError&) {
    return false;
  }
}

std::optional<std::string> find(const LayeredImage& image, const Names& names) {
  const std::vector<std::string> layers = layerNames(image);
  for (const std::string& name : names)
    for (const std::string& layer : layers)
      if (plainName(layer) == name && hasColor(image, layer)) return layer;
  return {};
}

std::string require(const LayeredImage& image, const std::optional<std::string>& layer, const char* what) {
  if (layer) return *layer;
  std::vector<std::string> names;
  for (const auto& [channel, values] : image.channels) names.push_back(channel);
  throw ImageError(fmt::format("found no {} in the channels {}", what, fmt::join(names, ", ")));
}

}  // namespace

DenoiserLayers findDenoiserLayers(const LayeredImage& image) {
  return {require(image, find(image, kColors), "colours (R, G, B)"), find(image, kAlbedos),
          find(image, kNormals)};
}

std::string findAlbedoLayer(const LayeredImage& image) {
  Names names = kAlbedos;
  names.push_back("");
  return require(image, find(image, names), "albedo");
}

std::string findNormalLayer(const LayeredImage& image) {
  Names names = kNormals;
  names.push_back("");
  return require(image, find(image, names), "normals");
}

std::string windowDifference(const LayeredImage& a, const LayeredImage& b) {
  const auto text = [](const render::ImageWindow& w) {
    return fmt::format("{} x {} at {},{}", w.width, w.height, w.x, w.y);
  };
  const std::string first = text(a.window), second = text(b.window);
  return first == second ? "" : fmt::format("has {} pixels, expected {}", second, first);
}

}  // namespace odis::eval
