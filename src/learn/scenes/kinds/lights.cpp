#include <algorithm>

#include "learn/scenes/furnish.h"
#include "learn/scenes/kinds.h"
#include "learn/scenes/lamps.h"

namespace odis::learn {

namespace {

// Where the lights of a hall are: in a grid below the ceiling, on strings, on the walls, in clusters,
// anywhere.
std::vector<Vec3> arrange(Random& random, const Room& room, int count) {
  const Box box = room.box();
  const Vec3 size = box.max - box.min;
  std::vector<Vec3> places;
  const auto anywhere = [&](float low, float high) {
    return box.min + Vec3(float(random.range(0.02, 0.98)) * size.x, float(random.range(0.02, 0.98)) * size.y,
                          float(random.range(low, high)) * size.z);
  };
  switch (random.integer(0, 4)) {
    case 0: {
      const int columns = std::max(1, int(std::ceil(std::sqrt(double(count) * size.x / size.y))));
      const int rows = (count + columns - 1) / columns;
      for (int i = 0; i < count; ++i)
        places.push_back({box.min.x + size.x * (float(i % columns) + 0.5f) / float(columns),
                          box.min.y + size.y * (float(i / columns) + 0.5f) / float(rows), size.z - 0.06f});
      break;
    }
    case 1: {  // strings that sag between two places below the ceiling
      const int strings = std::max(1, count / random.integer(20, 60));
      const int each = (count + strings - 1) / strings;
      for (int s = 0; s < strings; ++s) {
        const Vec3 a = anywhere(0.8f, 0.95f), b = anywhere(0.8f, 0.95f);
        const auto sag = float(random.range(0.05, 0.3)) * size.z;
        for (int i = 0; i < each && int(places.size()) < count; ++i) {
          const float t = (float(i) + 0.5f) / float(each);
          places.push_back(a + (b - a) * t - Vec3(0, 0, 4 * sag * t * (1 - t)));
        }
      }
      break;
    }
    case 2:
      for (int i = 0; i < count; ++i) {
        const auto wall = size_t(random.integer(0, int(room.corners.size()) - 1));
        places.push_back(room.at(wall, room.length(wall) * float(random.range(0.02, 0.98)), 0.05f,
                                 float(random.range(0.2, 0.95)) * size.z));
      }
      break;
    case 3: {
      std::vector<Vec3> centers(size_t(random.integer(1, 8)));
      for (Vec3& center : centers) center = anywhere(0.3f, 0.85f);
      const auto spread = float(random.range(0.1, 0.6));
      for (int i = 0; i < count; ++i) {
        const Vec3 center = random.pick(std::span<const Vec3>(centers));
        const Vec3 at =
            center +
            Vec3(float(random.range(-1, 1)), float(random.range(-1, 1)), float(random.range(-1, 1))) * spread;
        places.push_back({std::clamp(at.x, box.min.x + 0.1f, box.max.x - 0.1f),
                          std::clamp(at.y, box.min.y + 0.1f, box.max.y - 0.1f),
                          std::clamp(at.z, 0.1f, size.z - 0.1f)});
      }
      break;
    }
    default:
      for (int i = 0; i < count; ++i) places.push_back(anywhere(0.1f, 0.95f));
  }
  std::erase_if(places, [&](const Vec3& p) { return !room.contains({p.x, p.y}, 0.03f); });
  return places;
}

void addOctahedron(MeshData& mesh, const Vec3& at, float r) {
  const Vec2 profile[] = {{0, -r}, {r, 0}, {0, r}};
  addLathe(mesh, at, profile, 4);
}

}  // namespace

void buildLights(Draft& draft) {
  Random& random = draft.random;
  const auto width = float(random.logRange(5, 25));
  Room hall = boxRoom({0, 0}, width, width * float(random.range(0.5, 1)), float(random.range(2.8, 8)));
  addShell(draft, hall);
  const auto count = int(random.logRange(2, 5000));
  const std::vector<Vec3> places = arrange(random, hall, count);
  // Lights of one brightness and colour are one mesh; some are balls of their own.
  const int groups = std::min(count, random.integer(1, 24));
  const auto radius = float(random.logRange(0.01, 0.08));
  const double spread = random.logRange(1.5, 300);
  const bool balls = places.size() <= 150 && random.chance(0.5);
  std::vector<MeshData> meshes{size_t(groups)};
  // Views are of some of them, too.
  for (size_t i = 0; i < std::min<size_t>(places.size(), 4); ++i)
    draft.scene.interests.push_back(random.pick(std::span<const Vec3>(places)));
  for (const Vec3& at : places) {
    if (balls)
      draft.scene.balls.push_back(
          {at, radius, kNoMaterial, radianceOf(random, random.logRange(1, spread), 12.6 * radius * radius)});
    else
      addOctahedron(meshes[size_t(random.integer(0, groups - 1))], at, radius);
  }
  for (MeshData& mesh : meshes)
    if (!mesh.triangles.empty())
      draft.add(std::move(mesh), kNoMaterial, radianceOf(random, random.logRange(1, spread), 1));
  // Columns and walls that hide them from each other.
  const Box box = hall.box();
  for (int i = random.integer(0, 14); i > 0; --i) {
    const Vec3 at(float(random.range(box.min.x + 0.6, box.max.x - 0.6)),
                  float(random.range(box.min.y + 0.6, box.max.y - 0.6)), 0);
    if (random.chance(0.6)) {
      const auto r = float(random.range(0.12, 0.4));
      if (!hall.claim(at, Vec2(r), 0.3f)) continue;
      MeshData column;
      addCylinder(column, at, r, hall.height, 28);
      draft.add(std::move(column), draft.materials.wall());
    } else {
      const bool turned = random.chance(0.5);
      const auto half = float(random.range(0.5, 2));
      const Vec2 size = turned ? Vec2(0.06f, half) : Vec2(half, 0.06f);
      if (!hall.claim(at, size, 0.3f)) continue;
      draft.addBox({at.x - size.x, at.y - size.y, 0},
                   {at.x + size.x, at.y + size.y, hall.height * float(random.range(0.3, 0.9))},
                   draft.materials.wall());
    }
  }
  furnish(draft, hall, anyTheme(random), random.range(0.2, 0.9));
}

}  // namespace odis::learn
