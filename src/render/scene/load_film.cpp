#include "render/scene/load_film.h"

#include <cmath>

#include "render/image/limits.h"
#include "render/xml/names.h"

namespace odis::render {
namespace {

// Of widths and heights; crops begin at 0.
constexpr NumberRange kSizes = between(1, kMaxImageSide), kOffsets = between(0, kMaxImageSide);

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

std::shared_ptr<const Filter> loadMitchell(const Properties& node) {
  const auto number = [&](const char* name) {
    const float value = node.number(name, kMitchellRange, 1.0f / 3.0f);
    node.describeFallback(name, "1/3");
    return value;
  };
  const float a = number("a"), b = number("b"), c = number("c");
  // The two are called b and c, or a and b.
  return node.has("a") ? makeMitchellFilter(a, b) : makeMitchellFilter(b, c);
}

std::shared_ptr<const Filter> loadFilter(const Properties* node, Warnings& warnings) {
  if (!node) return makeGaussianFilter();
  if (node->type == "box") return makeBoxFilter(node->number("radius", kFilterRadius, 0.5f));
  if (node->type == "tent") return makeTentFilter(node->number("radius", kFilterRadius, 1.0f));
  if (node->type == "gaussian") return makeGaussianFilter(node->number("stddev", kFilterRadius, 0.5f));
  if (node->type == "mitchell") return loadMitchell(*node);
  if (node->type == "lanczos") return makeLanczosFilter(int(node->integer("lobes", kFilterLobes, 3)));
  if (node->type == "catmullrom") return makeMitchellFilter(0.0f, 0.5f);
  warnings.add(node->location,
               "the filter '" + node->type + "' is unknown" +
                   suggestion(node->type, {"box", "tent", "gaussian", "mitchell", "catmullrom", "lanczos"}) +
                   ", a gaussian is used");
  return makeGaussianFilter();
}

}  // namespace

FilmSettings loadFilm(const Properties* node, const LoadOptions& options, Warnings& warnings) {
  const Properties absent;
  const Properties& film = node ? *node : absent;
  const std::string& type = film.type;
  if (type == "specfilm")
    warnings.add(film.location, "the film 'specfilm' is drawn as RGB, its spectral bands are left out");
  else if (node && type != "hdrfilm" && type != "ldrfilm" && type != "mfilm" && type != "tiledhdrfilm")
    warnings.add(film.location, "the film '" + type + "' is unknown" +
                                    suggestion(type, {"hdrfilm", "ldrfilm", "mfilm", "tiledhdrfilm"}) +
                                    ", its size and filter are used");
  FilmSettings result;
  result.width = int(film.integer("width", kSizes, 768));
  result.height = int(film.integer("height", kSizes, 576));
  const Properties* filter = film.child("rfilter");
  result.filter = loadFilter(filter, warnings);
  if (filter) warnOfMisspelt(*filter, warnings);
  result.sampleBorder = film.boolean("sample_border", false);
  std::optional<Vec2i> resolution = options.resolution;
  if (!resolution && options.pixels > 0) {
    const double aspect = double(result.width) / result.height;
    resolution = Vec2i(std::max(1, int(std::lround(std::sqrt(options.pixels * aspect)))),
                       std::max(1, int(std::lround(std::sqrt(options.pixels / aspect)))));
  }
  if (resolution) {
    const Vec2i size = *resolution;
    if (size.x < 1 || size.y < 1 || size.x > kMaxImageSide || size.y > kMaxImageSide)
      throw OptionError("found the resolution " + std::to_string(size.x) + "x" + std::to_string(size.y) +
                        ", expected 1 to " + std::to_string(kMaxImageSide) + " pixels a side");
    result.width = size.x;
    result.height = size.y;
  }
  const int64_t x = film.integer("crop_offset_x", kOffsets, 0),
                y = film.integer("crop_offset_y", kOffsets, 0),
                width = film.integer("crop_width", kSizes, result.width),
                height = film.integer("crop_height", kSizes, result.height);
  film.describeFallback("crop_width", "width");
  film.describeFallback("crop_height", "height");
  warnOfMisspelt(film, warnings);
  result.crop = {0, 0, result.width, result.height};
  if (options.crop) {
    const Crop& crop = *options.crop;
    const std::string fault = cropFault(result, crop.x, crop.y, crop.width, crop.height);
    if (!fault.empty()) throw OptionError(fault);
    result.crop = crop;
  } else if (!resolution) {
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
