#include "eval/denoiser_layers.h"

#include <algorithm>
#include <cctype>
#include <initializer_list>

namespace odis::eval {

// "denoising albedo" of "ViewLayer.Denoising Albedo".
static std::string plainName(const std::string& layer) {
  std::string name = layer.substr(layer.rfind('.') + 1);
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name;
}

static bool hasColor(const LayeredImage& image, const std::string& layer) {
  try {
    layerColor(image, layer);
    return true;
  } catch (const ImageError&) {
    return false;
  }
}

static std::optional<std::string> findLayer(const LayeredImage& image,
                                            std::initializer_list<const char*> names) {
  const std::vector<std::string> layers = layerNames(image);
  for (const char* name : names)
    for (const std::string& layer : layers)
      if (plainName(layer) == name && hasColor(image, layer)) return layer;
  return {};
}

std::optional<std::string> findImageLayer(const LayeredImage& image) {
  if (const auto named = findLayer(image, {"", "combined"})) return named;
  std::optional<std::string> only;
  for (const std::string& layer : layerNames(image)) {
    if (!image.channels.contains(layer + ".R") || !hasColor(image, layer)) continue;
    if (only) return {};
    only = layer;
  }
  return only;
}

std::optional<std::string> findColorLayer(const LayeredImage& image) {
  return findLayer(image, {"noisy", "noisy image", "", "combined"});
}

std::optional<std::string> findAlbedoLayer(const LayeredImage& image) {
  return findLayer(image, {"denoising albedo", "albedo"});
}

std::optional<std::string> findNormalLayer(const LayeredImage& image) {
  return findLayer(image, {"denoising normal", "ns", "sh_normal", "nn", "normal", "n"});
}

// The layer of the file's part that a layer is, as in "ViewLayer.Combined.".
static DenoisedPlace placeOf(const LayeredImage& image, const std::string& layer) {
  const std::string prefix = layer.empty() ? "" : layer + ".";
  for (const auto& [name, place] : image.places)
    if (name.starts_with(prefix) && name.find('.', prefix.size()) == std::string::npos)
      return {place.part, place.name.substr(0, place.name.rfind('.') + 1), ""};
  return {0, prefix, ""};
}

// "ViewLayer." of "ViewLayer.Combined." and of "ViewLayer.Combined".
static std::string parentOf(const std::string& layer) {
  const size_t dot = layer.find_last_of(
      '.', layer.ends_with('.') && layer.size() > 1 ? layer.size() - 2 : std::string::npos);
  return dot == std::string::npos ? "" : layer.substr(0, dot + 1);
}

DenoisedPlace findDenoisedPlace(const LayeredImage& image, const std::string& layer) {
  const std::string name = plainName(layer), parent = parentOf(layer);
  if (name != "noisy" && name != "noisy image") {
    DenoisedPlace place = placeOf(image, layer);
    place.kept = parentOf(place.layer) + "noisy.";
    for (const auto& [channel, other] : image.places)
      if (other.part == place.part && other.name.starts_with(place.kept)) place.kept = "";
    return place;
  }
  for (const std::string& other : layerNames(image))
    if (parentOf(other) == parent && plainName(other) == "combined") return placeOf(image, other);
  const std::string above = parent.empty() ? "" : parent.substr(0, parent.size() - 1);
  return hasColor(image, above) ? placeOf(image, above) : DenoisedPlace();
}

}  // namespace odis::eval
