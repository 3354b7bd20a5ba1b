#include "learn/scenes/furnish.h"
#include "learn/scenes/furniture.h"
#include "learn/scenes/kinds.h"
#include "learn/scenes/lamps.h"

namespace odis::learn {

// Light that comes by way of mirrors and polished metal; the floor shines, too.
void buildMirrors(Draft& draft) {
  Random& random = draft.random;
  draft.materials.setStyle(0.8, 0.4);
  Room room = anyRoom(random);
  addShell(draft, room);
  // Sheets before the walls.
  for (size_t wall = 0; wall < room.corners.size(); ++wall) {
    if (wall > 0 && !random.chance(0.35)) continue;
    const float length = room.length(wall), width = length * float(random.range(0.3, 0.98)),
                height = room.height * float(random.range(0.4, 0.97)),
                left = (length - width) * float(random.unit()),
                bottom = (room.height - height) * float(random.unit());
    const Vec2 u = room.along(wall), n = room.inward(wall);
    MeshData sheet;
    addQuad(sheet, room.at(wall, left, 0.02f, bottom), Vec3(u.x, u.y, 0) * width, {0, 0, height},
            {n.x, n.y, 0});
    draft.add(std::move(sheet), random.chance(0.6)
                                    ? draft.materials.mirror()
                                    : draft.materials.metal(draft.materials.roughness() * 0.3f));
    room.openings.push_back({wall, left, left + width, bottom, bottom + height});
  }
  const double power = random.logRange(20, 300);
  if (random.chance(0.4)) {  // a spot on a mirror-like thing
    const Box box = room.box();
    const Vec3 at = room.middle() + Vec3(0, 0, room.height * 0.45f);
    const Vec3 to(float(random.range(box.min.x, box.max.x)), float(random.range(box.min.y, box.max.y)),
                  float(random.range(0, 1.5)));
    draft.scene.pointLights.push_back(
        {at, render::normalize(to - at), lightColor(random) * float(power), float(random.range(10, 40))});
  } else {
    lightRoom(draft, room, power);
  }
  for (int i = random.integer(0, 5); i > 0; --i) {
    Piece ball;
    const auto r = float(random.range(0.1, 0.4));
    ball.balls.push_back({{0, 0, r}, r, draft.materials.metal(), Rgb(0.0f)});
    ball.size = Vec3(2 * r);
    placeFree(draft, room, ball, 0);
  }
  furnish(draft, room, anyTheme(random), random.range(0.2, 0.8), random.chance(0.4) ? 1 : 0, power / 3);
  hangPictures(draft, room, random.integer(0, 4), 0.8);
}

}  // namespace odis::learn
