// A film of a host's own: samples are splatted into five layers with a Gaussian.
#pragma once

#include "host.h"

enum Layer { kColor, kAlbedo, kNormal, kLight0, kLight1, kLayers };
constexpr const char* kLayerNames[kLayers] = {"color", "albedo", "normal", "light0", "light1"};

// The pixels [x0, x1) x [y0, y1) of an image.
struct Rectangle {
  int x0, y0, x1, y1;
};

class Film {
 public:
  static constexpr float kRadius = 1.5f;  // of the filter, in pixels
  // How far from its pixel a sample may reach, in whole pixels.
  static constexpr int kBorder = 2;

  explicit Film(const Rectangle& area)
      : m_area(area), m_pixels(size_t(area.x1 - area.x0) * size_t(area.y1 - area.y0)) {}

  // Adds a sample to all pixels that it reaches. What is not finite counts as black, with its weight.
  void splat(const Traced& s, float weight) {
    Vec3 values[kLayers] = {s.color, s.albedo, s.normal, s.byLight[0], s.byLight[1]};
    for (Vec3& v : values)
      if (!std::isfinite(v.x + v.y + v.z)) v = {};
    const auto first = [](float at, int begin) {
      return std::max(int(std::floor(at - kRadius - 0.5f)) + 1, begin);
    };
    const auto end = [](float at, int end) {
      return std::min(int(std::floor(at + kRadius - 0.5f)) + 1, end);
    };
    for (int y = first(s.y, m_area.y0); y < end(s.y, m_area.y1); ++y)
      for (int x = first(s.x, m_area.x0); x < end(s.x, m_area.x1); ++x) {
        const float f = weight * filter(float(x) + 0.5f - s.x) * filter(float(y) + 0.5f - s.y);
        Pixel& pixel = at(x, y);
        for (int i = 0; i < kLayers; ++i) pixel.sums[i] = pixel.sums[i] + values[i] * f;
        pixel.weights += f;
      }
  }
  // Adds the sums of a film whose area lies in this one's.
  void add(const Film& part) {
    for (int y = part.m_area.y0; y < part.m_area.y1; ++y)
      for (int x = part.m_area.x0; x < part.m_area.x1; ++x) {
        const Pixel& from = part.m_pixels[part.index(x, y)];
        Pixel& pixel = at(x, y);
        for (int i = 0; i < kLayers; ++i) pixel.sums[i] = pixel.sums[i] + from.sums[i];
        pixel.weights += from.weights;
      }
  }
  // The ratio of both sums; black where there is nothing.
  Vec3 value(Layer layer, int x, int y) const {
    const Pixel& pixel = m_pixels[index(x, y)];
    return pixel.weights > 0 ? pixel.sums[layer] / pixel.weights : Vec3();
  }
  // Its bytes, to be saved with a frame.
  odis::ArrayView<const uint8_t> bytes() const {
    return {reinterpret_cast<const uint8_t*>(m_pixels.data()), m_pixels.size() * sizeof(Pixel)};
  }
  void restore(odis::ArrayView<const uint8_t> saved) {
    if (saved.size() != m_pixels.size() * sizeof(Pixel))
      throw std::runtime_error("the film has another size");
    std::copy(saved.begin(), saved.end(), reinterpret_cast<uint8_t*>(m_pixels.data()));
  }

  // Writes each layer to NAME-layer.pfm (linear 32-bit floats, bottom row first).
  void write(const std::string& name) const {
    for (int i = 0; i < kLayers; ++i) {
      const std::string path = name + "-" + kLayerNames[i] + ".pfm";
      std::FILE* file = std::fopen(path.c_str(), "wb");
      if (!file) throw std::runtime_error("can't write '" + path + "'");
      std::fprintf(file, "PF\n%d %d\n-1.0\n", m_area.x1 - m_area.x0, m_area.y1 - m_area.y0);
      for (int y = m_area.y1 - 1; y >= m_area.y0; --y)
        for (int x = m_area.x0; x < m_area.x1; ++x) {
          const Vec3 v = value(Layer(i), x, y);
          std::fwrite(&v, sizeof v, 1, file);
        }
      if (std::fclose(file) != 0) throw std::runtime_error("can't write '" + path + "'");
    }
  }

 private:
  struct Pixel {
    Vec3 sums[kLayers];
    float weights = 0;
  };
  static float filter(float x) { return std::exp(-2 * x * x) - std::exp(-2 * kRadius * kRadius); }
  size_t index(int x, int y) const {
    return size_t(y - m_area.y0) * size_t(m_area.x1 - m_area.x0) + size_t(x - m_area.x0);
  }
  Pixel& at(int x, int y) { return m_pixels[index(x, y)]; }

  Rectangle m_area;
  std::vector<Pixel> m_pixels;
};

inline Rectangle wholeImage(const Settings& settings) {
  return {0, 0, int(settings.width), int(settings.height)};
}
