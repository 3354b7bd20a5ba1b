#include "learn/scenes/furnish.h"
#include "learn/scenes/kinds.h"
#include "learn/scenes/lamps.h"

namespace odis::learn {

// All light comes by way of a wall or the ceiling.
void buildCove(Draft& draft) {
  Random& random = draft.random;
  Room room = anyRoom(random);
  std::optional<Opening> door;
  if (random.chance(0.5)) door = room.open(random, room.longestWalls()[0], 0.9f, 0, 2.05f);
  addShell(draft, room);
  if (door) addDoor(draft, room, *door, 0);
  const bool ledges = random.chance(0.7);
  if (ledges)
    for (size_t w = 0; w < room.corners.size(); ++w)
      if (w == 0 || random.chance(0.55)) addCove(draft, room, w, random.logRange(10, 60));
  if (!ledges || random.chance(0.25)) {
    for (const size_t wall : room.longestWalls()) {
      if (wall % 2 == 1 && random.chance(0.5)) continue;
      const Vec2 half(room.length(wall) * float(random.range(0.15, 0.35)),
                      room.height * float(random.range(0.15, 0.35)));
      const float s = room.length(wall) / 2;
      bool free = true;
      for (const Opening& o : room.openings)
        free = free && (o.wall != wall || o.right < s - half.x || o.left > s + half.x);
      if (!free) continue;
      addGlowingBoard(draft, room, wall, {s, room.height * 0.5f}, half, random.logRange(10, 60));
      // What is in front of the board stays low.
      room.openings.push_back({wall, s - half.x, s + half.x, room.height * 0.5f - half.y, room.height});
      draft.scene.interests.push_back(room.at(wall, s, 0.2f, room.height * 0.5f));
      if (random.chance(0.5)) break;
    }
  }
  furnish(draft, room, anyTheme(random), random.range(0.2, 1));
}

}  // namespace odis::learn
