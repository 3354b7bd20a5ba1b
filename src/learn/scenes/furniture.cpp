#include "learn/scenes/furniture.h"

#include <algorithm>
#include <vector>

namespace odis::learn {

namespace {

// Four legs within a rectangle.
void addLegs(MeshData& mesh, float halfWidth, float halfDepth, float height, float thickness, bool round) {
  for (const float x : {-1.0f, 1.0f})
    for (const float y : {-1.0f, 1.0f}) {
      const Vec3 foot(x * (halfWidth - thickness), y * (halfDepth - thickness), 0);
      if (round)
        addCylinder(mesh, foot, thickness / 2, height, 12);
      else
        addBox(mesh, foot - Vec3(thickness / 2, thickness / 2, 0),
               foot + Vec3(thickness / 2, thickness / 2, height));
    }
}

}  // namespace

Piece makeTable(Draft& draft, float width, float depth, float height) {
  Random& random = draft.random;
  Piece piece;
  const auto board = float(random.range(0.02, 0.05));
  const MaterialId material = random.chance(0.12)  ? draft.materials.glass()
                              : random.chance(0.2) ? draft.materials.lacquer()
                                                   : draft.materials.wood();
  piece.addBox({-width / 2, -depth / 2, height - board}, {width / 2, depth / 2, height}, material);
  MeshData legs;
  addLegs(legs, width / 2 - 0.03f, depth / 2 - 0.03f, height - board, float(random.range(0.03, 0.08)),
          random.chance(0.4));
  piece.add(std::move(legs), random.chance(0.3) ? draft.materials.metal() : draft.materials.wood());
  piece.size = {width, depth, height};
  piece.tops.push_back({{0, 0, height}, {width / 2 - 0.05f, depth / 2 - 0.05f}, 0.6f});
  return piece;
}

Piece makeRoundTable(Draft& draft, float radius, float height) {
  Piece piece;
  MeshData mesh;
  addCylinder(mesh, {0, 0, height - 0.03f}, radius, 0.03f, 40);
  const Vec2 foot[] = {
      {0, 0}, {radius * 0.6f, 0}, {radius * 0.6f, 0.02f}, {0.05f, 0.06f}, {0.04f, height - 0.03f}};
  addLathe(mesh, Vec3(0), foot, 24);
  piece.add(std::move(mesh), draft.random.chance(0.3) ? draft.materials.lacquer() : draft.materials.wood());
  piece.size = {2 * radius, 2 * radius, height};
  piece.tops.push_back({{0, 0, height}, Vec2(radius * 0.65f), 0.6f});
  return piece;
}

Piece makeChair(Draft& draft) {
  Random& random = draft.random;
  Piece piece;
  const auto width = float(random.range(0.4, 0.5)), seat = float(random.range(0.42, 0.47)),
             back = float(random.range(0.8, 1.05));
  const MaterialId wood = random.chance(0.3) ? draft.materials.metal() : draft.materials.wood();
  const bool soft = random.chance(0.4);
  MeshData frame;
  addLegs(frame, width / 2, width / 2, seat - 0.04f, 0.035f, random.chance(0.5));
  for (const float x : {-1.0f, 1.0f})
    addBox(frame, {x * (width / 2 - 0.035f) - 0.0175f, -width / 2, seat - 0.04f},
           {x * (width / 2 - 0.035f) + 0.0175f, -width / 2 + 0.035f, back});
  if (random.chance(0.5)) {
    for (float z = seat + 0.12f; z < back; z += 0.13f)
      addBox(frame, {-width / 2 + 0.05f, -width / 2 + 0.005f, z},
             {width / 2 - 0.05f, -width / 2 + 0.025f, z + 0.05f});
  } else {
    addBox(frame, {-width / 2 + 0.05f, -width / 2 + 0.005f, seat + 0.15f},
           {width / 2 - 0.05f, -width / 2 + 0.025f, back});
  }
  piece.add(std::move(frame), wood);
  MeshData cushion;
  if (soft)
    addCushion(cushion, {0, 0, seat}, {width / 2, width / 2, 0.045f}, 0.35f);
  else
    addBox(cushion, {-width / 2, -width / 2 + 0.03f, seat - 0.04f}, {width / 2, width / 2, seat});
  piece.add(std::move(cushion), soft ? draft.materials.fabric() : wood);
  piece.size = {width, width, back};
  return piece;
}

Piece makeStool(Draft& draft) {
  Piece piece;
  const auto radius = float(draft.random.range(0.15, 0.3)), height = float(draft.random.range(0.35, 0.7));
  MeshData mesh;
  addCylinder(mesh, {0, 0, height - 0.05f}, radius, 0.05f, 28);
  addLegs(mesh, radius * 0.8f, radius * 0.8f, height - 0.05f, 0.03f, true);
  piece.add(std::move(mesh), draft.materials.anything());
  piece.size = {2 * radius, 2 * radius, height};
  piece.tops.push_back({{0, 0, height}, Vec2(radius * 0.5f), 0.5f});
  return piece;
}

Piece makeShelf(Draft& draft, float width, float height) {
  Random& random = draft.random;
  Piece piece;
  const auto depth = float(random.range(0.25, 0.4));
  constexpr float kBoard = 0.025f;
  const MaterialId wood = draft.materials.wood();
  const int columns = std::max(1, int(std::lround(width / 0.9))),
            rows = std::max(2, int(std::lround(height / 0.37)));
  MeshData frame;
  for (int i = 0; i <= columns; ++i) {
    const float x = -width / 2 + (width - kBoard) * float(i) / float(columns);
    addBox(frame, {x, -depth / 2, 0}, {x + kBoard, depth / 2, height});
  }
  for (int j = 0; j <= rows; ++j) {
    const float z = (height - kBoard) * float(j) / float(rows);
    addBox(frame, {-width / 2 + kBoard, -depth / 2, z}, {width / 2 - kBoard, depth / 2, z + kBoard});
  }
  if (random.chance(0.6))
    addBox(frame, {-width / 2 + kBoard, -depth / 2, kBoard},
           {width / 2 - kBoard, -depth / 2 + 0.008f, height - kBoard});
  piece.add(std::move(frame), wood);
  // Books in some of the compartments, row by row of one colour each.
  const double filled = random.pick({0.2, 0.6, 0.9});
  const float cell = (width - kBoard) / float(columns), clear = height / float(rows) - 2 * kBoard;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) {
      if (!random.chance(filled)) continue;
      const float left = -width / 2 + cell * float(i) + kBoard + 0.01f,
                  bottom = (height - kBoard) * float(j) / float(rows) + kBoard;
      const float end = left + (cell - kBoard - 0.02f) * float(random.range(0.4, 1));
      std::vector<MeshData> books(3);
      for (float x = left; x < end - 0.02f;) {
        const auto thickness = float(random.range(0.015, 0.05));
        addBox(books[size_t(random.integer(0, 2))], {x, -depth / 2 + 0.02f, bottom},
               {std::min(x + thickness, end), depth / 2 - float(random.range(0.02, 0.1)),
                bottom + clear * float(random.range(0.6, 0.97))});
        x += thickness + 0.002f;
      }
      for (MeshData& book : books) piece.add(std::move(book), draft.materials.lacquer());
    }
  piece.size = {width, depth, height};
  if (height < 1.6f) piece.tops.push_back({{0, 0, height}, {width / 2 - 0.05f, depth / 2 - 0.03f}, 0.5f});
  return piece;
}

Piece makeCabinet(Draft& draft, float width, float height) {
  Random& random = draft.random;
  Piece piece;
  const auto depth = float(random.range(0.4, 0.6));
  const MaterialId body = random.chance(0.6) ? draft.materials.wood() : draft.materials.lacquer();
  piece.addBox({-width / 2, -depth / 2, 0.06f}, {width / 2, depth / 2 - 0.02f, height}, body);
  piece.addBox({-width / 2 + 0.03f, -depth / 2, 0}, {width / 2 - 0.03f, depth / 2 - 0.06f, 0.06f}, body);
  const MaterialId front = random.chance(0.5) ? body : draft.materials.lacquer();
  const int columns = std::max(1, int(std::lround(width / 0.5))),
            rows = height > 1.2f ? 1 : random.integer(1, 4);
  MeshData doors, handles;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) {
      const float w = width / float(columns), h = (height - 0.06f) / float(rows);
      const Vec3 min(-width / 2 + w * float(i) + 0.004f, depth / 2 - 0.02f, 0.06f + h * float(j) + 0.004f);
      addBox(doors, min, {min.x + w - 0.008f, depth / 2, min.z + h - 0.008f});
      const float x = min.x + w / 2, z = min.z + h * 0.8f;
      addBar(handles, {x - 0.05f, depth / 2 + 0.02f, z}, {x + 0.05f, depth / 2 + 0.02f, z}, 0.006f, 8);
    }
  piece.add(std::move(doors), front);
  piece.add(std::move(handles), draft.materials.metal());
  piece.size = {width, depth, height};
  if (height < 1.5f) piece.tops.push_back({{0, 0, height}, {width / 2 - 0.05f, depth / 2 - 0.05f}, 0.6f});
  return piece;
}

Piece makeSofa(Draft& draft, float width) {
  Random& random = draft.random;
  Piece piece;
  const auto depth = float(random.range(0.8, 1)), exponent = float(random.range(0.15, 0.35));
  const MaterialId fabric = draft.materials.fabric();
  MeshData body;
  addCushion(body, {0, 0, 0.22f}, {width / 2, depth / 2, 0.14f}, exponent);
  addCushion(body, {0, -depth / 2 + 0.12f, 0.48f}, {width / 2, 0.12f, 0.36f}, exponent);
  for (const float x : {-1.0f, 1.0f})
    addCushion(body, {x * (width / 2 - 0.09f), 0, 0.36f}, {0.09f, depth / 2, 0.25f}, exponent);
  const int seats = std::max(1, int(std::lround(width / 0.75)));
  const float seat = (width - 0.36f) / float(seats);
  for (int i = 0; i < seats; ++i)
    addCushion(body, {-width / 2 + 0.18f + seat * (float(i) + 0.5f), 0.08f, 0.4f},
               {seat / 2, depth / 2 - 0.1f, 0.08f}, exponent);
  addLegs(body, width / 2 - 0.05f, depth / 2 - 0.05f, 0.12f, 0.05f, true);
  piece.add(std::move(body), fabric);
  MeshData pillow;
  addCushion(pillow, {width * float(random.range(-0.3, 0.3)), -0.12f, 0.62f}, {0.2f, 0.1f, 0.18f}, 0.6f);
  piece.add(std::move(pillow), draft.materials.fabric());
  piece.size = {width, depth, 0.84f};
  return piece;
}

Piece makeBed(Draft& draft, float width) {
  Random& random = draft.random;
  Piece piece;
  constexpr float kLength = 2.05f;
  const MaterialId wood = draft.materials.wood();
  piece.addBox({-width / 2, -kLength / 2, 0.1f}, {width / 2, kLength / 2, 0.3f}, wood);
  piece.addBox({-width / 2, -kLength / 2, 0},
               {width / 2, -kLength / 2 + 0.05f, float(random.range(0.6, 1.2))}, wood);
  MeshData legs, mattress, blanket, pillows;
  addLegs(legs, width / 2, kLength / 2, 0.1f, 0.06f, false);
  piece.add(std::move(legs), wood);
  addCushion(mattress, {0, 0.02f, 0.4f}, {width / 2 - 0.02f, kLength / 2 - 0.06f, 0.14f}, 0.2f);
  piece.add(std::move(mattress), draft.materials.fabric());
  addCushion(blanket, {0, 0.35f, 0.46f}, {width / 2 + 0.03f, kLength / 2 - 0.33f, 0.14f}, 0.3f);
  piece.add(std::move(blanket), draft.materials.fabric());
  const int count = width > 1.2f ? 2 : 1;
  for (int i = 0; i < count; ++i)
    addCushion(pillows, {width / float(count) * (float(i) + 0.5f) - width / 2, -0.72f, 0.6f},
               {0.3f, 0.2f, 0.08f}, 0.6f);
  piece.add(std::move(pillows), draft.materials.fabric());
  piece.size = {width, kLength, 0.8f};
  return piece;
}

Piece makePlant(Draft& draft, float height) {
  Random& random = draft.random;
  Piece piece;
  const float pot = height * float(random.range(0.2, 0.35));
  MeshData vessel, leaves;
  const Vec2 profile[] = {
      {0, 0},         {pot * 0.4f, 0}, {pot * 0.55f, pot}, {pot * 0.5f, pot}, {pot * 0.48f, pot * 0.9f},
      {0, pot * 0.9f}};
  addLathe(vessel, Vec3(0), profile, 24);
  piece.add(std::move(vessel), draft.materials.lacquer());
  // Leaves are bent strips that start in the pot and lean outwards.
  const int count = random.integer(15, 50);
  const float reach = height * float(random.range(0.2, 0.45));
  for (int i = 0; i < count; ++i) {
    const auto phi = float(random.range(0, 2 * M_PI)), top = float(random.range(0.5, 1)),
               lean = reach * float(random.range(0.3, 1));
    const Vec3 out(std::cos(phi), std::sin(phi), 0), side(-out.y, out.x, 0);
    const float width = height * float(random.range(0.02, 0.06));
    Vec3 from(0, 0, pot * 0.9f);
    constexpr int kPieces = 4;
    for (int k = 1; k <= kPieces; ++k) {
      const float t = float(k) / kPieces;
      const Vec3 to = out * (lean * t * t) +
                      Vec3(0, 0, pot * 0.9f + (height - pot) * top * (1.4f * t - 0.4f * t * t * t * t));
      addQuad(leaves, from - side * (width / 2), side * width, to - from, {0, 0, 1});
      from = to;
    }
  }
  piece.add(std::move(leaves), draft.materials.foliage());
  piece.size = {2 * reach, 2 * reach, height};
  return piece;
}

Piece makeCrates(Draft& draft) {
  Random& random = draft.random;
  Piece piece;
  const auto edge = float(random.range(0.25, 0.8));
  float z = 0;
  for (int i = random.integer(1, 3); i > 0; --i) {
    const float half = edge / 2 * float(random.range(0.7, 1)), top = z + edge * float(random.range(0.5, 1));
    MeshData box, turned;
    addBox(box, {-half, -half, z}, {half, half, top});
    append(turned, box, placed(Vec3(0), float(random.range(-0.3, 0.3))));
    piece.add(std::move(turned), draft.materials.anything());
    z = top;
  }
  piece.size = {edge * 1.25f, edge * 1.25f, z};
  return piece;
}

Piece makePicture(Draft& draft, float width, float height, MaterialId front) {
  Piece piece;
  constexpr float kBar = 0.025f;
  MeshData frame, sheet;
  const Hole hole{-width / 2 + kBar, width / 2 - kBar, -height / 2 + kBar, height / 2 - kBar};
  addPanel(
      frame,
      {{0, 0.03f, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}, -width / 2, width / 2, -height / 2, height / 2, 0.03f},
      std::span(&hole, 1));
  piece.add(std::move(frame), draft.random.chance(0.4) ? draft.materials.metal() : draft.materials.wood());
  addQuad(sheet, {hole.left, 0.012f, hole.bottom}, {hole.right - hole.left, 0, 0},
          {0, 0, hole.top - hole.bottom}, {0, 1, 0});
  piece.add(std::move(sheet), front);
  piece.size = {width, 0.03f, height};
  return piece;
}

}  // namespace odis::learn
