// What lies around a cell, re-aimed at its middle.
#include "odis/cells/surroundings.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace odis::core {
namespace {

constexpr float kFar = 1e9f;  // limits nothing

// A vertex of a diffuse surface that faces up, and sees radiance 1 from a point (or, with a distance of
// infinity, from a direction).
PathVertex vertexAt(const Float3& position, const Float3& wi, float distance) {
  PathVertex v;
  v.position = position;
  v.normal = {0, 0, 1};
  v.wi = wi;
  v.distance = distance;
  v.pdf = 1;
  v.survival = 1;
  v.cosine = 1;
  v.radiance = {1, 1, 1};
  v.depth = 1;
  return v;
}
PathVertex seeing(const Float3& position, const Float3& point) {
  const Float3 to = point - position;
  const float distance = std::sqrt(dot(to, to));
  return vertexAt(position, to * (1 / distance), distance);
}

// Vertices all over a floor of 6 x 6, each of which sees some point of a line above it.
std::vector<PathVertex> floorBelowALine(unsigned seed) {
  std::vector<PathVertex> vertices;
  std::mt19937 engine(seed);
  std::uniform_real_distribution<float> uniform(0, 6);
  for (int i = 0; i < 3000; ++i)
    vertices.push_back(seeing({uniform(engine), uniform(engine), 0.5f}, {uniform(engine), 2, 3}));
  return vertices;
}

struct Cells {
  explicit Cells(const std::vector<PathVertex>& vertices, float edge = 1) : store(kFar, true) {
    store.place(CellGrid({0, 0, 0}, edge));
    const ArrayView<const PathVertex> part(vertices);
    store.add(VertexParts(&part, 1), 0);
    store.rollUp();
    cells = store.lookAround();
  }
  const CellStatistics& at(const Float3& position, int level = 0) const {
    return cells[store.index().find(store.grid().key(position, {0, 0, 1}, level))];
  }
  CellStore store;
  std::vector<CellStatistics> cells;
};

float sumAround(const Histogram& map) {
  return std::accumulate(map.begin(), map.end(), 0.0f);
}

// The mean direction of a histogram.
Float3 meanOf(const Histogram& map) {
  Float3 sum{0, 0, 0};
  for (int t = 0; t < kMapTexels; ++t) sum = sum + texelDirection(t) * map[size_t(t)];
  return sum * (1 / std::sqrt(dot(sum, sum)));
}

TEST(Surroundings, NeighboursTellWhereALampIs) {
  // A lamp two and a half cells above a floor; the cell asked has seen nothing of it, its neighbours have.
  const Float3 lamp{4.5f, 4.5f, 3};
  std::vector<PathVertex> vertices;
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> uniform(0, 9);
  for (int i = 0; i < 4000; ++i) {
    const Float3 p{uniform(engine), uniform(engine), 0.5f};
    const bool inside = p.x >= 6 && p.x < 7 && p.y >= 4 && p.y < 5;
    vertices.push_back(inside ? vertexAt(p, {0, 1, 0}, INFINITY) : seeing(p, lamp));
    if (inside) vertices.back().radiance = {0, 0, 0};
  }
  const Cells cells(vertices);
  const CellStatistics& dark = cells.at({6.5f, 4.5f, 0.5f});
  ASSERT_EQ(dark.sum, 0);
  const Float3 to = lamp - dark.centroid, towards = to * (1 / std::sqrt(dot(to, to)));
  for (const Histogram& map : *dark.around) {
    // Most of it, to the width of a texel or two; where neighbours saw it in another direction by up to
    // ninety degrees.
    EXPECT_GT(dot(meanOf(map), towards), 0.97f);
    float near = 0;
    for (int t = 0; t < kMapTexels; ++t)
      if (dot(texelDirection(t), towards) > 0.85f) near += map[size_t(t)];
    EXPECT_GT(near / sumAround(map), 0.8f);
  }
  // The histogram of the grandparent, which is not re-aimed at this cell, does not know.
  const CellStatistics& grandparent = cells.at({6.5f, 4.5f, 0.5f}, 2);
  float near = 0;
  for (int t = 0; t < kMapTexels; ++t)
    if (dot(texelDirection(t), towards) > 0.85f) near += grandparent.histogram[size_t(t)];
  EXPECT_LT(near / sumAround(grandparent.histogram), 0.6f);
}

TEST(Surroundings, HoldAllThatTheCellsAroundHaveSeen) {
  std::vector<PathVertex> vertices;
  std::mt19937 engine(2);
  std::uniform_real_distribution<float> uniform(0, 16);
  for (int i = 0; i < 2000; ++i)
    vertices.push_back(seeing({uniform(engine), uniform(engine), 0.5f}, {3, 14, 5}));
  // The other side of the floor, and what is not usable, is no part of it.
  for (int i = 0; i < 500; ++i) {
    vertices.push_back(seeing({uniform(engine), uniform(engine), 0.5f}, {3, 14, -5}));
    vertices.back().normal = {0, 0, -1};
    vertices.push_back(vertexAt({uniform(engine), uniform(engine), 0.5f}, {0, 0, 1}, INFINITY));
    vertices.back().radiance = {NAN, 1, 1};
  }
  const Cells cells(vertices);
  for (const CellStatistics& cell : cells.cells) {
    if (cell.normal.z < 0 || !cell.hasMap) continue;
    for (int above = 0; above < 2; ++above) {
      const int level = cell.level + 1 + above;
      double sum = 0;
      if (level < kCellLevels) {
        const auto block = [&](float x) { return int(std::floor(x)) >> level; };
        for (const PathVertex& v : vertices)
          if (v.normal.z > 0 && std::isfinite(v.radiance.x) &&
              std::abs(block(v.position.x) - block(cell.centroid.x)) <= 1 &&
              std::abs(block(v.position.y) - block(cell.centroid.y)) <= 1)
            sum += double(sampleValue(v));
      }
      EXPECT_NEAR(sumAround((*cell.around)[size_t(above)]), sum, 1e-3 * sum + 1e-6);
    }
  }
}

TEST(Surroundings, WhatIsInfinitelyFarStaysWhereItIs) {
  std::vector<PathVertex> vertices;
  const Float3 sun{0.6f, 0, 0.8f};
  for (int x = 0; x < 8; ++x)
    for (int y = 0; y < 8; ++y)
      vertices.push_back(vertexAt({float(x) + 0.3f, float(y) + 0.6f, 0.5f}, sun, INFINITY));
  const Cells cells(vertices);
  for (const CellStatistics& cell : cells.cells)
    for (const Histogram& map : *cell.around) EXPECT_EQ(map[size_t(texelOf(sun))], sumAround(map));
}

TEST(Surroundings, NothingIsAroundWhereAllIsDark) {
  // The last cell to be asked has no light, and lies beside one that saw light next to itself, at no distance
  // at all.
  constexpr int kEnough = 16;  // for a map of its own
  std::vector<PathVertex> vertices(kEnough, vertexAt({0.5f, 0.5f, 0.5f}, {0, 0, 1}, 1e-30f));
  vertices.resize(2 * kEnough, vertexAt({200.5f, 0.5f, 0.5f}, {0, 0, 1}, 1));
  for (int i = kEnough; i < 2 * kEnough; ++i) vertices[size_t(i)].radiance = {0, 0, 0};
  const Cells cells(vertices);
  for (const Histogram& map : *cells.at({200.5f, 0.5f, 0.5f}).around) EXPECT_EQ(sumAround(map), 0);
  for (const Histogram& map : *cells.at({0.5f, 0.5f, 0.5f}).around) EXPECT_EQ(sumAround(map), kEnough);
  vertices.erase(vertices.begin(), vertices.begin() + kEnough);
  const Cells dark(vertices);
  for (const CellStatistics& cell : dark.cells)
    for (const Histogram& map : *cell.around) EXPECT_EQ(sumAround(map), 0);
}

TEST(Surroundings, DoNotDependOnHowSamplesCame) {
  const std::vector<PathVertex> vertices = floorBelowALine(3);
  const Cells whole(vertices);
  // In two parts, at once.
  CellStore store(kFar, true);
  store.place(CellGrid({0, 0, 0}, 1));
  const ArrayView<const PathVertex> all(vertices);
  const std::vector<ArrayView<const PathVertex>> parts = {all.subview(0, 1000),
                                                          all.subview(1000, all.size() - 1000)};
  store.add(parts, 0);
  store.rollUp();
  const std::vector<CellStatistics>& cells = store.lookAround();
  ASSERT_EQ(cells.size(), whole.cells.size());
  for (size_t c = 0; c < cells.size(); ++c) EXPECT_EQ(*cells[c].around, *whole.cells[c].around) << c;
}

TEST(Surroundings, WhatIsRolledUpIsNoPartOfWhatIsAddedLater) {
  const std::vector<PathVertex> vertices = floorBelowALine(4);
  const ArrayView<const PathVertex> all(vertices),
      parts[] = {all.subview(0, 500), all.subview(500, all.size() - 500)};
  CellStore stores[] = {CellStore(kFar, true), CellStore(kFar, true)};
  for (CellStore& store : stores) {
    store.place(CellGrid({0, 0, 0}, 1));
    for (const auto& part : parts) {
      store.add(VertexParts(&part, 1), 0);
      store.rollUp();
      if (&store == &stores[0]) store.lookAround();
    }
  }
  const std::vector<CellStatistics>&cells = stores[0].lookAround(), &once = stores[1].lookAround();
  ASSERT_EQ(cells.size(), once.size());
  for (size_t c = 0; c < cells.size(); ++c) {
    EXPECT_EQ(cells[c].count, once[c].count) << c;
    EXPECT_EQ(cells[c].centroid.x, once[c].centroid.x) << c;
    EXPECT_EQ(cells[c].histogram, once[c].histogram) << c;
    EXPECT_EQ(*cells[c].around, *once[c].around) << c;
  }
  // All samples are in the coarsest level.
  double count = 0;
  for (const CellStatistics& cell : cells)
    if (cell.level == kCellLevels - 1) count += cell.count;
  EXPECT_EQ(count, double(vertices.size()));
}

}  // namespace
}  // namespace odis::core
