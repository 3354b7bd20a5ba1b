#include "learn/scenes/furnish.h"
#include "learn/scenes/kinds.h"
#include "learn/scenes/lamps.h"

namespace odis::learn {

void buildRoom(Draft& draft) {
  Random& random = draft.random;
  Room room = anyRoom(random);
  std::optional<Opening> door;
  if (random.chance(0.7))
    door = room.open(random, size_t(random.integer(0, int(room.corners.size()) - 1)), 0.9f, 0, 2.05f);
  addShell(draft, room);
  if (door) addDoor(draft, room, *door, 0);
  // One system of lamps, or two that may be of very different power.
  for (int i = random.chance(0.4) ? 2 : 1; i > 0; --i) lightRoom(draft, room, random.logRange(20, 300));
  const int lamps = random.chance(0.5) ? random.integer(1, 3) : 0;
  furnish(draft, room, anyTheme(random), random.range(0.2, 1), lamps, random.logRange(5, 200));
}

}  // namespace odis::learn
