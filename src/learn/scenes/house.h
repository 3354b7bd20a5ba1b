// Rooms beside rooms, and what the kinds of scenes have in common.
#pragma once

#include "learn/scenes/room.h"

namespace odis::learn {

// A box-shaped room behind a wall of another, joined by an opening in the wall between them, which is cut into
// both (the last of `room`, the only one of the new room's wall 0). None if there is no space: the new room lies
// between `from` and `to` along the wall.
std::optional<Room> attachRoom(Random& random, Room& room, size_t wall, float from, float to, float depth,
                               float doorWidth, float doorHeight);

// Cuts windows into a wall: as many as fit of one size.
int cutWindows(Random& random, Room& room, size_t wall, int count);
// Frames and all for every opening that does not reach the floor.
void addWindows(Draft& draft, Room& room);
// Where the sun has to be to shine through an opening.
Vec3 sunThrough(Random& random, const Room& room, size_t wall);

}  // namespace odis::learn
