#include "eval/image_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <new>

#include "eval/denoiser_layers.h"
#include "render/image/image.h"

namespace odis::eval {

// Whether the name is that of a format that only holds colours.
static bool isPlainImage(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  for (const char* known : {".png", ".jpg", ".jpeg", ".tga", ".bmp", ".hdr"})
    if (ending == known) return true;
  return false;
}

static render::ExrFile readPlainImage(const std::string& path) {
  const auto image = render::Image::read(path, true, {});
  render::ExrFile file;
  file.window = {image->width(), image->height(), 0, 0, image->width(), image->height()};
  for (int c = 0; c < 3; ++c) {
    std::vector<float>& plane = file.channels[std::string(1, "RGB"[c])];
    for (int y = 0; y < image->height(); ++y)
      for (int x = 0; x < image->width(); ++x) plane.push_back(image->rgb(x, y)[c]);
  }
  return file;
}

render::ExrFile readChannels(const std::string& path) {
  try {
    return isPlainImage(path) ? readPlainImage(path) : render::readExr(path);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw ImageError(error.what());
  }
}

ColorImage colorOf(const render::ExrFile& file, const std::string& path, const std::string& layer) {
  try {
    return layerColor(file, layer.empty() ? findImageLayer(file).value_or("") : layer);
  } catch (const ImageError& error) {
    throw ImageError(path + ": " + error.what());
  }
}

ColorImage readColor(const std::string& path, const std::string& layer) {
  return colorOf(readChannels(path), path, layer);
}

void writeColor(const std::string& path, const render::RenderedImage& frame, int fullWidth, int fullHeight,
                const std::map<std::string, std::string>& metadata) {
  std::array<std::vector<float>, 6> planes;
  const std::array<const char*, 6> names{"R", "G", "B", "variance.R", "variance.G", "variance.B"};
  std::vector<render::ImageChannel> channels;
  for (size_t i = 0; i < planes.size(); ++i) {
    const std::vector<render::Rgb>& pixels = i < 3 ? frame.color : frame.variance;
    if (pixels.empty()) continue;
    for (const render::Rgb& pixel : pixels) planes[i].push_back(pixel[int(i % 3)]);
    channels.push_back({names[i], planes[i].data()});
  }
  render::writeExr(path, {fullWidth, fullHeight, frame.x, frame.y, frame.width, frame.height}, channels,
                   metadata);
}

void writeColor(const std::string& path, const ColorImage& image) {
  render::RenderedImage frame;
  frame.width = image.width;
  frame.height = image.height;
  frame.color = image.pixels;
  writeColor(path, frame, image.width, image.height, {});
}

}  // namespace odis::eval
