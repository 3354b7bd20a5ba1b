// Rooms beside rooms, and what the kinds of scenes have in common.
#pragma once

#include "learn/scenes/room.h"

namespace odis::learn {

// A part of a wall, in metres along it.
struct WallSpan {
  size_t wall;
  float from, to;
};

// A box-shaped room behind a part of a wall of another, joined by an opening of the size `door` in the wall
// between them, which is cut into both (the last of `room`, the only one of the new room's wall 0). None if
// there is no space.
std::optional<Room> attachRoom(Random& random, Room& room, const WallSpan& span, float depth,
                               const Vec2& door);

// Cuts windows into a wall: as many as fit of one size.
int cutWindows(Random& random, Room& room, size_t wall, int count);
// Frames and all for every opening that does not reach the floor.
void addWindows(Draft& draft, Room& room);
// Where the sun has to be to shine through an opening.
Vec3 sunThrough(Random& random, const Room& room, size_t wall);

}  // namespace odis::learn
