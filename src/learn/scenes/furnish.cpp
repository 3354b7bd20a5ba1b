#include "learn/scenes/furnish.h"

#include <algorithm>

#include "learn/scenes/furniture.h"
#include "learn/scenes/lamps.h"

namespace odis::learn {

namespace {

// The half size of what a piece covers when turned.
Vec2 footprint(const Piece& piece, float angle) {
  const float c = std::abs(std::cos(angle)), s = std::abs(std::sin(angle));
  return Vec2(piece.size.x * c + piece.size.y * s, piece.size.x * s + piece.size.y * c) * 0.5f;
}

// Whether something of this height may stand before a stretch of wall.
bool wallIsFree(const Room& room, size_t wall, float left, float right, float height) {
  return std::none_of(room.openings.begin(), room.openings.end(), [&](const Opening& o) {
    return o.wall == wall && left < o.right + 0.1f && o.left < right + 0.1f && height > o.bottom - 0.05f;
  });
}

void stand(Draft& draft, const Piece& piece, const Vec3& at, float angle) {
  draft.add(piece, at, angle);
  draft.scene.interests.push_back(at + Vec3(0, 0, std::min(piece.size.z, 1.4f) * 0.7f));
}

// A table in the middle with seats around it.
void placeDining(Draft& draft, Room& room, double density) {
  Random& random = draft.random;
  const bool round = random.chance(0.3);
  Piece table = round ? makeRoundTable(draft, float(random.range(0.4, 0.75)), 0.74f)
                      : makeTable(draft, float(random.range(1, 2.2)), float(random.range(0.7, 1)), 0.74f);
  decorate(draft, table, density);
  const auto angle = float(random.pick({0.0, 0.0, M_PI / 2, 0.4}));
  const Vec2 half = footprint(table, angle);
  for (int attempt = 0; attempt < 12; ++attempt) {
    const Box box = room.box();
    const Vec3 at = attempt == 0 ? Vec3(room.middle().x, room.middle().y, 0)
                                 : Vec3(float(random.range(box.min.x, box.max.x)),
                                        float(random.range(box.min.y, box.max.y)), 0);
    if (!room.contains({at.x, at.y}, std::max(half.x, half.y)) || !room.claim(at, half + Vec2(0.35f), 0))
      continue;
    stand(draft, table, at, angle);
    const Piece chair = makeChair(draft);
    const float reach = chair.size.y * float(random.range(0.2, 0.6));
    const int along = std::max(1, int(table.size.x / 0.65f));
    const Matrix4 placement = placed(at, angle);
    for (const float side : {-1.0f, 1.0f})
      for (int i = 0; i < along; ++i) {
        if (!random.chance(0.85)) continue;
        const float x = (float(i) + 0.5f) / float(along) * table.size.x - table.size.x / 2;
        const Vec3 seat =
            render::transformPoint(placement, {round ? 0 : x, side * (table.size.y / 2 + reach), 0});
        draft.add(chair, seat, angle + (side > 0 ? render::kPi : 0) + float(random.range(-0.2, 0.2)));
      }
    return;
  }
}

Piece makeWallPiece(Draft& draft, Theme theme, double density) {
  Random& random = draft.random;
  if (!draft.assets.furniture().empty() && random.chance(0.55)) {
    Piece model = makeModel(draft, {2.4f, 1.2f, 2.3f}, false);
    if (!model.parts.empty()) return model;
  }
  const auto width = float(random.range(0.7, 1.8));
  Piece piece;
  switch (theme == Theme::working ? random.weighted({2, 2, 0, 3}) : random.weighted({2, 2, 1, 0.5})) {
    case 0:
      piece = makeShelf(draft, width, float(random.range(0.8, 2.1)));
      break;
    case 1:
      piece = makeCabinet(draft, width, float(random.pick({0.5, 0.8, 0.9, 1.9})));
      break;
    case 2:
      piece = makePlant(draft, float(random.range(0.6, 1.8)));
      break;
    default:
      piece = makeTable(draft, width, 0.6f, 0.73f);
      break;
  }
  decorate(draft, piece, density);
  return piece;
}

void placeMain(Draft& draft, Room& room, Theme theme, double density) {
  Random& random = draft.random;
  switch (theme) {
    case Theme::living: {
      placeAtWall(draft, room, makeSofa(draft, float(random.range(1, 2.4))));
      Piece low = makeTable(draft, float(random.range(0.6, 1.2)), float(random.range(0.5, 0.7)),
                            float(random.range(0.3, 0.45)));
      decorate(draft, low, density);
      placeFree(draft, room, low, float(random.range(-0.3, 0.3)));
      if (random.chance(0.6))
        placeFree(draft, room, makeSofa(draft, 0.85f), float(random.range(0, 2 * M_PI)));
      break;
    }
    case Theme::sleeping:
      placeAtWall(draft, room, makeBed(draft, float(random.range(0.9, 1.8))));
      break;
    case Theme::eating:
      placeDining(draft, room, density);
      break;
    case Theme::working: {
      Piece desk = makeTable(draft, float(random.range(1.1, 1.8)), 0.7f, 0.73f);
      decorate(draft, desk, density);
      placeAtWall(draft, room, desk);
      placeFree(draft, room, makeChair(draft), float(random.range(0, 2 * M_PI)));
      break;
    }
    case Theme::storing:
      for (int i = 0; i < 6; ++i) placeFree(draft, room, makeCrates(draft), float(random.range(-0.3, 0.3)));
      break;
    case Theme::bare:
      break;
  }
}

}  // namespace

Theme anyTheme(Random& random) {
  constexpr Theme kThemes[] = {Theme::living,  Theme::sleeping, Theme::eating,
                               Theme::working, Theme::storing,  Theme::bare};
  return kThemes[random.weighted({3, 2, 3, 2, 1.2, 0.8})];
}

bool placeAtWall(Draft& draft, Room& room, const Piece& piece) {
  Random& random = draft.random;
  for (int attempt = 0; attempt < 10; ++attempt) {
    const auto wall = size_t(random.integer(0, int(room.corners.size()) - 1));
    const float space = room.length(wall) - piece.size.x - 0.06f;
    if (space < 0) continue;
    const float s = piece.size.x / 2 + 0.03f + space * float(random.unit());
    if (!wallIsFree(room, wall, s - piece.size.x / 2, s + piece.size.x / 2, piece.size.z)) continue;
    const float angle = room.angle(wall);
    // A gap for the skirting board, which also keeps the corners of a turned box inside.
    const Vec3 at = room.at(wall, s, piece.size.y / 2 + 0.03f, 0);
    const bool straight = std::abs(std::sin(2 * angle)) < 1e-3f;
    const Vec2 half = straight ? footprint(piece, angle) : Vec2(std::min(piece.size.x, piece.size.y) / 2);
    if (!room.claim(at, half - Vec2(0.005f), 0.03f)) continue;
    stand(draft, piece, at, angle);
    return true;
  }
  return false;
}

bool placeFree(Draft& draft, Room& room, const Piece& piece, float angle) {
  const Box box = room.box();
  const Vec2 half = footprint(piece, angle);
  for (int attempt = 0; attempt < 12; ++attempt) {
    const Vec3 at(float(draft.random.range(box.min.x + half.x, box.max.x - half.x)),
                  float(draft.random.range(box.min.y + half.y, box.max.y - half.y)), 0);
    if (!room.claim(at, half, 0.1f)) continue;
    stand(draft, piece, at, angle);
    return true;
  }
  return false;
}

void hangPictures(Draft& draft, Room& room, int count, double mirrors) {
  Random& random = draft.random;
  for (int i = 0; i < count; ++i) {
    const auto wall = size_t(random.integer(0, int(room.corners.size()) - 1));
    const auto width = float(random.logRange(0.25, 1.4)), height = width * float(random.logRange(0.6, 1.6));
    const float z = std::min(float(random.range(1.4, 1.7)), room.height - height / 2 - 0.15f);
    const float space = room.length(wall) - width - 0.2f;
    if (space < 0 || z - height / 2 < 0.2f) continue;
    const float s = 0.1f + width / 2 + space * float(random.unit());
    if (!wallIsFree(room, wall, s - width / 2, s + width / 2, z + height / 2)) continue;
    // Neighbours on the wall must not overlap: the stretch is taken like an opening's.
    room.openings.push_back({wall, s - width / 2, s + width / 2, z - height / 2, z + height / 2});
    const bool mirror = random.chance(mirrors);
    if (mirror) draft.tag("mirror");
    const Piece picture =
        makePicture(draft, width, height, mirror ? draft.materials.mirror() : draft.materials.picture());
    draft.add(picture, room.at(wall, s, 0.002f, z), room.angle(wall));
  }
}

void furnish(Draft& draft, Room& room, Theme theme, double density, int lamps, double power) {
  Random& random = draft.random;
  // The floor before doors stays free.
  for (const Opening& o : room.openings) {
    if (o.bottom > 0.3f) continue;
    const Vec3 at = room.at(o.wall, (o.left + o.right) / 2, 0.5f, 0);
    room.claim(at, Vec2(0.45f), 0);
  }
  if (theme != Theme::bare && random.chance(0.4)) {  // a rug
    const Vec3 middle = room.middle();
    const Vec2 half(float(random.range(0.6, 1.6)), float(random.range(0.5, 1.2)));
    bool inside = true;
    for (const float x : {-1.0f, 1.0f})
      for (const float y : {-1.0f, 1.0f})
        inside = inside && room.contains({middle.x + x * half.x, middle.y + y * half.y}, 0.1f);
    if (inside)
      draft.addBox({middle.x - half.x, middle.y - half.y, 0}, {middle.x + half.x, middle.y + half.y, 0.012f},
                   draft.materials.fabric());
  }
  placeMain(draft, room, theme, density);
  for (int i = 0; i < lamps; ++i) {
    const double share = power / lamps * random.logRange(0.4, 2.5);
    if (random.chance(0.5)) {
      placeAtWall(draft, room, makeFloorLamp(draft, share));
      continue;
    }
    // A lamp on a small table.
    Piece side = makeTable(draft, 0.5f, 0.45f, float(random.range(0.45, 0.75)));
    const Piece lamp = makeTableLamp(draft, share);
    for (Part part : lamp.parts) {
      for (Vec3& p : part.mesh.positions) p.z += side.size.z;
      side.parts.push_back(std::move(part));
    }
    for (Ball ball : lamp.balls) {
      ball.center.z += side.size.z;
      side.balls.push_back(ball);
    }
    side.size.z += lamp.size.z;
    placeAtWall(draft, room, side);
  }
  const Box box = room.box();
  const float area = (box.max.x - box.min.x) * (box.max.y - box.min.y);
  const int pieces = theme == Theme::bare ? 1 : int(std::lround(density * std::sqrt(area) * 2));
  for (int i = 0; i < pieces; ++i) placeAtWall(draft, room, makeWallPiece(draft, theme, density));
  if (random.chance(0.3 * density))
    placeFree(draft, room, makePlant(draft, float(random.range(0.6, 1.6))), 0);
  for (int i = int(density * random.range(0, 4)); i > 0; --i)
    placeFree(draft, room, random.chance(0.5) ? makeStool(draft) : makeCrates(draft),
              float(random.range(0, 2 * M_PI)));
  hangPictures(draft, room, int(density * random.range(0, 6)), 0.15);
}

}  // namespace odis::learn
