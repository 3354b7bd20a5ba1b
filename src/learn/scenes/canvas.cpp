#include "learn/scenes/canvas.h"

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb_easy_font.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

#include <algorithm>

namespace odis::learn {

using render::Rgb;

Canvas::Canvas(int w, int h, const Rgb& background)
    : width(w), height(h), pixels(size_t(w) * size_t(h), background) {}

void Canvas::set(int x, int y, const Rgb& color) {
  if (x >= 0 && y >= 0 && x < width && y < height) pixels[size_t(y) * size_t(width) + size_t(x)] = color;
}

void Canvas::fill(int x, int y, int columns, int rows, const Rgb& color) {
  for (int py = y; py < y + rows; ++py)
    for (int px = x; px < x + columns; ++px) set(px, py, color);
}

void Canvas::write(int x, int y, int columns, const std::string& text, const Rgb& color) {
  struct Corner {
    float x, y, z;
    uint8_t color[4];
  };
  constexpr size_t kMostQuads = 16;  // of a letter
  std::vector<Corner> corners(4 * kMostQuads * (text.size() + 1));
  std::string shown = text;
  const int quads = stb_easy_font_print(float(x), float(y), shown.data(), nullptr, corners.data(),
                                        int(corners.size() * sizeof(Corner)));
  for (int q = 0; q < quads; ++q) {
    const Corner &from = corners[size_t(4 * q)], &to = corners[size_t(4 * q + 2)];
    const int right = std::min(int(to.x), x + columns);
    fill(int(from.x), int(from.y), right - int(from.x), int(to.y) - int(from.y), color);
  }
}

}  // namespace odis::learn
