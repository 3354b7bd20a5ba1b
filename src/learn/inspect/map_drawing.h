// Maps and what their colours mean, drawn on a canvas.
#pragma once

#include <functional>
#include <string>

#include "learn/inspect/inspect.h"
#include "learn/scenes/canvas.h"

namespace odis::learn {

// Values of maps over an even one: in false colours of stops, or as they are.
enum class MapColors { stops, values };

inline constexpr float kLeastMapStops = -5, kMostMapStops = 7;  // where false colours begin and end
inline const render::Rgb kBackground(0.02f), kInk(0.75f), kUnsampled(0.0f, 0.02f, 0.1f);

render::Rgb mapColor(float value, MapColors colors);

// Draws size x size pixels.
void drawMap(Canvas& canvas, render::Vec2i at, int size, const SquareMap& map, MapColors colors);

// A range of stops: its colours, then words.
struct ColorScale {
  float from, to;
  std::function<render::Rgb(float stops)> colorOf;
  std::string words;
};
ColorScale mapScale();
void drawScale(Canvas& canvas, render::Vec2i at, int width, const ColorScale& scale);

}  // namespace odis::learn
