#include "inspect_saved.h"

#include <fmt/format.h>

#include <filesystem>

#include "command.h"
#include "learn/inspect/saved_output.h"
#include "output.h"
#include "render/image/write.h"

namespace odis::app {

using namespace render;

namespace {

RenderedImage imageOfPixels(int width, int height, const std::vector<Rgb>& pixels) {
  RenderedImage image;
  image.width = width;
  image.height = height;
  image.color = pixels;
  return image;
}

void writeFrame(const std::string& path, const learn::FrameSummary& frame) {
  const RenderedImage image = imageOfPixels(int(frame.width), int(frame.height), frame.image);
  if (endsWith(path, ".png")) return writePreview(path, image, 0);
  FilmSettings film;
  film.width = image.width;
  film.height = image.height;
  writeLayers(path, image, film, {}, {});
}

}  // namespace

void writeCanvas(const std::string& path, const learn::Canvas& canvas) {
  
}

}  // namespace odis::app
