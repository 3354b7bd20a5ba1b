#include "learn/scenes/furnish.h"
#include "learn/scenes/furniture.h"
#include "learn/scenes/house.h"
#include "learn/scenes/kinds.h"
#include "learn/scenes/lamps.h"
#include "learn/scenes/skies.h"

namespace odis::learn {

namespace {

// A table with things of glass and metal on it, lit from near by a lamp that may be behind glass, too.
void addGlassware(Draft& draft, Room& room) {
  Random& random = draft.random;
  const auto width = float(random.range(0.8, 1.6)), depth = float(random.range(0.7, 1.1));
  Piece table = makeTable(draft, width, depth, 0.75f);
  for (int i = random.integer(3, 10); i > 0; --i) {
    const auto r = float(random.logRange(0.03, 0.12));
    const Vec3 at(float(random.range(-1, 1)) * (width / 2 - r), float(random.range(-1, 1)) * (depth / 2 - r),
                  0.75f);
    const MaterialId material = random.chance(0.75) ? draft.materials.glass() : draft.materials.metal();
    if (random.chance(0.5)) {
      table.balls.push_back({at + Vec3(0, 0, r + 0.001f), r, material, Rgb(0.0f)});
    } else {
      MeshData mesh;
      if (random.chance(0.5))
        addCylinder(mesh, at + Vec3(0, 0, 0.001f), r, r * float(random.range(0.5, 4)), 32);
      else
        addCushion(mesh, at + Vec3(0, 0, r + 0.001f), Vec3(r, r * 0.7f, r), float(random.range(0.3, 1.5)));
      table.add(std::move(mesh), material);
    }
  }
  const Vec3 middle = room.middle();
  room.claim({middle.x, middle.y, 0}, Vec2(width / 2, depth / 2), 0);
  draft.add(table, {middle.x, middle.y, 0}, 0);
  for (int i = 0; i < 3; ++i) draft.scene.interests.push_back({middle.x, middle.y, 0.82f});
  const Piece lamp = makePendant(draft, room.height - float(random.range(1.5, 2)), random.logRange(20, 200));
  draft.add(
      lamp,
      {middle.x + float(random.range(-0.6, 0.6)), middle.y + float(random.range(-0.6, 0.6)), room.height}, 0);
}

// A basin of water with a rough surface, walls around it and light above or from the side.
void addPool(Draft& draft, Room& room) {
  Random& random = draft.random;
  draft.tag("water");
  const Box box = room.box();
  const Vec3 middle = room.middle();
  const Vec2 half((box.max.x - box.min.x) * float(random.range(0.2, 0.32)),
                  (box.max.y - box.min.y) * float(random.range(0.2, 0.32)));
  const float level = float(random.range(0.3, 0.7)), wall = 0.12f;
  const MaterialId rim = draft.materials.floor();
  for (const float side : {-1.0f, 1.0f}) {
    const float x = middle.x + side * (half.x + wall / 2), y = middle.y + side * (half.y + wall / 2);
    draft.addBox({x - wall / 2, middle.y - half.y - wall, 0},
                 {x + wall / 2, middle.y + half.y + wall, level + 0.08f}, rim);
    draft.addBox({middle.x - half.x, y - wall / 2, 0}, {middle.x + half.x, y + wall / 2, level + 0.08f}, rim);
  }
  room.claim({middle.x, middle.y, 0}, half + Vec2(wall), 0);
  // Waves on a grid that ends within the walls; floor and walls close the water off.
  constexpr int kCells = 56;
  const ValueNoise noise(random.bits());
  const double waves = random.range(2, 6), height = random.logRange(0.003, 0.03);
  MeshData surface;
  const auto z = [&](double u, double v) {
    return level + float(height * (noise.at(u * waves, v * waves, 64, 3) - 0.5));
  };
  for (int j = 0; j <= kCells; ++j)
    for (int i = 0; i <= kCells; ++i) {
      const double u = double(i) / kCells, v = double(j) / kCells, e = 0.5 / kCells;
      const Vec2 size = (half + Vec2(wall / 2)) * 2;
      const Vec3 n((z(u - e, v) - z(u + e, v)) / (size.x / kCells),
                   (z(u, v - e) - z(u, v + e)) / (size.y / kCells), 1);
      surface.positions.push_back(
          {middle.x + size.x * float(u - 0.5), middle.y + size.y * float(v - 0.5), z(u, v)});
      surface.normals.push_back(render::normalize(n));
      surface.uvs.push_back({float(u), float(v)});
    }
  for (uint32_t j = 0; j < kCells; ++j)
    for (uint32_t i = 0; i < kCells; ++i) {
      const uint32_t a = j * (kCells + 1) + i, b = a + kCells + 1;
      surface.triangles.push_back({a, a + 1, b + 1});
      surface.triangles.push_back({a, b + 1, b});
    }
  draft.add(std::move(surface), draft.materials.water());
  for (int i = 0; i < 3; ++i) draft.scene.interests.push_back({middle.x, middle.y, level});
  lightRoom(draft, room, random.logRange(30, 200));
}

// A cabinet of glass blocks, or a sheet of rough glass, before a bright opening.
void addGlassWall(Draft& draft, Room& room, size_t wall) {
  Random& random = draft.random;
  draft.tag("glass wall");
  const float length = room.length(wall);
  const auto depth = float(random.range(0.5, 1)), bottom = float(random.range(0, 0.8)),
             height = room.height - bottom - 0.2f;
  const Vec2 u = room.along(wall), n = room.inward(wall);
  const Vec3 across(u.x, u.y, 0), facing(n.x, n.y, 0);
  addLightPanel(draft,
                {room.at(wall, length * 0.2f, 0.05f, bottom + height * 0.1f),
                 across * (length * 0.6f),
                 {0, 0, height * 0.8f}},
                facing, random.logRange(50, 200), false);
  const int columns = random.chance(0.5) ? 1 : std::max(1, int(length / 0.3f)),
            rows = columns == 1 ? 1 : std::max(1, int(height / 0.3f));
  MeshData blocks;
  const float w = (length - 0.1f) / float(columns), h = height / float(rows);
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) {
      Piece block;
      MeshData box;
      addBox(box, {-w / 2 + 0.004f, 0, 0.004f}, {w / 2 - 0.004f, 0.05f, h - 0.004f});
      append(blocks, box,
             placed(room.at(wall, 0.05f + w * (float(i) + 0.5f), depth, bottom + h * float(j)),
                    room.angle(wall)));
    }
  draft.add(std::move(blocks), draft.materials.glass());
  Piece frame;
  const MaterialId material = draft.materials.wood();
  frame.addBox({0.001f, depth - 0.03f, bottom + height},
               {length - 0.001f, depth + 0.08f, room.height - 0.001f}, material);
  if (bottom > 0.02f)
    frame.addBox({0.001f, depth - 0.03f, 0}, {length - 0.001f, depth + 0.08f, bottom}, material);
  draft.add(frame, room.at(wall, 0, 0, 0), room.angle(wall));
  room.giveAway(wall, depth, 0);
}

}  // namespace

void buildGlass(Draft& draft) {
  Random& random = draft.random;
  Room room =
      boxRoom({0, 0}, float(random.range(3, 6)), float(random.range(3, 5)), float(random.range(2.4, 3.2)));
  const size_t what = random.weighted({4, 3, 2});
  const bool day = what < 2 && random.chance(0.4);
  if (day) cutWindows(random, room, 1, random.integer(1, 2));
  addShell(draft, room);
  addWindows(draft, room);
  if (day) addSky(draft, sunThrough(random, room, 1));
  if (what == 0) addGlassware(draft, room);
  if (what == 1) addPool(draft, room);
  if (what == 2) addGlassWall(draft, room, size_t(random.integer(0, 3)));
  furnish(draft, room, random.chance(0.5) ? Theme::bare : anyTheme(random), random.range(0.1, 0.5));
}

}  // namespace odis::learn
