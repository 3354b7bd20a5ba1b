#include "learn/scenes/house.h"

#include <algorithm>

#include "learn/scenes/skies.h"

namespace odis::learn {

std::optional<Room> attachRoom(Random& random, Room& room, const WallSpan& span, float depth,
                               const Vec2& door) {
  const size_t wall = span.wall;
  const float from = span.from, to = span.to, doorWidth = door.x,
              doorHeight = std::min(door.y, room.height - 0.1f);
  const float margin = 0.2f, space = to - from - doorWidth - 2 * margin;
  if (space < 0 || from < 0 || to > room.length(wall)) return {};
  const float left = from + margin + space * float(random.unit()), right = left + doorWidth;
  for (const Opening& o : room.openings)
    if (o.wall == wall && left < o.right + 0.1f && o.left < right + 0.1f) return {};
  room.openings.push_back({wall, left, right, 0, doorHeight});
  const auto place = [&](float s, float d) {
    const Vec3 p = room.at(wall, s, -2 * room.thickness - d, 0);
    return Vec2(p.x, p.y);
  };
  Room result;
  result.height = room.height;
  result.thickness = room.thickness;
  result.corners = {place(to, 0), place(from, 0), place(from, depth), place(to, depth)};
  result.openings.push_back({0, to - right, to - left, 0, doorHeight});
  return result;
}

int cutWindows(Random& random, Room& room, size_t wall, int count) {
  // From slits to the whole wall; most are as large as in a home.
  const bool tall = random.chance(0.25), slit = random.chance(0.12);
  const auto width =
      std::min(float(slit ? random.range(0.15, 0.5) : random.logRange(0.7, 3.5)), room.length(wall) * 0.8f);
  const auto bottom = tall ? 0.32f : float(random.range(0.7, 1.3));
  const float top = std::min(room.height - 0.1f, bottom + float(random.logRange(0.7, 2.2)));
  int cut = 0;
  for (int i = 0; i < count; ++i) cut += room.open(random, wall, width, bottom, top).has_value();
  return cut;
}

void addWindows(Draft& draft, Room& room) {
  for (const Opening& o : std::vector<Opening>(room.openings))
    if (o.bottom > 0.3f) addWindow(draft, room, o);
}

Vec3 sunThrough(Random& random, const Room& room, size_t wall) {
  const Vec2 out = -room.inward(wall);
  const double azimuth = std::atan2(out.y, out.x) + random.range(-1, 1);
  return skyDirection(azimuth, random.range(0.1, 1.1));
}

}  // namespace odis::learn
