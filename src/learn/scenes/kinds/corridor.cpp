#include "learn/scenes/furnish.h"
#include "learn/scenes/house.h"
#include "learn/scenes/kinds.h"
#include "learn/scenes/lamps.h"
#include "learn/scenes/skies.h"

namespace odis::learn {

// A long room with others along it, and perhaps a bend.
void buildCorridor(Draft& draft) {
  Random& random = draft.random;
  const auto width = float(random.range(1.2, 2.4)), length = float(random.range(6, 18)),
             height = float(random.range(2.2, 3));
  const bool bend = random.chance(0.5);
  Room hall = boxRoom({0, 0}, length, width, height);
  if (bend) {  // two arms of the same width
    const float depth = length * float(random.range(0.3, 0.8));
    hall = cornerRoom(length, depth, height, 1 - width / length, 1 - width / depth);
  }
  hall.thickness = 0.1f;
  // Rooms along the outer wall, some of them bright; doors of the others are closed.
  std::vector<Room> rooms;
  const int doors = random.integer(1, int(length / 2.2f));
  for (int i = 0; i < doors; ++i) {
    const float from = length * float(i) / float(doors), to = length * float(i + 1) / float(doors) - 0.25f;
    if (random.chance(0.75))
      if (auto room = attachRoom(random, hall, {0, from, to}, float(random.range(2, 4)), {0.9f, 2.05f}))
        rooms.push_back(*room);
  }
  const bool day = random.chance(0.4);
  if (day)
    for (Room& room : rooms) cutWindows(random, room, 2, 1);
  const bool endWindow = random.chance(0.3) && hall.open(random, 1, width * 0.6f, 0.9f, 2).has_value();
  const std::vector<Opening> openings = hall.openings;
  addShell(draft, hall);
  addWindows(draft, hall);
  const size_t lit = rooms.empty() ? 0 : size_t(random.integer(0, int(rooms.size()) - 1));
  for (size_t i = 0; i < rooms.size(); ++i) {
    const Opening& door = openings[i];
    const bool open = i == lit || random.chance(0.35);
    addDoor(draft, hall, door, open ? float(random.logRange(0.15, 1.7)) : 0);
    if (open) draft.scene.interests.push_back(hall.at(0, (door.left + door.right) / 2, 0, 1));
    addShell(draft, rooms[i]);
    addWindows(draft, rooms[i]);
    if (!day && (i == lit || random.chance(0.3))) lightRoom(draft, rooms[i], random.logRange(30, 300));
    furnish(draft, rooms[i], anyTheme(random), 0.3);
    draft.scene.standing.pop_back();
  }
  if (endWindow)
    addSky(draft, sunThrough(random, hall, 1));
  else if (day)
    addSky(draft, rooms.empty() ? skyDirection(0, 0.5) : sunThrough(random, rooms[lit], 2));
  // A few lamps at the far end, or all along.
  if (rooms.empty() || random.chance(0.4)) {
    const int lamps = random.integer(1, 6);
    const bool spread = random.chance(0.5);
    for (int i = 0; i < lamps; ++i) {
      const float x = spread ? length * (float(i) + 0.5f) / float(lamps) : length - 0.5f - 0.8f * float(i);
      if (x < 0.5f || (!spread && i > 1)) continue;
      addCeilingPanel(draft, hall, {x, width / 2}, {0.3f, 0.08f}, random.logRange(5, 30));
    }
  }
  furnish(draft, hall, Theme::bare, random.range(0.1, 0.6));
  hangPictures(draft, hall, random.integer(0, 8), 0.2);
  // Down the whole length.
  draft.scene.interests.push_back({length - 0.3f, width / 2, 1.2f});
  draft.scene.interests.push_back({0.3f, width / 2, 1.2f});
}

}  // namespace odis::learn
