#include <algorithm>

#include "learn/scenes/furniture.h"
#include "learn/scenes/kinds.h"
#include "learn/scenes/lamps.h"
#include "learn/scenes/skies.h"

namespace odis::learn {

namespace {

// A house front with windows as niches, some of them lit.
void addHouse(Draft& draft, const Vec3& min, const Vec3& max, bool night) {
  Random& random = draft.random;
  const MaterialId wall = draft.materials.wall();
  draft.addBox(min, {max.x, max.y, max.z}, wall);
  draft.addBox({min.x - 0.15f, min.y - 0.15f, max.z}, {max.x + 0.15f, max.y + 0.15f, max.z + 0.2f},
               draft.materials.wood());
  MeshData dark, lit;
  const auto pitch = float(random.range(1.8, 3));
  for (int side = 0; side < 4; ++side) {
    const bool alongX = side < 2;
    const float length = alongX ? max.x - min.x : max.y - min.y;
    const Vec3 n = side == 0   ? Vec3(0, -1, 0)
                   : side == 1 ? Vec3(0, 1, 0)
                   : side == 2 ? Vec3(-1, 0, 0)
                               : Vec3(1, 0, 0);
    for (float z = min.z + 1; z + 1.4f < max.z; z += 2.8f)
      for (float s = pitch / 2; s + 1 < length; s += pitch) {
        Vec3 corner(alongX      ? min.x + s
                    : side == 2 ? min.x
                                : max.x,
                    alongX ? (side == 0 ? min.y : max.y) : min.y + s, z);
        const Vec3 u = alongX ? Vec3(0.9f, 0, 0) : Vec3(0, 0.9f, 0);
        addQuad(night && random.chance(0.25) ? lit : dark, corner + n * 0.01f, u, {0, 0, 1.3f}, n);
      }
  }
  if (!dark.triangles.empty())
    draft.add(std::move(dark), random.chance(0.5) ? draft.materials.metal(0.02f) : draft.materials.lacquer());
  if (!lit.triangles.empty())
    draft.add(std::move(lit), kNoMaterial, radianceOf(random, random.logRange(1, 10), 1));
}

void addTree(Draft& draft, const Vec3& at) {
  Random& random = draft.random;
  const auto height = float(random.range(2.5, 7)), crown = height * float(random.range(0.2, 0.35));
  MeshData trunk, leaves;
  addCylinder(trunk, at, height * 0.03f, height * 0.6f, 10);
  draft.add(std::move(trunk), draft.materials.wood());
  if (random.chance(0.3)) {
    const Vec2 cone[] = {{0, height * 0.2f}, {crown, height * 0.2f}, {0, height}};
    addLathe(leaves, at, cone, 14);
  } else {
    // Leaves at random in a ball, so that light comes through.
    for (int i = 0; i < 350; ++i) {
      const Vec3 d(float(random.range(-1, 1)), float(random.range(-1, 1)), float(random.range(-1, 1)));
      if (render::length(d) > 1) continue;
      const Vec3 p = at + Vec3(0, 0, height * 0.7f) + d * Vec3(crown, crown, height * 0.3f);
      const Vec3 u = render::normalize(Vec3(float(random.range(-1, 1)), float(random.range(-1, 1)), 0.3f));
      const render::CoordinateFrame frame(u);
      const float size = crown * 0.22f;
      addQuad(leaves, p, frame.s * size, frame.t * size, {0, 0, 1});
    }
  }
  draft.add(std::move(leaves), draft.materials.foliage());
}

void addStreetLamp(Draft& draft, const Vec3& at, double power) {
  Random& random = draft.random;
  const auto height = float(random.range(3, 5));
  Piece lamp;
  MeshData pole, hood;
  addCylinder(pole, Vec3(0), 0.05f, height, 12);
  addBar(pole, {0, 0, height}, {0, 0.6f, height + 0.1f}, 0.03f, 8);
  lamp.add(std::move(pole), draft.materials.metal());
  addShade(hood, {0, 0.6f, height - 0.05f}, {0.22f, 0.05f, 0.15f, 0.01f}, 20);
  lamp.add(std::move(hood), draft.materials.metal());
  lamp.balls.push_back({{0, 0.6f, height}, 0.06f, kNoMaterial, radianceOf(random, power, 4 * M_PI * 0.0036)});
  draft.add(lamp, at, float(random.range(0, 2 * M_PI)));
}

// Two rows of houses along x.
void buildStreet(Draft& draft, float reach, bool night) {
  Random& random = draft.random;
  const auto half = float(random.range(3, 7));
  for (const float side : {-1.0f, 1.0f})
    for (float x = -reach; x < reach;) {
      const auto width = float(random.range(5, 12)), height = float(random.logRange(4, 16)),
                 depth = float(random.range(5, 9));
      const float y = side * half, far = side * (half + depth);
      if (random.chance(0.85))
        addHouse(draft, {x, std::min(y, far), 0}, {x + width, std::max(y, far), height}, night);
      x += width + float(random.pick({0.02, 0.5, 3.0}));
    }
  for (const float side : {-1.0f, 1.0f})
    draft.addBox({-reach, side > 0 ? half - 1.3f : -half, -0.1f},
                 {reach, side > 0 ? half : -half + 1.3f, 0.12f}, draft.materials.matt(Rgb(0.35f)));
  if (night)
    for (float x = -reach * 0.7f; x < reach * 0.7f; x += float(random.range(6, 14)))
      addStreetLamp(draft, {x, (random.chance(0.5) ? 1.0f : -1.0f) * (half - 1.0f), 0.12f},
                    random.logRange(20, 200));
  draft.scene.standing.push_back(
      {{{-12, -half + 0.5f}, {12, -half + 0.5f}, {12, half - 0.5f}, {-12, half - 0.5f}}, 0, 4});
}

// A court with columns around it, as in a cloister.
void buildCourt(Draft& draft, bool night) {
  Random& random = draft.random;
  const auto half = float(random.range(4, 8)), walk = float(random.range(2, 3.5)),
             height = float(random.range(3, 4.5));
  const MaterialId stone = draft.materials.wall();
  const float outer = half + walk;
  for (const float side : {-1.0f, 1.0f}) {
    const float a = std::min(side * outer, side * (outer + 0.3f)),
                b = std::max(side * outer, side * (outer + 0.3f));
    draft.addBox({a, -outer - 0.3f, -0.1f}, {b, outer + 0.3f, height + 1}, stone);
    draft.addBox({-outer, a, -0.1f}, {outer, b, height + 1}, stone);
    const float c = std::min(side * half, side * outer), d = std::max(side * half, side * outer);
    draft.addBox({c, -outer, height}, {d, outer, height + 0.25f}, draft.materials.wood());
    draft.addBox({-half, c, height}, {half, d, height + 0.25f}, draft.materials.wood());
  }
  MeshData columns;
  const int count = random.integer(3, 7);
  const auto r = float(random.range(0.12, 0.3));
  for (int i = 0; i <= count; ++i)
    for (const float side : {-1.0f, 1.0f}) {
      const float s = -half + 2 * half * float(i) / float(count);
      addCylinder(columns, {s, side * half, 0}, r, height, 20);
      if (i > 0 && i < count) addCylinder(columns, {side * half, s, 0}, r, height, 20);
    }
  draft.add(std::move(columns), random.chance(0.3) ? stone : draft.materials.matt(hue(0.1, 0.15, 0.7)));
  for (int i = random.integer(0, 3); i > 0; --i)
    addTree(draft, {float(random.range(-half, half)) * 0.6f, float(random.range(-half, half)) * 0.6f, 0});
  if (night)
    for (int i = random.integer(1, 5); i > 0; --i)
      addStreetLamp(draft,
                    {float(random.range(-half, half)) * 0.8f, float(random.range(-half, half)) * 0.8f, 0},
                    random.logRange(10, 100));
  draft.scene.standing.push_back(
      {{{-outer, -outer}, {outer, -outer}, {outer, outer}, {-outer, outer}}, 0, height});
}

// Trees, hedges, a pergola and benches.
void buildGarden(Draft& draft, bool night) {
  Random& random = draft.random;
  for (int i = random.integer(3, 16); i > 0; --i)
    addTree(draft, {float(random.range(-12, 12)), float(random.range(-12, 12)), 0});
  for (int i = random.integer(1, 6); i > 0; --i) {
    const Vec3 at(float(random.range(-10, 10)), float(random.range(-10, 10)), 0);
    const bool turned = random.chance(0.5);
    const Vec3 half(turned ? 0.3f : 2.0f, turned ? 2.0f : 0.3f, 0);
    draft.addBox(at - half - Vec3(0, 0, 0.1f), at + half + Vec3(0, 0, float(random.range(0.6, 2))),
                 draft.materials.foliage());
  }
  // Beams on posts that cut the sun into stripes.
  MeshData wood;
  const Vec3 size(float(random.range(2, 5)), float(random.range(2, 4)), 2.3f);
  for (const float x : {-1.0f, 1.0f})
    for (const float y : {-1.0f, 1.0f})
      addBox(wood, {x * size.x - 0.06f, y * size.y - 0.06f, 0},
             {x * size.x + 0.06f, y * size.y + 0.06f, size.z});
  const auto pitch = float(random.range(0.15, 0.5));
  for (float x = -size.x - 0.2f; x < size.x + 0.2f; x += pitch)
    addBox(wood, {x, -size.y - 0.2f, size.z}, {x + 0.05f, size.y + 0.2f, size.z + 0.12f});
  draft.add(std::move(wood), draft.materials.wood());
  Piece table = makeTable(draft, 1.6f, 0.8f, 0.74f);
  decorate(draft, table, 0.6);
  draft.add(table, Vec3(0), 0);
  for (int i = 0; i < 4; ++i)
    draft.add(makeChair(draft), {float(i / 2) * 0.8f - 0.4f, i % 2 == 0 ? 0.65f : -0.65f, 0},
              i % 2 == 0 ? render::kPi : 0);
  draft.scene.interests.push_back({0, 0, 0.8f});
  if (night)
    for (int i = random.integer(1, 6); i > 0; --i)
      addStreetLamp(draft, {float(random.range(-8, 8)), float(random.range(-8, 8)), 0},
                    random.logRange(10, 100));
  draft.scene.standing.push_back({{{-9, -9}, {9, -9}, {9, 9}, {-9, 9}}, 0, 4});
}

}  // namespace

void buildOutdoor(Draft& draft) {
  Random& random = draft.random;
  draft.scene.indoors = false;
  const bool night = random.chance(0.3);
  const float reach = 300;  // the horizon
  MeshData ground;
  addQuad(ground, {-reach, -reach, 0}, {2 * reach, 0, 0}, {0, 2 * reach, 0}, {0, 0, 1});
  draft.add(std::move(ground), random.chance(0.6) ? draft.materials.floor() : draft.materials.foliage());
  switch (random.integer(0, 2)) {
    case 0:
      buildStreet(draft, 26, night);
      break;
    case 1:
      buildCourt(draft, night);
      break;
    default:
      buildGarden(draft, night);
      break;
  }
  for (int i = random.integer(0, 6); i > 0; --i) {
    const Piece thing =
        random.chance(0.5) ? makeCrates(draft) : makePlant(draft, float(random.range(0.5, 1.5)));
    const Vec3 at(float(random.range(-5, 5)), float(random.range(-3, 3)), 0.001f);
    draft.add(thing, at, float(random.range(0, 6)));
    draft.scene.interests.push_back(at + Vec3(0, 0, 0.5f));
  }
  if (night) {
    Environment& e = draft.scene.environment;
    e.kind = Environment::Kind::constant;
    e.radiance = hue(0.62, 0.6, 1);
    e.scale = float(random.logRange(1e-4, 0.05));
  } else {
    addSky(draft, skyDirection(random.range(0, 2 * M_PI), random.range(0.1, 1.3)));
  }
}

}  // namespace odis::learn
