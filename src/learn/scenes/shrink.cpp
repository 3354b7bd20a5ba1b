#include "learn/scenes/shrink.h"

#include <stb_image_write.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "render/image/image.h"
#include "render/image/tonemap.h"
#include "render/image/write.h"

namespace odis::learn {

using render::Image;
using render::Rgb;

namespace {

struct Small {
  int width, height;
  std::vector<Rgb> pixels;
};

// Averages over blocks of n x n pixels, the least n that makes it fit; what is left over at the edges goes.
Small shrunk(const Image& image, int mostWidth, int mostHeight) {
  int n = 1;
  while (image.width() / n > mostWidth || image.height() / n > mostHeight) ++n;
  Small result{std::max(1, image.width() / n), std::max(1, image.height() / n), {}};
  for (int y = 0; y < result.height; ++y)
    for (int x = 0; x < result.width; ++x) {
      Rgb sum(0.0f);
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) sum += image.rgb(x * n + i, y * n + j);
      result.pixels.push_back(sum / float(n * n));
    }
  return result;
}

}  // namespace

std::string shrunkTexture(const std::string& path) {
  const Small small = shrunk(*Image::read(path, true, {path}), 320, 320);
  std::vector<uint8_t> bytes;
  for (const Rgb& pixel : small.pixels)
    for (int c = 0; c < 3; ++c) bytes.push_back(render::toByte(pixel[c]));
  return render::encodePng(small.width, small.height, 3, bytes.data());
}

bool isVividTexture(const std::string& path) {
  const Small small = shrunk(*Image::read(path, true, {path}), 32, 32);
  Rgb mean(0.0f);
  for (const Rgb& pixel : small.pixels) mean += pixel / float(small.pixels.size());
  const auto [least, most] = std::minmax({mean.x, mean.y, mean.z});
  return most - least > 0.3f && least < 0.1f * most;
}

std::string shrunkEnvironment(const std::string& path) {
  const Small small = shrunk(*Image::read(path, false, {path}), 512, 256);
  return encodeHdr(small.width, small.height, small.pixels);
}

std::string encodeHdr(int width, int height, const std::vector<Rgb>& pixels) {
  std::string encoded;
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<char*>(data), size_t(size));
  };
  if (!stbi_write_hdr_to_func(append, &encoded, width, height, 3, &pixels[0].x))
    throw std::runtime_error("the HDR encoder ran out of memory");
  return encoded;
}

}  // namespace odis::learn
