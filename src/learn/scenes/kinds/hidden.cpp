#include "learn/scenes/furnish.h"
#include "learn/scenes/kinds.h"
#include "learn/scenes/lamps.h"

namespace odis::learn {

namespace {

// A closed box with a bulb in it and slits or holes in one side.
void addLightBox(Draft& draft, Room& room, double power) {
  Random& random = draft.random;
  const auto half = float(random.range(0.15, 0.4)), height = float(random.range(0.4, 1.4));
  Piece box;
  MeshData walls;
  constexpr float kThick = 0.02f;
  std::vector<Hole> holes;
  const int slits = random.integer(1, 8);
  const bool upright = random.chance(0.5);
  const auto share = float(random.logRange(0.06, 0.5));
  for (int i = 0; i < slits; ++i) {
    const float middle = (float(i) + 0.5f) / float(slits), width = share / float(slits) / 2;
    if (upright)
      holes.push_back({-half * 0.9f + 1.8f * half * (middle - width),
                       -half * 0.9f + 1.8f * half * (middle + width), 0.05f, height - 0.05f});
    else
      holes.push_back({-half * 0.85f, half * 0.85f, height * (middle - width), height * (middle + width)});
  }
  const int open = random.integer(1, 4);
  for (int side = 0; side < 4; ++side) {
    const float angle = render::kPi / 2 * float(side);
    const Vec3 n(-std::sin(angle), std::cos(angle), 0), u(-n.y, n.x, 0);
    addPanel(walls, {n * half, u, {0, 0, 1}, n, -half, half, 0, height, kThick},
             side < open ? std::span<const Hole>(holes) : std::span<const Hole>());
  }
  addBox(walls, {-half, -half, height}, {half, half, height + kThick});
  addBox(walls, {-half, -half, 0.001f}, {half, half, kThick});
  box.add(std::move(walls), draft.materials.anything());
  const auto radius = float(random.logRange(0.01, 0.08));
  box.balls.push_back({{0, 0, height * float(random.range(0.3, 0.7))},
                       radius,
                       kNoMaterial,
                       radianceOf(random, power, 4 * M_PI * radius * radius)});
  box.size = {2 * half, 2 * half, height + kThick};
  if (!placeFree(draft, room, box, float(random.range(0, 2 * M_PI)))) placeAtWall(draft, room, box);
}

// A partition that nearly closes a part of the room off, with the light behind it.
void addPartition(Draft& draft, Room& room, double power) {
  Random& random = draft.random;
  const Box box = room.box();
  const float at = render::lerp(float(random.range(0.25, 0.4)), box.min.x, box.max.x);
  const float gap = (box.max.y - box.min.y) * float(random.logRange(0.05, 0.3));
  const float top = random.chance(0.5) ? room.height : room.height - float(random.logRange(0.05, 0.8));
  draft.addBox({at - 0.05f, box.min.y + 0.001f, 0}, {at + 0.05f, box.max.y - gap, top},
               draft.materials.wall());
  room.claim({at, (box.min.y + box.max.y - gap) / 2, 0}, {0.05f, (box.max.y - gap - box.min.y) / 2 - 0.02f},
             0);
  const Vec3 middle((box.min.x + at) / 2, (box.min.y + box.max.y) / 2, room.height);
  draft.add(makePendant(draft, float(random.range(0.2, 1)), power), middle, 0);
  // Views are of the darker part.
  draft.scene.standing.back().polygon = {
      {at + 0.1f, box.min.y}, {box.max.x, box.min.y}, {box.max.x, box.max.y}, {at + 0.1f, box.max.y}};
}

// Niches in a board before the wall, each with its own light at the top.
void addNiches(Draft& draft, Room& room, double power) {
  Random& random = draft.random;
  const size_t wall = room.longestWalls()[0];
  const float length = room.length(wall), depth = float(random.range(0.25, 0.45));
  const int count = random.integer(2, 6);
  std::vector<Hole> holes;
  const float height = std::min(2.2f, room.height - 0.2f), bottom = float(random.range(0.1, 1));
  for (int i = 0; i < count; ++i) {
    const float middle = length * (float(i) + 0.5f) / float(count), half = length / float(count) * 0.35f;
    holes.push_back({middle - half, middle + half, bottom, height});
  }
  const Vec2 u = room.along(wall), n = room.inward(wall);
  const Vec3 across(u.x, u.y, 0), facing(n.x, n.y, 0);
  MeshData board;
  addPanel(board,
           {room.at(wall, 0, depth, 0),
            across,
            {0, 0, 1},
            facing,
            0.001f,
            length - 0.001f,
            0,
            room.height,
            depth - 0.01f},
           holes);
  draft.add(std::move(board), draft.materials.wall());
  for (const Hole& hole : holes) {
    if (!random.chance(0.8)) continue;
    const float width = hole.right - hole.left;
    // Behind a lip, so that only the niche shows it.
    addLightPanel(draft,
                  {room.at(wall, hole.left + width * 0.1f, 0.03f, height - 0.004f), across * (width * 0.8f),
                   facing * 0.03f},
                  {0, 0, -1}, power / count, false);
    Piece stand;
    stand.size = {width * 0.7f, depth * 0.6f, 0.01f};
    const Vec3 at = room.at(wall, (hole.left + hole.right) / 2, depth / 2, bottom);
    draft.addBox(at - Vec3(0.06f, 0.06f, 0), at + Vec3(0.06f, 0.06f, float(random.range(0.1, 0.4))),
                 draft.materials.anything());
    draft.scene.interests.push_back(at + Vec3(0, 0, 0.2f));
  }
  room.giveAway(wall, depth, 0.01f);
}

}  // namespace

// Emitters that few places see.
void buildHidden(Draft& draft) {
  Random& random = draft.random;
  Room room =
      boxRoom({0, 0}, float(random.range(3, 7)), float(random.range(2.8, 6)), float(random.range(2.3, 3.5)));
  addShell(draft, room);
  const double power = random.logRange(30, 300);
  switch (random.integer(0, 2)) {
    case 0:
      for (int i = random.integer(1, 3); i > 0; --i) addLightBox(draft, room, power);
      break;
    case 1:
      addPartition(draft, room, power);
      break;
    default:
      addNiches(draft, room, power);
      break;
  }
  furnish(draft, room, anyTheme(random), random.range(0.2, 1));
}

}  // namespace odis::learn
