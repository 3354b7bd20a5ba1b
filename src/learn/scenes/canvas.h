// A picture to be put together: rectangles, other pictures, small text.
#pragma once

#include <string>
#include <vector>

#include "render/math/vec.h"

namespace odis::learn {

struct Canvas {
  Canvas() = default;
  Canvas(int width, int height, const render::Rgb& background);

  int width = 0, height = 0;
  std::vector<render::Rgb> pixels;  // linear

  // What lies outside is left out.
  void set(int x, int y, const render::Rgb& color);
  void fill(int x, int y, int columns, int rows, const render::Rgb& color);
  // A line of text, 7 pixels high, about 6 a letter wide; nothing right of x + `columns`.
  void write(int x, int y, int columns, const std::string& text, const render::Rgb& color);
};

}  // namespace odis::learn
