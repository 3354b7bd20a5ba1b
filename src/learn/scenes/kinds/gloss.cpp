#include "learn/scenes/furnish.h"
#include "learn/scenes/furniture.h"
#include "learn/scenes/kinds.h"
#include "learn/scenes/lamps.h"

namespace odis::learn {

// Things of all roughnesses on a table or before a backdrop, under lamps of all sizes.
void buildGloss(Draft& draft) {
  Random& random = draft.random;
  draft.materials.setStyle(0.95, random.pick({0.0, 0.5}));
  Room room =
      boxRoom({0, 0}, float(random.range(3.5, 6)), float(random.range(3.5, 6)), float(random.range(2.6, 4)));
  addShell(draft, room);
  const Vec3 middle = room.middle();
  const bool plates = random.chance(0.3);
  draft.scene.interests.assign(2, {middle.x, middle.y, 0.9f});
  if (plates) {
    // Plates of growing roughness, each tilted to show lamps of growing size (after Veach and Guibas 1995).
    draft.tag("plates");
    const int count = random.integer(3, 6);
    for (int i = 0; i < count; ++i) {
      const float t = float(i) / float(count), tilt = 0.15f + 0.75f * t;
      const Vec3 along(0, std::cos(tilt), std::sin(tilt));
      MeshData plate;
      addQuad(plate, {middle.x - 1, middle.y - 0.8f + 1.6f * t, 0.2f + 0.5f * t}, {2, 0, 0},
              along * (1.5f / float(count)), {0, 0, 1});
      draft.add(std::move(plate), draft.materials.metal(draft.materials.roughness()));
      Piece lamp;
      const float radius = 0.01f * std::pow(25.0f, t);
      lamp.balls.push_back(
          {{0, 0, 0}, radius, kNoMaterial, radianceOf(random, 20, 4 * M_PI * radius * radius)});
      draft.add(lamp, {middle.x - 1 + 2 * t, middle.y + 1.3f, 1.9f}, 0);
    }
  } else {
    Piece table = makeTable(draft, float(random.range(0.9, 1.8)), float(random.range(0.7, 1.2)), 0.75f);
    decorate(draft, table, 0.95);
    room.claim({middle.x, middle.y, 0}, {table.size.x / 2, table.size.y / 2}, 0);
    draft.add(table, {middle.x, middle.y, 0}, 0);
    for (int i = random.integer(1, 3); i > 0; --i) {  // soft boxes from above and the sides
      const auto phi = float(random.range(0, 2 * M_PI));
      const Vec3 out(std::cos(phi), std::sin(phi), 0), side(-out.y, out.x, 0);
      const Vec3 at = Vec3(middle.x, middle.y, float(random.range(1.3, 2.2))) + out * 1.3f;
      const Vec3 facing = render::normalize(Vec3(middle.x, middle.y, 0.75f) - at),
                 up = render::cross(side, facing);
      const auto half = float(random.logRange(0.05, 0.5));
      addLightPanel(draft, at - side * half - up * half, side * (2 * half), up * (2 * half), facing,
                    random.logRange(10, 100), true);
    }
  }
  if (random.chance(0.4)) lightRoom(draft, room, random.logRange(5, 50));
  for (int i = random.integer(0, 4); i > 0; --i) placeFree(draft, room, makeCrates(draft), 0.2f);
  if (random.chance(0.4)) furnish(draft, room, Theme::bare, 0.4);
}

}  // namespace odis::learn
