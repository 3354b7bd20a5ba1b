#include "learn/scenes/furniture.h"
#include "learn/scenes/kinds.h"
#include "learn/scenes/lamps.h"
#include "learn/scenes/skies.h"

namespace odis::learn {

namespace {

// Solids on a plane, none before another for most of the sky.
void addThings(Draft& draft, int count, bool metal) {
  Random& random = draft.random;
  for (int i = 0; i < count; ++i) {
    const auto r = float(random.logRange(0.15, 0.9));
    const Vec3 at(float(random.range(-4, 4)), float(random.range(-4, 4)), 0);
    const MaterialId material =
        metal ? draft.materials.metal(draft.materials.roughness() * 0.03f) : draft.materials.lacquer();
    if (random.chance(0.5)) {
      draft.scene.balls.push_back({at + Vec3(0, 0, r), r, material, Rgb(0.0f)});
    } else {
      draft.addBox(at - Vec3(r, r, 0) * 0.6f, at + Vec3(r * 0.6f, r * 0.6f, r * 1.5f), material);
    }
    draft.scene.interests.push_back(at + Vec3(0, 0, r));
  }
}

void addPlane(Draft& draft, MaterialId material) {
  MeshData plane;
  addQuad(plane, {-300, -300, 0}, {600, 0, 0}, {0, 600, 0}, {0, 0, 1});
  draft.add(std::move(plane), material);
  draft.scene.standing.push_back({{{-6, -6}, {6, -6}, {6, 6}, {-6, 6}}, 0, 4});
  draft.scene.indoors = false;
}

// A sun and nothing else, seen from nearly everywhere: next-event estimation finds it.
void buildSun(Draft& draft) {
  draft.tag("unshadowed sun");
  addPlane(draft, draft.materials.floor());
  addThings(draft, draft.random.integer(3, 10), false);
  addDaylight(draft, skyDirection(draft.random.range(0, 6.28), draft.random.range(0.6, 1.5)), 1);
}

// The same light from everywhere onto near-mirrors: the surface's own sampling is perfect.
void buildSky(Draft& draft) {
  draft.tag("constant sky, near-mirrors");
  addPlane(draft, draft.materials.metal(draft.materials.roughness() * 0.05f));
  addThings(draft, draft.random.integer(4, 12), true);
  draft.scene.environment.kind = Environment::Kind::constant;
}

// White everywhere, the same light everywhere: nothing to choose.
void buildFurnace(Draft& draft) {
  Random& random = draft.random;
  draft.tag("white furnace");
  const MaterialId white = draft.materials.matt(Rgb(float(random.range(0.7, 0.95))));
  addPlane(draft, white);
  for (int i = random.integer(4, 14); i > 0; --i) {
    const auto r = float(random.logRange(0.15, 0.9));
    const Vec3 at(float(random.range(-4, 4)), float(random.range(-4, 4)), r);
    draft.scene.balls.push_back({at, r, white, Rgb(0.0f)});
    draft.scene.interests.push_back(at);
  }
  draft.scene.environment.kind = Environment::Kind::constant;
}

// A hall of mirrors: paths that no map of diffuse surfaces helps.
void buildHallOfMirrors(Draft& draft) {
  Random& random = draft.random;
  draft.tag("mirrors everywhere");
  Room room = anyRoom(random);
  addShell(draft, room);
  for (size_t wall = 0; wall < room.corners.size(); ++wall) {
    const Vec2 u = room.along(wall), n = room.inward(wall);
    MeshData sheet;
    addQuad(sheet, room.at(wall, 0.02f, 0.02f, 0.02f), Vec3(u.x, u.y, 0) * (room.length(wall) - 0.04f),
            {0, 0, room.height - 0.04f}, {n.x, n.y, 0});
    draft.add(std::move(sheet), draft.materials.mirror());
  }
  const Vec3 middle = room.middle();
  for (int i = random.integer(1, 5); i > 0; --i) {
    const auto r = float(random.range(0.15, 0.4));
    const Vec3 at(middle.x + float(random.range(-0.8, 0.8)), middle.y + float(random.range(-0.8, 0.8)), r);
    draft.scene.balls.push_back(
        {at, r, random.chance(0.6) ? draft.materials.mirror() : draft.materials.lacquer(), Rgb(0.0f)});
    draft.scene.interests.push_back(at);
  }
  addCeilingPanel(draft, room, {middle.x, middle.y}, {0.4f, 0.4f}, 50);
}

// A large lamp over an empty, dark room: direct light is all there is.
void buildDirect(Draft& draft) {
  Random& random = draft.random;
  draft.tag("direct light only");
  Room room =
      boxRoom({0, 0}, float(random.range(3, 6)), float(random.range(3, 6)), float(random.range(2.4, 3)));
  const MaterialId dark = draft.materials.matt(Rgb(float(random.range(0.02, 0.12))));
  const size_t first = draft.scene.parts.size();
  addShell(draft, room);
  for (size_t i = first; i < draft.scene.parts.size(); ++i) draft.scene.parts[i].material = dark;
  const Vec3 middle = room.middle();
  for (int i = random.integer(2, 6); i > 0; --i) {
    const Vec3 at(middle.x + float(random.range(-1.2, 1.2)), middle.y + float(random.range(-1.2, 1.2)), 0);
    const float half = float(random.range(0.1, 0.4));
    draft.addBox(at - Vec3(half, half, 0), at + Vec3(half, half, half * 2), draft.materials.matt(Rgb(0.15f)));
    draft.scene.interests.push_back(at + Vec3(0, 0, half));
  }
  addCeilingPanel(draft, room, {middle.x, middle.y}, {1, 1}, 100);
}

}  // namespace

void buildAdversarial(Draft& draft) {
  switch (draft.random.integer(0, 4)) {
    case 0:
      return buildSun(draft);
    case 1:
      return buildSky(draft);
    case 2:
      return buildFurnace(draft);
    case 3:
      return buildHallOfMirrors(draft);
    default:
      return buildDirect(draft);
  }
}

}  // namespace odis::learn
