#include "learn/scenes/description.h"

#include <algorithm>

namespace odis::learn {

bool contains(std::span<const Vec2> polygon, const Vec2& p, float margin) {
  // Crossings of a ray to the right tell whether it is inside, distances to the edges how far.
  bool inside = false;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 a = polygon[i], d = polygon[(i + 1) % polygon.size()] - a;
    if ((a.y > p.y) != (a.y + d.y > p.y) && p.x < a.x + d.x * (p.y - a.y) / d.y) inside = !inside;
    const float s = std::clamp((p - a).dot(d) / d.dot(d), 0.0f, 1.0f);
    if ((p - a - d * s).length() < margin) return false;
  }
  return inside;
}

Box boxAround(std::span<const Vec2> polygon, float bottom, float top) {
  Box box{{polygon[0].x, polygon[0].y, bottom}, {polygon[0].x, polygon[0].y, top}};
  for (const Vec2& p : polygon) {
    box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y), bottom};
    box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y), top};
  }
  return box;
}

}  // namespace odis::learn
