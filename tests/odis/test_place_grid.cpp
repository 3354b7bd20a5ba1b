// Where the grid lies does not depend on vertices far out, up to 30 % of all and at any distance.
#include <gtest/gtest.h>
#include "odis/cells/place_grid.h"

#include <cfloat>
#include <functional>
#include <random>
#include <set>

#include "odis/cells/statistics.h"
#include "odis/floor_under_patch.h"
#include "odis/guide.h"

namespace odis::core {
namespace {

constexpr int kCells = 32;
constexpr float kDiagonal = 7;  // of the room, about

struct Draw {
  std::mt19937 engine{1};
  float uniform(float low = 0, float high = 1) {
    return std::uniform_real_distribution<float>(low, high)(engine);
  }
  float normal() { return std::normal_distribution<float>()(engine); }
  Float3 direction() {
    const Float3 w{normal(), normal(), normal()};
    return w * (1 / std::sqrt(dot(w, w)));
  }
  // Up to a million, all magnitudes alike.
  float distance() { return kDiagonal * std::pow(10.0f, uniform(1, 6)); }
};

// The walls of a room of 4 x 3 x 5, half of the vertices on and around a table.
std::vector<Float3> room(Draw& draw, size_t count) {
  std::vector<Float3> positions;
  while (positions.size() < count) {
    if (positions.size() % 2 == 0) {
      positions.push_back(
          {1 + 0.5f * draw.normal(), std::abs(draw.normal()) * 0.4f, 2 + 0.5f * draw.normal()});
      continue;
    }
    float p[3] = {draw.uniform(), draw.uniform(), draw.uniform()};
    p[draw.engine() % 3] = float(draw.engine() % 2);
    positions.push_back({4 * p[0], 3 * p[1], 5 * p[2]});
  }
  return positions;
}

using FarOut = std::function<Float3(Draw&)>;
const std::pair<const char*, FarOut> kFarOut[] = {
    {"at one place",
     [](Draw&) {
       return Float3{1e6f, 0, 0};
     }},
    {"a tree",
     [](Draw& draw) {
       return Float3{60, 2, 30} + Float3{draw.normal(), draw.normal(), draw.normal()};
     }},
    {"a far tree",
     [](Draw& draw) {
       return Float3{6e4f, 2, 3e4f} + draw.direction() * (2000 * draw.uniform());
     }},
    {"a sky", [](Draw& draw) { return draw.direction() * 1e4f; }},
    {"a vast sky", [](Draw& draw) { return draw.direction() * 1e7f; }},
    {"beyond floats' squares", [](Draw& draw) { return draw.direction() * 1e30f; }},
    {"a ground of even density",
     [](Draw& draw) {
       return Float3{draw.uniform(-1e5f, 1e5f), 0, draw.uniform(-1e5f, 1e5f)};
     }},
    {"a ground to the horizon",
     [](Draw& draw) {
       const float angle = draw.uniform(0, 6.2831853f), distance = draw.distance();
       return Float3{distance * std::cos(angle), 0, distance * std::sin(angle)};
     }},
    {"clusters of different scales", [](Draw& draw) {
       const float k = float(1 + draw.engine() % 4), distance = 10 * std::pow(12.0f, k);
       return Float3{distance * std::cos(k), distance * std::sin(k), 0} +
              draw.direction() * (0.1f * distance * draw.uniform());
     }}};

// The first `far` of the positions, in some order, lie far out.
std::vector<Float3> withFar(Draw& draw, std::vector<Float3> positions, double share, const FarOut& farOut) {
  const auto more = size_t(share / (1 - share) * double(positions.size()));
  for (size_t i = 0; i < more; ++i) positions.push_back(farOut(draw));
  std::shuffle(positions.begin(), positions.end(), draw.engine);
  return positions;
}

TEST(PlaceGrid, EdgesDoNotDependOnVerticesFarOut) {
  for (const size_t count : {150, 2000, 20000}) {
    Draw draw;
    const std::vector<Float3> positions = room(draw, count);
    const CellGrid without = gridFor(positions, kCells);
    EXPECT_NEAR(without.finestEdge() * kCells, kDiagonal, 0.1 * kDiagonal);
    for (const auto& [what, farOut] : kFarOut)
      for (const double share : {0.001, 0.004, 0.006, 0.01, 0.05, 0.1, 0.2, 0.3}) {
        const CellGrid with = gridFor(withFar(draw, positions, share, farOut), kCells);
        EXPECT_NEAR(with.finestEdge() / without.finestEdge(), 1, 0.1)
            << count << ", " << share << ": " << what;
      }
  }
}

// A plane begins where the room does: a half or three fourths of its vertices lie within twice the room's
// size.
TEST(PlaceGrid, EdgesDoNotDependOnPlanesThatBeginNear) {
  Draw draw;
  const std::vector<Float3> positions = room(draw, 20000);
  const float without = gridFor(positions, kCells).finestEdge();
  const auto plane = [](float density, float near) {
    return [=](Draw& d) {  // of a density that falls with this power of the distance
      const float angle = d.uniform(0, 6.2831853f);
      const float distance = near * std::pow(d.uniform(1e-5f, 1), -1 / (density - 2));
      return Float3{2 + distance * std::cos(angle), 0, 2.5f + distance * std::sin(angle)};
    };
  };
  for (const float near : {1.2f, 2.5f})
    for (const float density : {3.0f, 4.0f})
      for (const double share : {0.001, 0.01, 0.1, 0.2, 0.3}) {
        const FarOut farOut = plane(density, near);
        const float with = gridFor(withFar(draw, positions, share, farOut), kCells).finestEdge();
        EXPECT_NEAR(with / without, 1, density > 3 ? 0.25 : 0.1)
            << share << ", " << density << ", from " << near;
      }
}

// Where most vertices are those of a sky, the room is still what most of the light is learned for.
TEST(PlaceGrid, AnAbsurdlyFarSkyMayHaveMostVertices) {
  Draw draw;
  const std::vector<Float3> positions = room(draw, 10000);
  const FarOut sky = [](Draw& d) { return d.direction() * 1e5f; };
  const CellGrid with = gridFor(withFar(draw, positions, 0.55, sky), kCells);
  EXPECT_NEAR(with.finestEdge() / gridFor(positions, kCells).finestEdge(), 1, 0.1);
}

// The box of all but 0.5 % at either end of each axis, where no vertices lie far out: the networks know cells
// of that size.
TEST(PlaceGrid, IsTheBoxOfWhatWasSeenElsewhere) {
  const std::function<Float3(Draw&)> scenes[] = {
      [](Draw& draw) {
        return Float3{draw.uniform(), draw.uniform(), 0};
      },
      [](Draw& draw) {
        return Float3{20 * draw.uniform(), draw.uniform(), draw.uniform()};
      },
      [](Draw& draw) {
        return Float3{draw.normal(), draw.normal(), draw.normal()};
      },
      [](Draw& draw) {  // a long room, seen from near one end
        return Float3{(draw.engine() % 3 ? 1 : 4) * draw.uniform(), draw.uniform(), draw.uniform()};
      },
      [](Draw& draw) { return draw.direction() * 3.0f; },
      [](Draw& draw) { return draw.direction() * (draw.engine() % 2 ? 1.0f : 8.0f); }};
  for (const auto& scene : scenes) {
    Draw draw;
    std::vector<Float3> positions(20000);
    for (Float3& p : positions) p = scene(draw);
    std::vector<float> axes[3];
    for (const Float3& p : positions) {
      axes[0].push_back(p.x);
      axes[1].push_back(p.y);
      axes[2].push_back(p.z);
    }
    Float3 low, extent;
    for (const auto& [axis, member] : {std::pair{0, &Float3::x}, {1, &Float3::y}, {2, &Float3::z}}) {
      std::sort(axes[axis].begin(), axes[axis].end());
      low.*member = axes[axis][100];
      extent.*member = axes[axis][20000 - 101] - axes[axis][100];
    }
    EXPECT_EQ(gridFor(positions, kCells), gridAround(low, extent, kCells));
    std::shuffle(positions.begin(), positions.end(), draw.engine);
    EXPECT_EQ(gridFor(positions, kCells), gridAround(low, extent, kCells)) << "in another order";
  }
}

// A floor of 16 x 16 pixels and the wall beside it.
TEST(PlaceGrid, AWallBesideAVerySmallPictureIsNotFarOut) {
  Draw draw;
  std::vector<Float3> positions;
  for (int i = 0; i < 256; ++i)
    positions.push_back({draw.uniform(-0.14f, 0.14f), 0, draw.uniform(-0.14f, 0.14f)});
  for (int i = 0; i < 25; ++i) positions.push_back({1, draw.uniform(0.2f, 1), draw.uniform(-0.6f, 0.6f)});
  EXPECT_NEAR(gridFor(positions, kCells).finestEdge() * kCells, std::sqrt(1.14 * 1.14 + 1 + 1.2 * 1.2), 0.2);
}

TEST(PlaceGrid, DegenerateVerticesHaveAGridToo) {
  const auto isSound = [](const CellGrid& grid) {
    return std::isfinite(grid.finestEdge()) && grid.finestEdge() > 0 && grid.flat().inverseEdge > 0 &&
           std::isfinite(grid.flat().inverseEdge) && std::isfinite(grid.origin().x);
  };
  EXPECT_TRUE(isSound(gridFor({}, kCells)));
  for (const size_t count : {1, 2, 3, 5, 1000}) {
    for (const float scale : {0.0f, 1e-38f, 1e-25f, 1.0f, 1e25f, FLT_MAX}) {
      Draw draw;
      std::vector<Float3> positions(count);
      for (Float3& p : positions) p = Float3{draw.uniform(-1), draw.uniform(-1), draw.uniform(-1)} * scale;
      EXPECT_TRUE(isSound(gridFor(positions, kCells))) << count << " in " << scale;
    }
    std::vector<Float3> line(count);
    for (size_t i = 0; i < count; ++i) line[i] = {float(i % 100 < 60 ? 0 : i), 0, 0};  // most at one place
    EXPECT_TRUE(isSound(gridFor(line, kCells))) << count;
  }
}

// Keys of rings: nested as within reach, no two places that lie apart in one cell, and few cells far out.
TEST(PlaceGrid, CellsFarOutGrowWithTheirDistance) {
  const CellGrid grid = gridAround({0, 0, 0}, {4, 3, 5}, kCells);
  Draw draw;
  for (int i = 0; i < 20000; ++i) {
    const float distance = std::pow(10.0f, draw.uniform(-1, 30));
    const bool inMedium = i % 3 == 0;  // whose cells have twice the edge
    const Float3 p = draw.direction() * distance, normal = inMedium ? Float3{} : draw.direction();
    uint64_t key = grid.key(p, normal, 0);
    for (int level = 0; level < kCellLevels; ++level, key = CellGrid::parent(key)) {
      ASSERT_EQ(key, grid.key(p, normal, level)) << distance;
      const float edge = grid.edge(key);
      EXPECT_EQ(CellGrid::isOfMedium(key), inMedium);
      const Float3 off = p - grid.middle(key);
      for (const float along : {off.x, off.y, off.z}) ASSERT_LE(std::abs(along), 0.501f * edge) << distance;
      if (distance < 3) {
        EXPECT_EQ(edge, grid.finestEdge() * float((inMedium ? 2 : 1) << level));
      } else if (distance > 100 && level == 0) {
        EXPECT_GT(edge, 0.05f * distance);
        EXPECT_LT(edge, (inMedium ? 1 : 0.5f) * distance);
      }
    }
  }
  std::set<uint64_t> sky;
  for (int i = 0; i < 20000; ++i) sky.insert(grid.key(draw.direction() * 1e6f, {0, 0, 1}, 0));
  EXPECT_LT(sky.size(), 1600u);
  for (const float x : {-INFINITY, INFINITY, NAN, -FLT_MAX, FLT_MAX})
    for (const float y : {-INFINITY, INFINITY, NAN, 0.0f}) {
      const uint64_t key = grid.key({x, y, 0}, {NAN, 0, 1}, 0);
      EXPECT_EQ(CellGrid::levelOf(key), 0);
      EXPECT_TRUE(std::isfinite(grid.edge(key)));
    }
}

// Guides: what the floor knows of its light is the same with vertices elsewhere, and those have cells, too.
TEST(PlaceGrid, GuidesKnowTheFloorAndWhatLiesFarOut) {
  const std::vector<PathVertex> floor = floorUnderPatch(kBright, 20000, 1);
  std::vector<PathVertex> all = floor;
  Draw draw;
  for (PathVertex v : floorUnderPatch({-0.6f, 0, 0.8f}, 8000, 2)) {
    v.position = v.position * 1e5f + Float3{1e6f, 3e5f, 0};
    all.push_back(v);
  }
  std::shuffle(all.begin(), all.end(), draw.engine);
  GuideOptions options;
  options.model = Model();
  const auto build = [&](ArrayView<const PathVertex> vertices) {
    GuideBuilder builder(options);
    builder.add(vertices);
    return builder.build();
  };
  const Guide without = build(floor), with = build(all);
  const auto densityAt = [](const Guide& guide, const Float3& position, const Float3& wi) {
    const uint32_t cell = findCell(guide.view(), {position, {0, 0, 1}});
    if (cell == kNoCell) return 0.0f;
    return SamplingMap<float>(guide.view().maps, int32_t(cell)).pdf(wi);
  };
  EXPECT_NEAR(with.view().grid.inverseEdge / without.view().grid.inverseEdge, 1, 0.01);
  for (const float x : {0.2f, 0.5f, 0.8f})
    EXPECT_NEAR(densityAt(with, {x, 0.4f, 0}, kBright) / densityAt(without, {x, 0.4f, 0}, kBright), 1, 0.25);
  EXPECT_GT(densityAt(with, {1.05e6f, 3.5e5f, 0}, {-0.6f, 0, 0.8f}), 5 * 0.8f / kPi);
}

// Cells that paths seldom come to are not worth a map of their own.
TEST(PlaceGrid, FewVerticesFarOutHaveTheMapsOfCoarserCells) {
  std::vector<PathVertex> vertices = floorUnderPatch(kBright, 20000, 1);
  Draw draw;
  const auto addFar = [&](int count, const Float3& to) {
    for (PathVertex v : floorUnderPatch({-0.6f, 0, 0.8f}, count, 2)) {
      v.position = v.position * 10.0f + to;
      vertices.push_back(v);
    }
  };
  for (int i = 0; i < 50; ++i) addFar(4, {1e5f, 6e4f * float(i), 0});
  addFar(2000, {-1e5f, 3e4f, 0});
  GuideOptions options;
  options.model = Model();
  options.alwaysMaps = true;
  GuideBuilder builder(options);
  builder.add(vertices);
  const Guide guide = builder.build();
  const GuideView view = guide.view();
  const auto hasParentsMap = [&](const Float3& position) {
    const uint64_t key = CellGrid(view.grid).key(position, {0, 0, 1}, 0);
    const uint32_t cell = findSlot(view.slots, view.slotMask, key),
                   parent = findSlot(view.slots, view.slotMask, CellGrid::parent(key));
    EXPECT_NE(cell, kNoCell);
    const uint16_t* maps = view.maps;
    return std::equal(maps + cell * kMapShares, maps + (cell + 1) * kMapShares, maps + parent * kMapShares);
  };
  EXPECT_TRUE(hasParentsMap(vertices[20000].position));
  EXPECT_FALSE(hasParentsMap(vertices[20200].position));
  EXPECT_FALSE(hasParentsMap({0.51f, 0.51f, 0}));
  GuideBuilder ofFloor(options);
  ofFloor.add(ArrayView<const PathVertex>(vertices.data(), 20000));
  EXPECT_NEAR(builder.visitedCells() / ofFloor.visitedCells(), 1, 0.04);
  EXPECT_GT(view.cellCount, 1.03 * builder.visitedCells());
}

}  // namespace
}  // namespace odis::core
