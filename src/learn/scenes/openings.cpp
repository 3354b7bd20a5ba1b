// Doors and windows.
#include <algorithm>

#include "learn/scenes/room.h"

namespace odis::learn {

using render::kPi;

namespace {

// Boxes given along a wall: s along it, d into the room (negative: into the wall), z up.
class WallBoxes {
 public:
  WallBoxes(Draft& draft, const Room& room, size_t wall) : m_draft(draft), m_room(room), m_wall(wall) {}

  void add(const Vec3& min, const Vec3& max, MaterialId material) {
    MeshData box, mesh;
    addBox(box, min, max);
    append(mesh, box, placed(m_room.at(m_wall, 0, 0, 0), m_room.angle(m_wall)));
    m_draft.add(std::move(mesh), material);
  }

 private:
  Draft& m_draft;
  const Room& m_room;
  size_t m_wall;
};

// Width of its bars, and how far it reaches to the front and to the back of the wall's inner side.
struct FrameSize {
  float width, front, back;
};

void addFrame(WallBoxes& boxes, const Opening& o, const FrameSize& size, bool sill, MaterialId material) {
  const auto [width, front, back] = size;
  boxes.add({o.left, back, o.bottom}, {o.left + width, front, o.top}, material);
  boxes.add({o.right - width, back, o.bottom}, {o.right, front, o.top}, material);
  boxes.add({o.left + width, back, o.top - width}, {o.right - width, front, o.top}, material);
  if (sill) boxes.add({o.left + width, back, o.bottom}, {o.right - width, front, o.bottom + width}, material);
}

void addBlinds(Draft& draft, WallBoxes& boxes, const Room& room, const Opening& o) {
  draft.tag("blinds");
  const auto pitch = float(draft.random.range(0.04, 0.12)), share = float(draft.random.range(0.4, 1));
  const auto tilt = float(draft.random.range(-0.9, 0.9));
  const MaterialId material = draft.materials.lacquer();
  const float depth = pitch * 1.05f, bottom = o.top - o.height() * share;
  const Vec2 u = room.along(o.wall), n = room.inward(o.wall);
  const Vec3 across(u.x * o.width(), u.y * o.width(), 0);
  MeshData slats;
  for (float z = o.top - pitch / 2; z > bottom; z -= pitch) {
    const Vec3 chord = (Vec3(n.x, n.y, 0) * std::cos(tilt) + Vec3(0, 0, std::sin(tilt))) * depth;
    const Vec3 start = room.at(o.wall, o.left, 0.06f, z) - chord * 0.5f;
    addQuad(slats, start, across, chord, {0, 0, 1});
  }
  draft.add(std::move(slats), material);
  boxes.add({o.left, 0.01f, o.top}, {o.right, 0.1f, o.top + 0.06f}, material);
}

void addCurtains(Draft& draft, const Room& room, const Opening& o) {
  draft.tag("curtains");
  // Folded sheets that leave a gap in the middle.
  const bool sheer = draft.random.chance(0.35);
  const MaterialId material =
      sheer ? draft.materials.sheer(float(draft.random.range(0.3, 0.85))) : draft.materials.fabric();
  const float half = o.width() / 2 + 0.15f, gap = half * float(draft.random.pick({0.0, 0.08, 0.3, 0.7}));
  const float top = std::min(o.top + 0.15f, room.height - 0.02f);
  const float bottom = draft.random.chance(0.6) || o.bottom < 0.3f ? 0.02f : o.bottom - 0.15f;
  const float middle = (o.left + o.right) / 2;
  const auto fold = float(draft.random.range(0.08, 0.2)), depth = float(draft.random.range(0.02, 0.05));
  MeshData mesh;
  for (const float side : {-1.0f, 1.0f})
    for (float s = gap; s < half; s += fold / 6) {
      const float s1 = std::min(s + fold / 6, half);
      const auto place = [&](float at) {
        return room.at(o.wall, middle + side * at, 0.1f + depth * std::sin(2 * kPi * at / fold), bottom);
      };
      const Vec2 n = room.inward(o.wall);
      addQuad(mesh, place(s), place(s1) - place(s), {0, 0, top - bottom}, {n.x, n.y, 0}, {s, 0});
    }
  draft.add(std::move(mesh), material);
}

}  // namespace

void addDoor(Draft& draft, const Room& room, const Opening& o, float angle) {
  WallBoxes boxes(draft, room, o.wall);
  const MaterialId wood = draft.materials.wood();
  constexpr float kFrame = 0.05f, kLeaf = 0.04f;
  addFrame(boxes, o, {kFrame, 0.02f, -room.thickness - 0.02f}, false, wood);
  // The leaf hangs on the left or on the right.
  const bool left = draft.random.chance(0.5);
  const float width = o.width() - 2 * kFrame - 0.01f;
  Piece leaf;
  leaf.addBox({0, -kLeaf, o.bottom + 0.005f}, {width, 0, o.top - kFrame - 0.01f}, wood);
  MeshData handle;
  addBar(handle, {width - 0.07f, -0.09f, 1}, {width - 0.07f, 0.05f, 1}, 0.012f, 10);
  addBar(handle, {width - 0.2f, 0.05f, 1}, {width - 0.06f, 0.05f, 1}, 0.012f, 10);
  leaf.add(std::move(handle), draft.materials.metal());
  const Vec2 u = room.along(o.wall);
  const float direction = std::atan2(u.y, u.x);
  if (left)
    draft.add(leaf, room.at(o.wall, o.left + kFrame, 0.02f, 0), direction + angle);
  else
    draft.add(leaf, room.at(o.wall, o.right - kFrame, 0.02f, 0), direction + kPi - angle);
}

void addWindow(Draft& draft, const Room& room, const Opening& o) {
  WallBoxes boxes(draft, room, o.wall);
  Random& random = draft.random;
  const MaterialId frame = random.chance(0.5) ? draft.materials.matt(Rgb(0.8f)) : draft.materials.wood();
  const float back = -room.thickness * 0.7f, front = back + 0.06f;
  addFrame(boxes, o, {0.06f, front, back}, true, frame);
  // Bars cut it into panes.
  const int columns = std::max(1, int(std::lround(o.width() / random.range(0.5, 1.5))));
  const int rows = random.chance(0.3) ? 2 : 1;
  for (int i = 1; i < columns; ++i) {
    const float s = o.left + o.width() * float(i) / float(columns);
    boxes.add({s - 0.025f, back, o.bottom}, {s + 0.025f, front, o.top}, frame);
  }
  for (int j = 1; j < rows; ++j) {
    const float z = o.bottom + o.height() * float(j) / float(rows);
    boxes.add({o.left, back, z - 0.02f}, {o.right, front, z + 0.02f}, frame);
  }
  if (o.bottom > 0.3f && random.chance(0.7))
    boxes.add({o.left - 0.05f, 0, o.bottom - 0.04f}, {o.right + 0.05f, 0.12f, o.bottom}, frame);
  if (random.chance(0.12)) {
    draft.tag("pane");
    MeshData pane;
    const Vec2 u = room.along(o.wall), n = room.inward(o.wall);
    addQuad(pane, room.at(o.wall, o.left, back + 0.03f, o.bottom), Vec3(u.x, u.y, 0) * o.width(),
            {0, 0, o.height()}, {n.x, n.y, 0});
    draft.add(std::move(pane), draft.materials.pane());
  }
  switch (random.weighted({5, 2, 2.5})) {
    case 1:
      addBlinds(draft, boxes, room, o);
      break;
    case 2:
      addCurtains(draft, room, o);
      break;
    default:
      break;
  }
  const Vec3 middle = room.at(o.wall, (o.left + o.right) / 2, 0, (o.bottom + o.top) / 2);
  draft.scene.interests.push_back(middle);
}

}  // namespace odis::learn
