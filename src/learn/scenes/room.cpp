#include "learn/scenes/room.h"

#include <algorithm>
#include <numeric>

namespace odis::learn {

using render::kPi;

Vec3 Room::at(size_t wall, float s, float depth, float z) const {
  const Vec2 p = corners[wall] + along(wall) * s + inward(wall) * depth;
  return {p.x, p.y, z};
}

float Room::angle(size_t wall) const {
  return std::atan2(inward(wall).y, inward(wall).x) - kPi / 2;
}

Box Room::box() const {
  return boxAround(corners, 0, height);
}

Vec3 Room::middle() const {
  Vec2 sum(0, 0);
  for (const Vec2& c : corners) sum += c;
  sum /= float(corners.size());
  return {sum.x, sum.y, height / 2};
}

bool Room::contains(const Vec2& p, float margin) const {
  return learn::contains(corners, p, margin);
}

std::optional<Opening> Room::open(Random& random, size_t wall, float width, float bottom, float top) {
  constexpr float kMargin = 0.15f;
  const float space = length(wall) - width - 2 * kMargin;
  if (space < 0 || top > height - 0.03f) return {};
  for (int attempt = 0; attempt < 8; ++attempt) {
    const float left = kMargin + space * float(random.unit());
    const Opening opening{wall, left, left + width, bottom, top};
    const bool free = std::none_of(openings.begin(), openings.end(), [&](const Opening& o) {
      return o.wall == wall && opening.left < o.right + kMargin && o.left < opening.right + kMargin;
    });
    if (!free) continue;
    openings.push_back(opening);
    return opening;
  }
  return {};
}

std::vector<size_t> Room::longestWalls() const {
  std::vector<size_t> walls(corners.size());
  std::iota(walls.begin(), walls.end(), size_t(0));
  std::stable_sort(walls.begin(), walls.end(), [&](size_t a, size_t b) { return length(a) > length(b); });
  return walls;
}

bool Room::claim(const Vec3& center, const Vec2& half, float margin) {
  const Vec2 c(center.x, center.y), min = c - half, max = c + half;
  for (const Vec2& p : {min, max, Vec2(min.x, max.y), Vec2(max.x, min.y), c})
    if (!contains(p, 0.01f)) return false;
  for (const Rectangle& r : m_taken)
    if (min.x < r.max.x + margin && r.min.x < max.x + margin && min.y < r.max.y + margin &&
        r.min.y < max.y + margin)
      return false;
  m_taken.push_back({min, max});
  return true;
}

void Room::giveAway(size_t wall, float depth, float inset) {
  const Vec2 u = along(wall);
  const float s = length(wall) / 2 - 0.02f, d = depth / 2 - inset;
  claim(at(wall, length(wall) / 2, depth / 2, 0), std::abs(u.x) > std::abs(u.y) ? Vec2(s, d) : Vec2(d, s), 0);
  openings.push_back({wall, 0, length(wall), 0, height});
}

Room boxRoom(const Vec2& corner, float width, float depth, float height) {
  Room room;
  room.corners = {corner, corner + Vec2(width, 0), corner + Vec2(width, depth), corner + Vec2(0, depth)};
  room.height = height;
  return room;
}

Room cornerRoom(float width, float depth, float height, float shareX, float shareY) {
  Room room;
  const float x = width * (1 - shareX), y = depth * (1 - shareY);
  room.corners = {{0, 0}, {width, 0}, {width, y}, {x, y}, {x, depth}, {0, depth}};
  room.height = height;
  return room;
}

Room roundRoom(Random& random, float width, float depth, float height) {
  Room room;
  const int n = random.integer(5, 8);
  const double first = random.unit();
  for (int i = 0; i < n; ++i) {
    const double phi = 2 * M_PI * (i + first + random.range(-0.15, 0.15)) / n;
    room.corners.emplace_back(float(width / 2 * (1 + std::cos(phi))), float(depth / 2 * (1 + std::sin(phi))));
  }
  room.height = height;
  return room;
}

Room anyRoom(Random& random) {
  const auto width = float(random.logRange(2.8, 9)), depth = width * float(random.logRange(0.55, 1.0));
  const auto height = float(random.chance(0.8) ? random.range(2.3, 3.2) : random.range(3.2, 5));
  switch (random.weighted({5, 3, 2})) {
    case 0:
      return boxRoom({0, 0}, width, depth, height);
    case 1:
      return cornerRoom(width, depth, height, float(random.range(0.3, 0.6)), float(random.range(0.3, 0.6)));
    default:
      return roundRoom(random, width, depth, height);
  }
}

// Walls with their openings, and skirting boards by chance.
static void addWalls(Draft& draft, const Room& room) {
  const float t = room.thickness;
  const bool accents = draft.random.chance(0.3), skirting = draft.random.chance(0.5);
  const MaterialId wall = draft.materials.wall(), skirt = draft.materials.wood();
  for (size_t w = 0; w < room.corners.size(); ++w) {
    std::vector<Hole> holes;
    for (const Opening& o : room.openings)
      if (o.wall == w) holes.push_back({o.left, o.right, o.bottom, o.top});
    const Vec2 u = room.along(w), n = room.inward(w);
    // Walls run past convex corners, so that there is no gap behind them.
    const auto convex = [&](size_t corner) {
      const size_t before = (corner + room.corners.size() - 1) % room.corners.size();
      return room.along(before).cross(room.along(corner)) > 0;
    };
    MeshData mesh;
    addPanel(mesh,
             {room.at(w, 0, 0, 0),
              {u.x, u.y, 0},
              {0, 0, 1},
              {n.x, n.y, 0},
              convex(w) ? -t : 0.0f,
              room.length(w) + (convex(room.next(w)) ? t : 0.0f),
              -t,
              room.height + t,
              t},
             holes);
    draft.add(std::move(mesh), accents && w == 0 ? draft.materials.wall() : wall);
    if (!skirting) continue;
    // The skirting board leaves out what reaches the floor.
    std::vector<Hole> low;
    for (const Hole& hole : holes)
      if (hole.bottom < 0.1f) low.push_back({hole.left - 0.05f, hole.right + 0.05f, -1, 1});
    MeshData board;
    addPanel(board,
             {room.at(w, 0, 0.015f, 0),
              {u.x, u.y, 0},
              {0, 0, 1},
              {n.x, n.y, 0},
              0,
              room.length(w),
              0,
              0.09f,
              0.015f},
             low);
    draft.add(std::move(board), skirt);
  }
}

void addShell(Draft& draft, const Room& room) {
  const Box box = room.box();
  const float t = room.thickness;
  draft.addBox(box.min - Vec3(t, t, t), {box.max.x + t, box.max.y + t, 0}, draft.materials.floor());
  MeshData ceiling;
  addPanel(ceiling,
           {{0, 0, room.height},
            {1, 0, 0},
            {0, 1, 0},
            {0, 0, -1},
            box.min.x - t,
            box.max.x + t,
            box.min.y - t,
            box.max.y + t,
            t},
           room.skylights);
  draft.add(std::move(ceiling), draft.materials.ceiling());
  addWalls(draft, room);
  draft.scene.standing.push_back({room.corners, 0, room.height});
}

}  // namespace odis::learn
