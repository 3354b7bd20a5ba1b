#include <algorithm>

#include "learn/scenes/furnish.h"
#include "learn/scenes/house.h"
#include "learn/scenes/kinds.h"
#include "learn/scenes/lamps.h"
#include "learn/scenes/skies.h"

namespace odis::learn {

// One to three rooms about a first one; light in some, which enters the others through doors more or less
// open.
void buildDoors(Draft& draft) {
  Random& random = draft.random;
  Room room =
      boxRoom({0, 0}, float(random.range(3, 6.5)), float(random.range(2.8, 5)), float(random.range(2.3, 3)));
  room.thickness = float(random.range(0.05, 0.12));
  std::vector<Room> rooms;
  const int count = random.integer(1, 3), firstWall = random.integer(0, 3);
  for (int i = 0; i < count; ++i) {
    const auto wall = size_t(firstWall + i) % 4;
    const float length = room.length(wall), width = length * float(random.range(0.55, 1)),
                from = (length - width) * float(random.unit());
    std::optional<Room> other =
        attachRoom(random, room, {wall, from, from + width}, float(random.range(2, 5)),
                   {random.chance(0.8) ? 0.9f : 1.6f, 2.05f});
    if (other) rooms.push_back(*other);
  }
  const std::vector<Opening> doors = room.openings;
  // The first room is mostly dark; at least one other is lit, by lamps or by day.
  const bool day = random.chance(0.45);
  for (Room& other : rooms)
    if (day) cutWindows(random, other, 2, random.integer(1, 2));
  addShell(draft, room);
  for (size_t i = 0; i < doors.size(); ++i) {
    const double ajar = random.weighted({1.5, 4, 2}) == 0 ? 2 : random.logRange(0.12, 1.9);
    if (doors[i].width() < 1.2f) addDoor(draft, room, doors[i], float(std::min(ajar, 1.9)));
    draft.scene.interests.push_back(room.at(doors[i].wall, (doors[i].left + doors[i].right) / 2, 0, 1.1f));
  }
  const auto lit = size_t(random.integer(0, std::max(0, int(rooms.size()) - 1)));
  const bool allSeen = random.chance(0.35);
  for (size_t i = 0; i < rooms.size(); ++i) {
    Room& other = rooms[i];
    addShell(draft, other);
    addWindows(draft, other);
    if (!day && (i == lit || random.chance(0.25))) lightRoom(draft, other, random.logRange(30, 300));
    furnish(draft, other, anyTheme(random), random.range(0.1, 0.7));
    // Mostly the cameras stay in the first room.
    if (!allSeen) draft.scene.standing.pop_back();
  }
  if (day && !rooms.empty()) addSky(draft, sunThrough(random, rooms[lit], 2));
  if (random.chance(0.15)) lightRoom(draft, room, random.logRange(0.5, 20));
  furnish(draft, room, anyTheme(random), random.range(0.2, 1));
}

}  // namespace odis::learn
