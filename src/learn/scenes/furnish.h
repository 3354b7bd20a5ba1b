// Fills rooms: what stands in them and hangs on their walls.
#pragma once

#include "learn/scenes/room.h"

namespace odis::learn {

enum class Theme { living, sleeping, eating, working, storing, bare };
Theme anyTheme(Random& random);

// Furnishes a room whose openings are cut already: doors stay free, high things don't stand before windows.
// `lamps` puts that many lamps, of this power together, on tables and floor.
void furnish(Draft& draft, Room& room, Theme theme, double density, int lamps = 0, double power = 0);

// Puts a piece with its back to a wall, or on free floor; false if there is no room for it.
bool placeAtWall(Draft& draft, Room& room, const Piece& piece);
bool placeFree(Draft& draft, Room& room, const Piece& piece, float angle);

// Pictures and mirrors on the walls.
void hangPictures(Draft& draft, Room& room, int count, double mirrors);

}  // namespace odis::learn
