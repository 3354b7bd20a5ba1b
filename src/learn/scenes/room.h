// A room: floor, walls with openings, ceiling, and which of its floor is taken.
#pragma once

#include <optional>

#include "learn/scenes/draft.h"

namespace odis::learn {

// A rectangular opening in a wall; left and right are measured along the wall.
struct Opening {
  size_t wall;
  float left, right, bottom, top;
  float width() const { return right - left; }
  float height() const { return top - bottom; }
};

struct Room {
  std::vector<Vec2> corners;  // counter-clockwise; the room is to the left of its walls
  float height = 2.6f, thickness = 0.2f;
  std::vector<Opening> openings;
  std::vector<Hole> skylights;  // in x and y

  size_t next(size_t wall) const { return (wall + 1) % corners.size(); }
  Vec2 along(size_t wall) const { return (corners[next(wall)] - corners[wall]).normalized(); }
  Vec2 inward(size_t wall) const { return {-along(wall).y, along(wall).x}; }
  float length(size_t wall) const { return (corners[next(wall)] - corners[wall]).length(); }
  // A place `s` along a wall, `depth` into the room, z high.
  Vec3 at(size_t wall, float s, float depth, float z) const;
  // What turns +y to the inside of the room.
  float angle(size_t wall) const;
  Box box() const;
  Vec3 middle() const;
  bool contains(const Vec2& p, float margin) const;

  // Cuts an opening of this size into a wall, somewhere that is free, at least a hand from the corners;
  // none if it doesn't fit.
  std::optional<Opening> open(Random& random, size_t wall, float width, float bottom, float top);
  // The walls, the longest first.
  std::vector<size_t> longestWalls() const;

  // Takes a rectangle of the floor for something; false if a part of it is taken or outside.
  bool claim(const Vec3& center, const Vec2& half, float margin);
  // Gives a wall away that something of this depth stands before, all along: takes the floor below it, less
  // `inset`, and leaves no place for openings.
  void giveAway(size_t wall, float depth, float inset);

 private:
  struct Rectangle {
    Vec2 min, max;
  };
  std::vector<Rectangle> m_taken;
};

Room boxRoom(const Vec2& corner, float width, float depth, float height);
// A rectangle without its upper right corner, a share of either side.
Room cornerRoom(float width, float depth, float height, float shareX, float shareY);
// A convex polygon about an ellipse.
Room roundRoom(Random& random, float width, float depth, float height);
// One of these, of a random size: a closet to a hall.
Room anyRoom(Random& random);

// Floor, walls and ceiling, each with the openings; all of one scene's rooms get their walls this way. Also
// makes the room a place for cameras.
void addShell(Draft& draft, const Room& room);

// A door leaf in an opening, turned into the room by `angle` (radians; 0: closed), and its frame.
void addDoor(Draft& draft, const Room& room, const Opening& opening, float angle);
// Frame, bars and sill, and by chance a pane, blinds or curtains.
void addWindow(Draft& draft, const Room& room, const Opening& opening);

}  // namespace odis::learn
