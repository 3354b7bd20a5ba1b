// Images that are too small for the denoiser's filters, whose borders count as black, with mirrored copies of
// themselves around.
#pragma once

#include <vector>

namespace odis::render {

class Margin {
 public:
  Margin(int width, int height) : m_x(width), m_y(height) {}

  int width() const { return m_x.padded; }
  int height() const { return m_y.padded; }

  // As it is where no side is short.
  template <class Pixel>
  std::vector<Pixel> add(std::vector<Pixel> image) const {
    if (image.empty() || isNone()) return image;
    std::vector<Pixel> result;
    result.reserve(size_t(width()) * size_t(height()));
    for (int y = 0; y < height(); ++y)
      for (int x = 0; x < width(); ++x)
        result.push_back(image[size_t(m_y.source(y)) * size_t(m_x.size) + size_t(m_x.source(x))]);
    return result;
  }
  template <class Pixel>
  std::vector<Pixel> remove(std::vector<Pixel> padded) const {
    if (isNone()) return padded;
    std::vector<Pixel> result;
    for (int y = 0; y < m_y.size; ++y)
      for (int x = 0; x < m_x.size; ++x)
        result.push_back(padded[size_t(y + m_y.offset()) * size_t(width()) + size_t(x + m_x.offset())]);
    return result;
  }

 private:
  struct Axis {
    static constexpr int kShort = 16, kPadded = 32;
    explicit Axis(int pixels) : size(pixels), padded(pixels < kShort ? kPadded : pixels) {}

    int offset() const { return (padded - size) / 2; }
    // Where a place is from: 2 1 0 0 1 2 2 1 0 ...
    int source(int place) const {
      const int period = 2 * size, at = (place - offset() + kPadded * period) % period;
      return at < size ? at : period - 1 - at;
    }

    int size, padded;
  };
  bool isNone() const { return m_x.padded == m_x.size && m_y.padded == m_y.size; }

  Axis m_x, m_y;
};

}  // namespace odis::render
