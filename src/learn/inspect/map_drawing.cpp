#include "learn/inspect/map_drawing.h"

#include <fmt/format.h>

#include <cmath>

#include "render/image/magma.h"

namespace odis::learn {

namespace {

render::Rgb stopsColor(float stops) {
  return render::magma((stops - kLeastMapStops) / (kMostMapStops - kLeastMapStops));
}

}  // namespace

render::Rgb mapColor(float value, MapColors colors) {
  if (std::isnan(value)) return kUnsampled;
  if (colors == MapColors::values) return render::Rgb(value);
  return value > 0 ? stopsColor(std::log2(value)) : render::Rgb(0.0f);
}

void drawMap(Canvas& canvas, render::Vec2i at, int size, const SquareMap& map, MapColors colors) {
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const int texel = y * map.side / size * map.side + x * map.side / size;
      canvas.set(at.x + x, at.y + y, mapColor(map.values[size_t(texel)], colors));
    }
}

ColorScale mapScale() {
  return {kLeastMapStops, kMostMapStops, stopsColor,
          fmt::format("{:+.0f} to {:+.0f} stops about an even map", kLeastMapStops, kMostMapStops)};
}

void drawScale(Canvas& canvas, render::Vec2i at, int width, const ColorScale& scale) {
  constexpr int kHeight = 8, kSpace = 8;
  for (int x = 0; x < width; ++x)
    canvas.fill(at.x + x, at.y, 1, kHeight,
                scale.colorOf(scale.from + (scale.to - scale.from) * float(x) / float(width - 1)));
  canvas.write(at.x + width + kSpace, at.y + 1, canvas.width, scale.words, kInk);
}

}  // namespace odis::learn
