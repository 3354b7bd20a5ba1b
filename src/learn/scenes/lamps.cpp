#include "learn/scenes/lamps.h"

#include <algorithm>

namespace odis::learn {

using render::kPi;

Rgb lightColor(Random& random) {
  Rgb color(1.0f);
  if (random.chance(0.07)) {
    color = hue(random.unit(), random.range(0.3, 0.85), 1);
  } else {  // from candles (-1) to a cloudy sky (0.5)
    const double warmth = random.range(-1, 0.5);
    color = warmth < 0 ? Rgb(1, float(1 + 0.45 * warmth), float(1 + 0.8 * warmth))
                       : Rgb(float(1 - 0.4 * warmth), float(1 - 0.2 * warmth), 1);
  }
  return color / render::luminance(color);
}

Rgb radianceOf(Random& random, double power, double area) {
  return lightColor(random) * float(power / (M_PI * area));
}

void addBulb(Draft& draft, Piece& piece, const Vec3& at, double power, float room) {
  Random& random = draft.random;
  constexpr float kGlass = 2;  // at most so many times as wide as the bulb
  const float radius = std::min(float(random.logRange(0.02, 0.08)), 0.95f * room / kGlass);
  piece.balls.push_back({at, radius, kNoMaterial, radianceOf(random, power, 4 * M_PI * radius * radius)});
  if (!random.chance(0.08)) return;
  draft.tag("bulb in glass");
  piece.balls.push_back({at, radius * float(random.range(1.3, kGlass)), draft.materials.glass(), Rgb(0.0f)});
}

static MaterialId shadeMaterial(Draft& draft) {
  const size_t kind = draft.random.weighted({5, 2, 0.7, 1});
  if (kind == 1) return draft.materials.lacquer();
  if (kind == 2) return draft.materials.metal();
  if (kind == 3) return draft.materials.sheer(float(draft.random.range(0.6, 0.95)));
  return draft.materials.matt(hue(draft.random.unit(), 0.1, draft.random.range(0.4, 0.9)));
}

Piece makeTableLamp(Draft& draft, double power) {
  Random& random = draft.random;
  Piece piece;
  const auto height = float(random.range(0.2, 0.35)), radius = float(random.range(0.1, 0.2));
  MeshData foot, shade;
  const Vec2 profile[] = {{0, 0},          {radius * 0.7f, 0}, {radius * 0.6f, 0.02f},
                          {0.012f, 0.04f}, {0.012f, height},   {0, height}};
  addLathe(foot, Vec3(0), profile, 20);
  piece.add(std::move(foot), draft.materials.anything());
  const float shadeHeight = radius * float(random.range(0.9, 1.6)),
              upper = radius * float(random.range(0.5, 1));
  addShade(shade, {0, 0, height - 0.02f}, {radius, upper, shadeHeight, 0.003f}, 32);
  piece.add(std::move(shade), shadeMaterial(draft));
  addBulb(draft, piece, {0, 0, height + radius * 0.4f + 0.03f}, power, radius * 0.48f);
  piece.size = {2 * radius, 2 * radius, height + 1.5f * radius};
  return piece;
}

Piece makeFloorLamp(Draft& draft, double power) {
  Random& random = draft.random;
  Piece piece;
  const auto height = float(random.range(1.2, 1.7)), radius = float(random.range(0.14, 0.25));
  const bool bowl = random.chance(0.35);
  MeshData foot, shade;
  const Vec2 profile[] = {{0, 0}, {0.15f, 0}, {0.15f, 0.02f}, {0.014f, 0.03f}, {0.014f, height}, {0, height}};
  addLathe(foot, Vec3(0), profile, 20);
  piece.add(std::move(foot), random.chance(0.6) ? draft.materials.metal() : draft.materials.lacquer());
  if (bowl) {
    draft.tag("torchiere");
    const Vec2 dish[] = {{0, height},
                         {radius * 0.6f, height + 0.03f},
                         {radius, height + 0.12f},
                         {radius - 0.008f, height + 0.12f},
                         {radius * 0.57f, height + 0.038f},
                         {0, height + 0.008f}};
    addLathe(shade, Vec3(0), dish, 32);
  } else {
    const float shadeHeight = radius * float(random.range(0.9, 1.5)),
                upper = radius * float(random.range(0.5, 1));
    addShade(shade, {0, 0, height - 0.05f}, {radius, upper, shadeHeight, 0.003f}, 32);
  }
  piece.add(std::move(shade), bowl ? draft.materials.lacquer() : shadeMaterial(draft));
  addBulb(draft, piece, {0, 0, height + (bowl ? 0.07f : 0.09f)}, power, bowl ? 0.03f : radius * 0.48f);
  piece.size = {2 * radius, 2 * radius, height + 0.3f};
  return piece;
}

Piece makePendant(Draft& draft, float drop, double power) {
  Random& random = draft.random;
  Piece piece;
  const auto radius = float(random.logRange(0.08, 0.3));
  MeshData cord, shade;
  addCylinder(cord, {0, 0, -drop}, 0.004f, drop, 8);
  piece.add(std::move(cord), draft.materials.matt(Rgb(0.05f)));
  const Vec3 bulb(0, 0, -drop - 0.05f - radius * 0.4f);
  switch (random.integer(0, 2)) {
    case 0: {  // a cone or cylinder, open at both ends
      const float height = radius * float(random.range(0.8, 1.8));
      addShade(shade, {0, 0, -drop - 0.05f - height},
               {radius, radius * float(random.range(0.4, 1)), height, 0.003f}, 32);
      piece.add(std::move(shade), shadeMaterial(draft));
      break;
    }
    case 1: {  // a dome that only opens downwards
      std::vector<Vec2> dome;
      for (int i = 0; i <= 8; ++i)
        dome.emplace_back(radius * std::cos(kPi / 2 * float(i) / 8),
                          radius * std::sin(kPi / 2 * float(i) / 8));
      dome.back().x = 0;
      for (int i = 8; i >= 0; --i) dome.push_back(dome[size_t(i)] * 0.97f);
      addLathe(shade, {0, 0, -drop - radius}, dome, 32, true);
      piece.add(std::move(shade),
                draft.random.chance(0.5) ? draft.materials.metal() : draft.materials.lacquer());
      break;
    }
    default:  // a luminous globe, a glass globe, or the bulb alone
      if (random.chance(0.6)) {
        const float globe = std::min(radius * 0.7f, radius * 0.4f + 0.045f);
        piece.balls.push_back(
            {bulb, globe, kNoMaterial, radianceOf(random, power, 4 * M_PI * globe * globe)});
        piece.size = {2 * radius, 2 * radius, drop + 2 * radius};
        return piece;
      }
      if (random.chance(0.4)) {
        draft.tag("bulb in glass");
        piece.balls.push_back(
            {bulb, std::min(radius * 0.6f, radius * 0.4f + 0.045f), draft.materials.glass(), Rgb(0.0f)});
      }
  }
  addBulb(draft, piece, bulb, power, radius * 0.4f);
  piece.size = {2 * radius, 2 * radius, drop + 2 * radius};
  return piece;
}

void addLightPanel(Draft& draft, const Rectangle& rectangle, const Vec3& facing, double power, bool housing) {
  const auto& [corner, u, v] = rectangle;
  MeshData panel;
  addQuad(panel, corner, u, v, facing);
  draft.add(std::move(panel), kNoMaterial,
            radianceOf(draft.random, power, double(render::length(u)) * render::length(v)));
  if (!housing) return;
  // Four bars around it and a back.
  const Vec3 a = render::normalize(u), b = render::normalize(v), n = render::normalize(facing);
  const Hole hole{0, render::length(u), 0, render::length(v)};
  constexpr float kBar = 0.02f;
  MeshData box;
  addPanel(box, {corner + n * 0.015f, a, b, n, -kBar, hole.right + kBar, -kBar, hole.top + kBar, 0.04f},
           std::span(&hole, 1));
  addQuad(box, corner - n * 0.02f, u, v, -n);
  draft.add(std::move(box),
            draft.random.chance(0.5) ? draft.materials.metal() : draft.materials.matt(Rgb(0.7f)));
}

void addCeilingPanel(Draft& draft, const Room& room, const Vec2& at, const Vec2& half, double power) {
  addLightPanel(draft,
                {{at.x - half.x, at.y - half.y, room.height - 0.03f}, {2 * half.x, 0, 0}, {0, 2 * half.y, 0}},
                {0, 0, -1}, power, true);
}

void addDownlight(Draft& draft, const Vec3& ceiling, float radius, double power) {
  MeshData tube, disc;
  const float depth = radius * float(draft.random.range(0.5, 2));
  addShade(tube, ceiling - Vec3(0, 0, depth), {radius * 1.05f, radius * 1.05f, depth, radius * 0.05f}, 20);
  draft.add(std::move(tube), draft.materials.metal());
  const Vec2 profile[] = {{0, 0}, {radius, 0}};
  addLathe(disc, ceiling - Vec3(0, 0, 0.01f), profile, 16);  // faces down
  draft.add(std::move(disc), kNoMaterial, radianceOf(draft.random, power, M_PI * radius * radius));
}

void addTube(Draft& draft, const Vec3& from, const Vec3& to, float radius, double power) {
  MeshData tube;
  addBar(tube, from, to, radius, 10);
  draft.add(std::move(tube), kNoMaterial,
            radianceOf(draft.random, power, 2 * M_PI * radius * render::length(to - from)));
}

void addSconce(Draft& draft, const Room& room, size_t wall, float s, float z, double power) {
  // Half a tube at the wall, open at one end or both, with a bulb in it.
  Random& random = draft.random;
  Piece piece;
  const auto radius = float(random.range(0.06, 0.12)), height = float(random.range(0.12, 0.35));
  const int open = random.integer(0, 2);  // above, below, both
  MeshData shell;
  constexpr int kSegments = 12;
  for (int i = 0; i < kSegments; ++i) {
    const float a = kPi * float(i) / kSegments, b = kPi * float(i + 1) / kSegments;
    const Vec3 from(radius * std::cos(a), radius * std::sin(a), 0),
        to(radius * std::cos(b), radius * std::sin(b), 0);
    const Vec3 out(std::cos((a + b) / 2), std::sin((a + b) / 2), 0);
    addQuad(shell, from, to - from, {0, 0, height}, out);
    for (const int end : {0, 1}) {
      if (open == 2 || open == end) continue;
      const Vec3 lift(0, 0, end == 0 ? height : 0.0f);
      // As a thin slice of the lid, two corners of which meet in the middle of the wall.
      addQuad(shell, from * 0.001f + lift, (to - from) * 0.001f + from * 0.999f, to - from, {0, 0, 1});
    }
  }
  piece.add(std::move(shell), random.chance(0.5) ? draft.materials.metal() : draft.materials.lacquer());
  piece.balls.push_back(
      {{0, radius * 0.45f, height / 2}, 0.03f, kNoMaterial, radianceOf(random, power, 4 * M_PI * 0.0009)});
  draft.add(piece, room.at(wall, s, 0.002f, z), room.angle(wall));
}

void addCove(Draft& draft, const Room& room, size_t wall, double power) {
  Random& random = draft.random;
  const float length = room.length(wall), gap = float(random.range(0.2, 0.6)),
              depth = float(random.range(0.1, 0.3));
  const float z = room.height - gap, lip = std::min(float(random.range(0.04, 0.12)), gap * 0.6f);
  Piece ledge;
  const MaterialId material = draft.materials.ceiling();
  ledge.addBox({0, 0, z - 0.03f}, {length, depth, z}, material);
  ledge.addBox({0, depth - 0.02f, z}, {length, depth, z + lip}, material);
  draft.add(ledge, room.at(wall, 0, 0.001f, 0), room.angle(wall));
  const Vec2 u = room.along(wall), n = room.inward(wall);
  const float margin = std::min(0.3f, length * 0.1f);
  addLightPanel(draft,
                {room.at(wall, margin, depth * 0.3f, z + 0.008f), Vec3(u.x, u.y, 0) * (length - 2 * margin),
                 Vec3(n.x, n.y, 0) * float(random.range(0.02, 0.08))},
                {0, 0, 1}, power, false);
}

void addGlowingBoard(Draft& draft, const Room& room, size_t wall, const Vec2& center, const Vec2& half,
                     double power) {
  const float s = center.x, z = center.y;
  Random& random = draft.random;
  const auto gap = float(random.range(0.05, 0.2));
  Piece board;
  board.addBox({-half.x, gap, -half.y}, {half.x, gap + 0.03f, half.y}, draft.materials.anything());
  draft.add(board, room.at(wall, s, 0, z), room.angle(wall));
  // Strips on its back, some way from the edges, that light the wall.
  const Vec2 u = room.along(wall), n = room.inward(wall);
  const Vec3 across(u.x, u.y, 0), facing(-n.x, -n.y, 0);
  const float inset = std::min(half.x, half.y) * float(random.range(0.1, 0.4)),
              width = float(random.range(0.01, 0.03));
  const bool upright = random.chance(0.5);
  for (const float side : {-1.0f, 1.0f}) {
    const Vec3 middle = room.at(wall, s, gap - 0.004f, z);
    const Vec3 offset = upright ? across * (side * (half.x - inset)) : Vec3(0, 0, side * (half.y - inset));
    const Vec3 run = upright ? Vec3(0, 0, 2 * (half.y - inset)) : across * (2 * (half.x - inset));
    const Vec3 thick = upright ? across * width : Vec3(0, 0, width);
    addLightPanel(draft, {middle + offset - run * 0.5f, run, thick}, facing, power / 2, false);
  }
}

// A luminous panel on a wall, as a window of milky glass; below the ceiling where no wall has a place for it.
static void addWallPanel(Draft& draft, Room& room, double power) {
  Random& random = draft.random;
  const auto wall = size_t(random.integer(0, int(room.corners.size()) - 1));
  const auto width = float(random.logRange(0.3, 2)), bottom = float(random.range(0.5, 1.2));
  const float top = std::min(room.height - 0.15f, bottom + float(random.logRange(0.3, 1.6)));
  const std::optional<Opening> place = room.open(random, wall, width, bottom, top);
  if (!place) return addCeilingPanel(draft, room, {room.middle().x, room.middle().y}, {0.3f, 0.3f}, power);
  const Vec2 u = room.along(wall), n = room.inward(wall);
  addLightPanel(draft,
                {room.at(wall, place->left, 0.03f, bottom), Vec3(u.x, u.y, 0) * width, {0, 0, top - bottom}},
                {n.x, n.y, 0}, power, true);
}

void lightRoom(Draft& draft, Room& room, double power) {
  Random& random = draft.random;
  const Box box = room.box();
  const Vec3 middle = room.middle();
  switch (random.weighted({3, 2, 3, 1.5, 1.5, 2.5})) {
    case 0: {
      const Vec2 half(float(random.logRange(0.1, 0.8)), float(random.logRange(0.1, 0.8)));
      addCeilingPanel(draft, room, {middle.x, middle.y}, half, power);
      break;
    }
    case 1: {
      const int n = random.integer(2, 5), m = random.integer(1, 4);
      const auto radius = float(random.range(0.03, 0.09));
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j) {
          const Vec2 at(render::lerp((float(i) + 0.5f) / float(n), box.min.x, box.max.x),
                        render::lerp((float(j) + 0.5f) / float(m), box.min.y, box.max.y));
          if (room.contains(at, 0.3f))
            addDownlight(draft, {at.x, at.y, room.height}, radius, power / (n * m));
        }
      break;
    }
    case 2: {
      const Piece pendant = makePendant(draft, float(random.range(0.2, 0.9)), power);
      draft.add(pendant, {middle.x, middle.y, room.height}, 0);
      break;
    }
    case 3: {
      const int n = random.integer(1, 4);
      for (int i = 0; i < n; ++i) {
        const auto wall = size_t(random.integer(0, int(room.corners.size()) - 1));
        addSconce(draft, room, wall, room.length(wall) * float(random.range(0.15, 0.85)),
                  float(random.range(1.5, 2)), power / n);
      }
      break;
    }
    case 4: {
      const Vec3 at = middle + Vec3(0, 0, room.height / 2 - 0.08f);
      const Vec3 half = random.chance(0.5) ? Vec3(0.6f, 0, 0) : Vec3(0, 0.6f, 0);
      for (const float side : {-0.06f, 0.06f}) {
        const Vec3 shift(half.y > 0 ? side : 0, half.x > 0 ? side : 0, 0);
        addTube(draft, at - half + shift, at + half + shift, 0.013f, power / 2);
      }
      break;
    }
    default:
      addWallPanel(draft, room, power);
  }
}

}  // namespace odis::learn
