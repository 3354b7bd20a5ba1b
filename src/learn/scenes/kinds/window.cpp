#include "learn/scenes/furnish.h"
#include "learn/scenes/house.h"
#include "learn/scenes/kinds.h"
#include "learn/scenes/lamps.h"
#include "learn/scenes/skies.h"

namespace odis::learn {

void buildWindow(Draft& draft) {
  Random& random = draft.random;
  Room room = anyRoom(random);
  room.thickness = float(random.range(0.15, 0.4));
  std::optional<Opening> door;
  const std::vector<size_t> walls = room.longestWalls();
  if (random.chance(0.6)) door = room.open(random, walls.back(), 0.9f, 0, 2.05f);
  // Windows in one wall or two, or in the roof.
  const size_t first = walls[size_t(random.integer(0, 1))];
  int windows = cutWindows(random, room, first, random.integer(1, 4));
  if (random.chance(0.3)) windows += cutWindows(random, room, walls[2], random.integer(1, 2));
  if (windows == 0 || random.chance(0.12)) {
    const Vec3 middle = room.middle();
    const auto half = float(random.logRange(0.15, 0.8));
    room.skylights.push_back({middle.x - half, middle.x + half, middle.y - half, middle.y + half});
  }
  addShell(draft, room);
  addWindows(draft, room);
  if (door) addDoor(draft, room, *door, 0);
  // Mostly the sun can shine in, so that patches of floor and wall light the rest.
  const Vec3 toSun = random.chance(0.75) ? sunThrough(random, room, first)
                                         : skyDirection(random.range(0, 6.28), random.range(0.1, 1.4));
  addSky(draft, toSun);
  if (random.chance(0.85)) addSurroundings(draft, room.box(), float(random.pick({0.21, 0.3, 3.0, 9.0})));
  if (random.chance(0.25)) lightRoom(draft, room, random.logRange(1, 30));
  furnish(draft, room, anyTheme(random), random.range(0.2, 1), random.chance(0.3) ? random.integer(1, 3) : 0,
          random.logRange(1, 50));
}

}  // namespace odis::learn
