#include "learn/scenes/furnish.h"
#include "learn/scenes/furniture.h"
#include "learn/scenes/kinds.h"
#include "learn/scenes/lamps.h"
#include "learn/scenes/skies.h"

namespace odis::learn {

namespace {

// Soft boxes about a place, at this distance, from above and the sides.
void addSoftBoxes(Draft& draft, const Vec3& subject, float distance, int count, float mostHalf,
                  double power) {
  Random& random = draft.random;
  for (int i = 0; i < count; ++i) {
    const auto phi = float(random.range(0, 2 * M_PI));
    const Vec3 out(std::cos(phi), std::sin(phi), 0), side(-out.y, out.x, 0);
    const Vec3 at = Vec3(subject.x, subject.y, float(random.range(1.3, 2.2))) + out * distance;
    const Vec3 facing = render::normalize(subject - at), up = render::cross(side, facing);
    const auto half = float(random.logRange(0.05, mostHalf));
    addLightPanel(draft, {at - side * half - up * half, side * (2 * half), up * (2 * half)}, facing,
                  random.logRange(0.1, 1) * power, true);
  }
}

// Things on a floor without a room around them, before a backdrop or under a sky: light comes straight from
// soft boxes and from the surroundings, and little of it is reflected twice.
void buildStage(Draft& draft) {
  Random& random = draft.random;
  draft.tag("stage");
  draft.scene.indoors = false;
  MeshData floor;
  addQuad(floor, {-300, -300, 0}, {600, 0, 0}, {0, 600, 0}, {0, 0, 1});
  draft.add(std::move(floor), random.chance(0.5) ? draft.materials.floor() : draft.materials.lacquer());
  const bool backdrop = random.chance(0.6);
  if (backdrop) draft.addBox({-6, 3, 0}, {6, 3.1f, 4}, draft.materials.wall());
  if (random.chance(0.3)) draft.addBox({-4.1f, -3, 0}, {-4, 3, 4}, draft.materials.wall());
  // A table with things in the middle or none, furniture and solids around it.
  const bool table = random.chance(0.5);
  if (table) {
    Piece top = makeTable(draft, float(random.range(0.9, 1.8)), float(random.range(0.7, 1.2)), 0.75f);
    decorate(draft, top, 0.8);
    draft.add(top, Vec3(0), float(random.range(-0.5, 0.5)));
    draft.scene.interests.push_back({0, 0, 0.8f});
  }
  constexpr int kOuter = 7, kInner = 5;  // on two rings, so that nothing is within another
  for (int i = 0; i < (table ? kOuter : kOuter + kInner); ++i) {
    if (!random.chance(0.8)) continue;
    const bool outer = i < kOuter;
    const float phi = 2 * render::kPi * float(i) / float(outer ? kOuter : kInner),
                reach = (outer ? 2.2f : 1.1f) + float(random.range(-0.1, 0.1));
    const Vec3 at(reach * std::cos(phi), reach * std::sin(phi), 0.001f);
    const auto r = float(random.range(0.15, 0.5));
    Piece thing;
    switch (random.weighted({2, 1.5, 1.5, 1})) {
      case 0:
        thing.balls.push_back({{0, 0, r}, r, draft.materials.anything(), Rgb(0.0f)});
        break;
      case 1:
        thing.addBox({-r, -r * 0.7f, 0}, {r, r * 0.7f, r * float(random.range(0.5, 3))},
                     draft.materials.anything());
        break;
      case 2:
        thing = makeChair(draft);
        break;
      default:
        thing = makePlant(draft, float(random.range(0.5, 1.5)));
        break;
    }
    draft.add(thing, at, float(random.range(0, 2 * M_PI)));
    draft.scene.interests.push_back(at + Vec3(0, 0, r));
  }
  const bool sky = random.chance(0.6);
  if (sky) {
    addSky(draft, skyDirection(random.range(0, 2 * M_PI), random.range(0.2, 1.3)));
  } else {
    Environment& e = draft.scene.environment;
    e.kind = Environment::Kind::constant;
    e.scale = float(random.logRange(0.01, 0.3));
  }
  if (!sky || random.chance(0.5))
    addSoftBoxes(draft, {0, 0, 0.6f}, float(random.range(2.6, 3.6)), random.integer(1, 5), 0.8f,
                 random.logRange(5, 100));
  draft.scene.standing.push_back({{{-3.5f, -5}, {5, -5}, {5, 2.5f}, {-3.5f, 2.5f}}, 0, 3});
}

}  // namespace

// Things of all roughnesses on a table or before a backdrop, under lamps of all sizes.
void buildGloss(Draft& draft) {
  Random& random = draft.random;
  draft.materials.setStyle(random.pick({0.5, 0.95}), random.pick({0.0, 0.5}));
  if (random.chance(0.6)) return buildStage(draft);
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
    addSoftBoxes(draft, {middle.x, middle.y, 0.75f}, 1.3f, random.integer(1, 3), 0.5f, 100);
  }
  if (random.chance(0.4)) lightRoom(draft, room, random.logRange(5, 50));
  for (int i = random.integer(0, 4); i > 0; --i) placeFree(draft, room, makeCrates(draft), 0.2f);
  if (random.chance(0.4)) furnish(draft, room, Theme::bare, 0.4);
}

}  // namespace odis::learn
