// Windows in a shard: docs/dataset-incident-radiance.md.
#include <fmt/format.h>

#include "learn/data/make_shard.h"
#include "learn/data/windows.h"

namespace odis::learn {

namespace {

using Pixel = WindowView::Pixel;

// Adds an array of numbers of pixels: [component][window][row][column].
class PixelColumns {
 public:
  PixelColumns(ShardWriter& writer, std::string prefix, const WindowView& view, int size)
      : m_writer(writer), m_prefix(std::move(prefix)), m_pixels(view.pixels) {
    m_shape = {view.windows.size(), size_t(size), size_t(size)};
  }

  void add(const char* name, float Pixel::*field, float scale = 1) {
    std::vector<Half> values;
    for (const Pixel& pixel : m_pixels) values.push_back(toHalf(pixel.*field * scale));
    m_writer.add(m_prefix + name, m_shape, std::span<const Half>(values));
  }
  template <class Vector>
  void add(const char* name, Vector Pixel::*field) {
    std::vector<Half> values;
    for (float Vector::*component : {&Vector::x, &Vector::y, &Vector::z})
      for (const Pixel& pixel : m_pixels) values.push_back(toHalf(pixel.*field.*component));
    Shape shape{3};
    shape.insert(shape.end(), m_shape.begin(), m_shape.end());
    m_writer.add(m_prefix + name, shape, std::span<const Half>(values));
  }
  void add(const char* name, uint8_t Pixel::*field) {
    std::vector<uint8_t> values;
    for (const Pixel& pixel : m_pixels) values.push_back(pixel.*field);
    m_writer.add(m_prefix + name, m_shape, std::span<const uint8_t>(values));
  }

 private:
  ShardWriter& m_writer;
  std::string m_prefix;
  const std::vector<Pixel>& m_pixels;
  Shape m_shape;
};

}  // namespace

std::string windowPrefix(size_t view) {
  return fmt::format("view{}/window/", view);
}

void addColumns(ShardWriter& writer, size_t view, const WindowView& content, int size) {
  for (size_t i = 0; i < content.pilots.size(); ++i)
    addColumns(writer, pilotPrefix(view, i), content.pilots[i], content.frame);
  addMapColumns(writer, targetPrefix(view), content.targets, kWindowMapSize, content.frame);
  std::vector<Half> noise;
  for (const float value : content.noise) noise.push_back(toHalf(value));
  writer.add(targetPrefix(view) + "window", {content.windowOf.size()},
             std::span<const uint16_t>(content.windowOf));
  writer.add(targetPrefix(view) + "noise", {noise.size()}, std::span<const Half>(noise));

  std::vector<uint16_t> x, y;
  for (const Window& window : content.windows) {
    x.push_back(uint16_t(window.x));
    y.push_back(uint16_t(window.y));
  }
  writer.add(windowPrefix(view) + "x", {x.size()}, std::span<const uint16_t>(x));
  writer.add(windowPrefix(view) + "y", {y.size()}, std::span<const uint16_t>(y));
  const float edges = 1 / content.frame.edge;
  PixelColumns pixels(writer, windowPrefix(view), content, size);
  pixels.add("albedo", &Pixel::albedo);
  pixels.add("albedoVariance", &Pixel::albedoVariance);
  pixels.add("normal", &Pixel::normal);
  pixels.add("normalVariance", &Pixel::normalVariance);
  pixels.add("depth", &Pixel::depth, edges);
  pixels.add("depthVariance", &Pixel::depthVariance, edges * edges);
  pixels.add("roughness", &Pixel::roughness);
  pixels.add("roughnessVariance", &Pixel::roughnessVariance);
  pixels.add("hits", &Pixel::hits);
}

}  // namespace odis::learn
