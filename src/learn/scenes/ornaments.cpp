// Small things that stand on others.
#include <algorithm>

#include "learn/scenes/furniture.h"

namespace odis::learn {

namespace {

Piece makeBooks(Draft& draft, float most) {
  Piece piece;
  float z = 0;
  const float width = std::min(most, 0.22f);
  for (int i = draft.random.integer(1, 4); i > 0; --i) {
    const auto thickness = float(draft.random.range(0.015, 0.04));
    MeshData book, turned;
    addBox(book, {-width / 2, -width * 0.35f, z}, {width / 2, width * 0.35f, z + thickness});
    append(turned, book, placed(Vec3(0), float(draft.random.range(-0.2, 0.2))));
    piece.add(std::move(turned), draft.materials.lacquer());
    z += thickness;
  }
  piece.size = {width * 1.2f, width * 0.9f, z};
  return piece;
}

// A vessel of revolution with walls: vase, bottle, bowl or cup.
Piece makeVessel(Draft& draft, float most) {
  Random& random = draft.random;
  const auto radius = std::min(most / 2, float(random.logRange(0.03, 0.14)));
  const float height = radius * float(random.pick({0.8, 2.0, 3.5, 5.0}));
  const float neck = float(random.range(0.35, 1.1)), belly = float(random.range(0.8, 1)),
              wall = std::min(0.006f, radius * 0.1f);
  constexpr int kSteps = 12;
  std::vector<Vec2> profile{{0, 0}};
  const auto radiusAt = [&](float t) {
    const float bulge = std::sin(render::kPi * std::min(1.0f, 0.15f + t * 0.85f));
    return radius * std::clamp(belly * bulge + neck * t * t * 0.8f, 0.12f, 1.0f);
  };
  for (int i = 0; i <= kSteps; ++i)
    profile.emplace_back(radiusAt(float(i) / kSteps), height * float(i) / kSteps);
  for (int i = kSteps; i >= 1; --i)
    profile.emplace_back(std::max(radiusAt(float(i) / kSteps) - wall, 0.001f), height * float(i) / kSteps);
  profile.emplace_back(0.0f, height / kSteps);
  Piece piece;
  MeshData mesh;
  addLathe(mesh, Vec3(0), profile, 28, true);
  piece.add(std::move(mesh), random.chance(0.3) ? draft.materials.glass() : draft.materials.anything());
  piece.size = {2 * radius, 2 * radius, height};
  return piece;
}

Piece makeSolid(Draft& draft, float most) {
  Random& random = draft.random;
  Piece piece;
  const float r = std::min(most / 2, float(random.logRange(0.02, 0.15)));
  const MaterialId material = draft.materials.anything();
  MeshData mesh;
  float height = 2 * r;
  switch (random.integer(0, 4)) {
    case 0:
      piece.balls.push_back({{0, 0, r}, r, material, Rgb(0.0f)});
      break;
    case 1:
      addBox(mesh, {-r * 0.7f, -r * 0.7f, 0}, {r * 0.7f, r * 0.7f, height});
      break;
    case 2:
      addCylinder(mesh, Vec3(0), r, height, 28);
      break;
    case 3: {
      const Vec2 cone[] = {{0, 0}, {r, 0}, {0, height}};
      addLathe(mesh, Vec3(0), cone, 28);
      break;
    }
    default:
      addCushion(mesh, {0, 0, r}, Vec3(r), float(random.range(0.2, 1.6)));
      break;
  }
  if (!mesh.triangles.empty()) piece.add(std::move(mesh), material);
  piece.size = {2 * r, 2 * r, height};
  return piece;
}

}  // namespace

Piece makeOrnament(Draft& draft, float most) {
  if (!draft.assets.furniture().empty() && draft.random.chance(0.3)) {
    Piece model = makeModel(draft, Vec3(most, most, 0.5f), true);
    if (!model.parts.empty()) return model;
  }
  switch (draft.random.weighted({2, 3, 2, 0.7})) {
    case 0:
      return makeBooks(draft, most);
    case 1:
      return makeVessel(draft, most);
    case 2:
      return makeSolid(draft, most);
    default:
      return makePlant(draft, std::min(most * 1.3f, float(draft.random.range(0.15, 0.5))));
  }
}

void decorate(Draft& draft, Piece& piece, double density) {
  Random& random = draft.random;
  for (const Piece::Top& top : std::vector<Piece::Top>(piece.tops)) {
    // A row of places along the longer side, some of them taken.
    const bool wide = top.half.x > top.half.y;
    const float length = 2 * std::max(top.half.x, top.half.y), across = 2 * std::min(top.half.x, top.half.y);
    const int places = std::max(1, int(length / 0.3f));
    const float place = length / float(places);
    for (int i = 0; i < places; ++i) {
      if (!random.chance(density)) continue;
      const Piece thing = makeOrnament(draft, std::min({place * 0.85f, across * 0.9f, top.clearance}));
      const float room = std::max(0.0f, (across - thing.size.y) / 2);
      const float s = (float(i) + 0.5f) * place - length / 2, t = room * float(random.range(-1, 1));
      const Vec3 at = top.center + (wide ? Vec3(s, t, 0) : Vec3(t, s, 0));
      const Matrix4 placement = placed(at, float(random.range(0, 2 * M_PI)));
      for (const Part& part : thing.parts) {
        MeshData mesh;
        append(mesh, part.mesh, placement);
        piece.add(std::move(mesh), part.material, part.radiance);
      }
      for (Ball ball : thing.balls) {
        ball.center = render::transformPoint(placement, ball.center);
        piece.balls.push_back(ball);
      }
    }
  }
}

}  // namespace odis::learn
