#include "render/scene/load_film.h"

#include <cmath>

#include "render/image/limits.h"
#include "render/xml/names.h"

namespace odis::render {
namespace {

constexpr int64_t kMaxSize = kMaxImageSide;

const SourceLocation& placeOf(const Properties& node, const std::string& name) {
  const auto found = node.parameters.find(name);
  return found == node.parameters.end() ? node.location : found->second.location;
}

int dimension(const Properties& node, const std::string& name, int fallback) {
  const int64_t value = node.integer(name, fallback);
  if (value < 1 || value > kMaxSize)
    throw SceneError(placeOf(node, name), "found " + std::to_string(value) + " for '" + name +
                                              "' of the film, expected 1 to " + std::to_string(kMaxSize) +
                                              " pixels");
  return int(value);
}

// What is wrong with a crop; "" if nothing is.
std::string cropFault(const FilmSettings& film, int64_t x, int64_t y, int64_t width, int64_t height) {
  if (x >= 0 && y >= 0 && width >= 1 && height >= 1 && width <= film.width && height <= film.height &&
      x <= film.width - width && y <= film.height - height)
    return "";
  return "found a crop of " + std::to_string(width) + "x" + std::to_string(height) + " pixels at (" +
         std::to_string(x) + ", " + std::to_string(y) + "), expected one within the " +
         std::to_string(film.width) + "x" + std::to_string(film.height) + " pixels of the film";
}

// What is allocated is the crop.
bool tooLarge(const Crop& crop) {
  return uint64_t(crop.width) * uint64_t(crop.height) > kMaxImagePixels;
}

std::string sizeFault(const Crop& crop) {
  return "found an image of " + std::to_string(crop.width) + "x" + std::to_string(crop.height) +
         " pixels, expected at most " + std::to_string(kMaxImagePixels) + " in all";
}

float positive(const Properties& node, const std::string& name, float fallback) {
  const float value = node.number(name, fallback);
  if (value > 0 && value <= 100) return value;
  throw SceneError(placeOf(node, name), "found " + std::to_string(value) + " for '" + name +
                                            "' of the filter, expected more than 0 and at most 100 pixels");
}

std::shared_ptr<const Filter> loadFilter(const Properties* node, Warnings& warnings) {
  if (!node) return makeGaussianFilter();
  if (node->type == "box") return makeBoxFilter(positive(*node, "radius", 0.5f));
  if (node->type == "tent") return makeTentFilter(positive(*node, "radius", 1.0f));
  if (node->type == "gaussian") return makeGaussianFilter(positive(*node, "stddev", 0.5f));
  if (node->type == "mitchell") {
    // The two are called b and c, or a and b.
    const bool older = node->has("a");
    return makeMitchellFilter(node->number(older ? "a" : "b", 1.0f / 3.0f),
                              node->number(older ? "b" : "c", 1.0f / 3.0f));
  }
  if (node->type == "catmullrom") return makeMitchellFilter(0.0f, 0.5f);
  warnings.add(node->location,
               "the filter '" + node->type + "' is unknown" +
                   suggestion(node->type, {"box", "tent", "gaussian", "mitchell", "catmullrom"}) +
                   ", a gaussian is used");
  return makeGaussianFilter();
}

}  // namespace

FilmSettings loadFilm(const Properties* node, const LoadOptions& options, Warnings& warnings) {
  static const Properties absent;
  const Properties& film = node ? *node : absent;
  if (node && node->type != "hdrfilm" && node->type != "ldrfilm" && node->type != "mfilm")
    warnings.add(node->location, "the film '" + node->type + "' is unknown" +
                                     suggestion(node->type, {"hdrfilm", "ldrfilm", "mfilm"}) +
                                     ", only its size and filter are used");
  FilmSettings result;
  result.width = dimension(film, "width", 768);
  result.height = dimension(film, "height", 576);
  result.filter = loadFilter(film.child("rfilter"), warnings);
  std::optional<Vec2i> resolution = options.resolution;
  if (!resolution && options.pixels > 0) {
    const double aspect = double(result.width) / result.height;
    resolution = Vec2i(std::max(1, int(std::lround(std::sqrt(options.pixels * aspect)))),
                       std::max(1, int(std::lround(std::sqrt(options.pixels / aspect)))));
  }
  if (resolution) {
    const Vec2i size = *resolution;
    if (size.x < 1 || size.y < 1 || size.x > kMaxSize || size.y > kMaxSize)
      throw OptionError("found the resolution " + std::to_string(size.x) + "x" + std::to_string(size.y) +
                        ", expected 1 to " + std::to_string(kMaxSize) + " pixels a side");
    result.width = size.x;
    result.height = size.y;
  }
  result.crop = {0, 0, result.width, result.height};
  if (options.crop) {
    const Crop& crop = *options.crop;
    const std::string fault = cropFault(result, crop.x, crop.y, crop.width, crop.height);
    if (!fault.empty()) throw OptionError(fault);
    result.crop = crop;
  } else if (!resolution) {
    const int64_t x = film.integer("crop_offset_x", 0), y = film.integer("crop_offset_y", 0);
    const int64_t width = film.integer("crop_width", result.width),
                  height = film.integer("crop_height", result.height);
    const std::string fault = cropFault(result, x, y, width, height);
    if (!fault.empty()) throw SceneError(film.location, fault);
    result.crop = {int(x), int(y), int(width), int(height)};
  }
  if (tooLarge(result.crop)) {
    if (options.crop || resolution) throw OptionError(sizeFault(result.crop));
    throw SceneError(film.location, sizeFault(result.crop));
  }
  return result;
}

}  // namespace odis::render
