// Lights to build into rooms, most of them with something in front. Powers are relative: exposure comes
// later.
#pragma once

#include "learn/scenes/room.h"

namespace odis::learn {

// White of some warmth, now and then a colour; of luminance one.
Rgb lightColor(Random& random);
// What a surface of so many square metres radiates at this power (W, of luminance): power / (pi area).
Rgb radianceOf(Random& random, double power, double area);

// Light bulbs are balls, bare or in a globe of glass, of which nothing is further than `room` from the
// centre: a bulb that touches its shade is lit differently by every renderer, as shadow rays end a little
// before the light.
void addBulb(Draft& draft, Piece& piece, const Vec3& at, double power, float room);

Piece makeTableLamp(Draft& draft, double power);
Piece makeFloorLamp(Draft& draft, double power);  // with a shade, or a bowl that lights the ceiling
// Hangs in its origin, `drop` below: a shade, a globe or a dome.
Piece makePendant(Draft& draft, float drop, double power);

// A rectangle of light that faces `facing`, with u and v as its sides; `housing` puts a shallow box around
// it.
struct Rectangle {
  Vec3 corner, u, v;  // u and v: its sides
};
void addLightPanel(Draft& draft, const Rectangle& rectangle, const Vec3& facing, double power, bool housing);
void addCeilingPanel(Draft& draft, const Room& room, const Vec2& at, const Vec2& half, double power);
// Discs of light at the bottom of short tubes below the ceiling.
void addDownlight(Draft& draft, const Vec3& ceiling, float radius, double power);
// A fluorescent tube.
void addTube(Draft& draft, const Vec3& from, const Vec3& to, float radius, double power);
// A half-open box on a wall that lights it upwards, downwards or both ways.
void addSconce(Draft& draft, const Room& room, size_t wall, float s, float z, double power);
// A ledge along walls, below the ceiling, that hides a strip of light shining upwards.
void addCove(Draft& draft, const Room& room, size_t wall, double power);
// A board in front of a wall with strips of light behind its edges.
void addGlowingBoard(Draft& draft, const Room& room, size_t wall, const Vec2& center, const Vec2& half,
                     double power);

// The usual lights of a room: one to a few of the above.
void lightRoom(Draft& draft, Room& room, double power);

}  // namespace odis::learn
