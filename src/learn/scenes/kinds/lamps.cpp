#include "learn/scenes/lamps.h"

#include "learn/scenes/furnish.h"
#include "learn/scenes/kinds.h"

namespace odis::learn {

// Light within shades: most surfaces see a patch of lit ceiling and wall, few the bulb.
void buildLamps(Draft& draft) {
  Random& random = draft.random;
  Room room = anyRoom(random);
  addShell(draft, room);
  for (int i = random.integer(0, 3); i > 0; --i) {
    const Box box = room.box();
    const Vec2 at(float(random.range(box.min.x, box.max.x)), float(random.range(box.min.y, box.max.y)));
    if (room.contains(at, 0.6f))
      draft.add(makePendant(draft, float(random.range(0.3, room.height - 1.7)), random.logRange(5, 80)),
                {at.x, at.y, room.height}, 0);
  }
  for (int i = random.integer(0, 3); i > 0; --i) {
    const auto wall = size_t(random.integer(0, int(room.corners.size()) - 1));
    addSconce(draft, room, wall, room.length(wall) * float(random.range(0.1, 0.9)),
              float(random.range(1.4, 1.9)), random.logRange(5, 40));
  }
  furnish(draft, room, anyTheme(random), random.range(0.2, 1), random.integer(1, 5),
          random.logRange(10, 200));
}

}  // namespace odis::learn
