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

std::optional<std::string> findColorLayer(const LayeredImage& image) {
  return findLayer(image, {"noisy", "noisy image", "", "combined"});
}

std::optional<std::string> findAlbedoLayer(const LayeredImage& image) {
  return findLayer(image, {"denoising albedo", "albedo"});
}

std::optional<std::string> findNormalLayer(const LayeredImage& image) {
  return findLayer(image, {"denoising normal", "ns", "sh_normal", "nn", "normal", "n"});
}

}  // namespace odis::eval
