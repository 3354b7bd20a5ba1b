// Cells of media: apart from those of surfaces, without cosines, by formulas.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "odis/cells/statistics.h"
#include "odis/floor_under_patch.h"
#include "odis/guide.h"
#include "odis/guided_vertex.h"
#include "odis/models/model.h"
#include "odis/same_guide.h"

namespace odis::core {
namespace {

// A cube of fog of an isotropic phase function, lit from all sides alike or, with a direction, by a patch.
std::vector<PathVertex> fog(int count, uint32_t seed, const Float3* bright = nullptr) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<PathVertex> vertices(count);
  for (int i = 0; i < count; ++i) {
    PathVertex& v = vertices[size_t(i)];
    v.position = {uniform(engine), uniform(engine), uniform(engine)};
    v.wo = {0, 0, 1};
    const float z = 2 * uniform(engine) - 1, phi = 2 * kPi * uniform(engine), r = std::sqrt(1 - z * z);
    v.wi = {r * std::cos(phi), r * std::sin(phi), z};
    v.pdf = v.guidablePdf = 1 / (4 * kPi);
    v.guidableProbability = 1;
    const float radiance = !bright ? 2.0f : dot(v.wi, *bright) > 0.97f ? 100.0f : 0.1f;
    v.radiance = {radiance, radiance, radiance};
    v.weight = {0.9f, 0.9f, 0.9f};
    v.indirect = 0.9f * radiance;
    v.emission = v.light = 0;
    v.raysAfter = 3;
    v.depth = 1;
    v.pixel = uint32_t(i);
  }
  return vertices;
}

GuideOptions ofFormulas() {
  GuideOptions options;
  options.model = Model();
  return options;
}

uint32_t mediumCellAt(const GuideView& view, const Float3& position) {
  return findCell(view, {position, {}});
}

TEST(CellsOfMedia, HaveKeysOfTheirOwnAtEveryLevel) {
  const CellGrid grid({0.3f, -0.2f, 1}, 0.125f, 64);
  std::mt19937 engine(5);
  std::normal_distribution<float> normal(0, 3);
  for (int i = 0; i < 2000; ++i) {
    const Float3 position = {normal(engine), normal(engine), normal(engine)};
    uint64_t key = grid.key(position, {0, -0.0f, 0}, 0);
    for (int level = 0; level < kCellLevels; ++level) {
      ASSERT_TRUE(CellGrid::isOfMedium(key));
      ASSERT_EQ(key, grid.key(position, {}, level));
      ASSERT_TRUE(CellGrid::isOfMedium(CellGrid::neighbour(key, 1, -1, 0)));
      for (const Float3& axis : {Float3{1, 0, 0}, Float3{-1, 0, 0}, Float3{0, 1, 0}, Float3{0, -1, 0},
                                 Float3{0, 0, 1}, Float3{0, 0, -1}}) {
        const uint64_t ofSurface = grid.key(position, axis, level);
        ASSERT_NE(ofSurface, key);
        ASSERT_FALSE(CellGrid::isOfMedium(ofSurface));
      }
      key = CellGrid::parent(key);
    }
  }
}

TEST(CellsOfMedia, LearnNothingFromSurfacesAtTheSamePlace) {
  const Float3 down{0, 0, -1};
  const std::vector<PathVertex> alone = fog(4000, 1, &down);
  std::vector<PathVertex> both = alone;
  for (const PathVertex& v : floorUnderPatch(kBright, 4000, 2)) both.push_back(v);
  // In the same box, so that the grids are equal.
  GuideBuilder builder(ofFormulas()), beside(ofFormulas());
  builder.setBounds({0, 0, 0}, {1, 1, 1});
  beside.setBounds({0, 0, 0}, {1, 1, 1});
  builder.add(alone);
  beside.add(both);
  EXPECT_EQ(builder.vertexCounts().inMedia, 4000u);
  EXPECT_EQ(beside.vertexCounts().inMedia, 4000u);
  EXPECT_EQ(beside.vertexCounts().accepted, 8000u);
  const Guide guide = builder.build({}), other = beside.build({});
  const GuideView a = guide.view(), b = other.view();
  int compared = 0;
  for (uint32_t cell = 0; cell < a.cellCount; ++cell) {
    ASSERT_TRUE(CellGrid::isOfMedium(a.keys[cell]));
    const uint32_t same = findSlot(b.slots, b.slotMask, a.keys[cell]);
    ASSERT_NE(same, kNoCell);
    EXPECT_TRUE(std::equal(a.maps + size_t(cell) * kMapShares, a.maps + size_t(cell + 1) * kMapShares,
                           b.maps + size_t(same) * kMapShares));
    EXPECT_EQ(a.decisions[cell].outgoingRadiance.x, b.decisions[same].outgoingRadiance.x);
    ++compared;
  }
  EXPECT_GT(compared, 8);
  // Light from below guides fog, not the floor.
  const Place inFog{{0.5f, 0.5f, 0.02f}, {}}, onFloor{{0.5f, 0.5f, 0.02f}, {0, 0, 1}};
  const SamplingMap<float> ofFog(b.maps, int32_t(findCell(b, inFog))),
      ofFloor(b.maps, int32_t(findCell(b, onFloor)));
  EXPECT_GT(ofFog.pdf(down), 0.3f);
  EXPECT_LT(ofFloor.pdf(down), 0.05f);
}

// What arrives alike from everywhere makes an even map, with the network's guide as well.
TEST(CellsOfMedia, MapsHaveNoCosine) {
  for (const bool network : {false, true}) {
    GuideOptions options = ofFormulas();
    if (network) options.model = Model::builtIn();
    GuideBuilder builder(options);
    builder.add(fog(200000, 3));
    const Guide guide = builder.build({});
    const GuideView view = guide.view();
    ASSERT_GT(view.cellCount, 0u);
    const uint32_t coarsest =
        uint32_t(std::find_if(view.keys, view.keys + view.cellCount,
                              [](uint64_t key) { return CellGrid::levelOf(key) == kCellLevels - 1; }) -
                 view.keys);
    ASSERT_LT(coarsest, view.cellCount);
    const SamplingMap<float> map(view.maps, int32_t(coarsest));
    const float even = 1 / (4 * std::numbers::pi_v<float>);
    double up = 0, down = 0;
    for (int t = 0; t < kMapTexels; ++t) {
      EXPECT_NEAR(map.texelPdf(t) / even, 1, 0.5);  // what few samples leave
      const float z = texelDirection(t).z;
      up += (z > 1e-4f) * map.texelPdf(t) / even / kMapTexels;
      down += (z < -1e-4f) * map.texelPdf(t) / even / kMapTexels;
    }
    EXPECT_NEAR(up, down, 0.02);
  }
}

TEST(CellsOfMedia, FollowFormulasWhereNetworksDecideOnSurfaces) {
  const Float3 bright{0.6f, 0, 0.8f};
  std::vector<PathVertex> vertices = fog(3000, 4, &bright);
  for (const PathVertex& v : floorUnderPatch(kBright, 3000, 5)) vertices.push_back(v);
  for (size_t i = 0; i < vertices.size(); ++i) {
    vertices[i].direct = {1, 1, 1};
    vertices[i].lightGroup = i % 3 == 0;
    vertices[i].lightGroupProbability = 0.5f;
  }
  GuideOptions byFormulas = ofFormulas(), byNetworks;
  byFormulas.lightGroups = byNetworks.lightGroups = 2;
  byNetworks.model = Model::builtIn();
  GuideBuilder formulas(byFormulas), networks(byNetworks);
  formulas.add(vertices);
  networks.add(vertices);
  const Guide a = formulas.build({}), b = networks.build({});
  const GuideView formula = a.view(), network = b.view();
  ASSERT_EQ(formula.cellCount, network.cellCount);
  size_t media = 0, different = 0;
  for (uint32_t cell = 0; cell < formula.cellCount; ++cell) {
    ASSERT_EQ(formula.keys[cell], network.keys[cell]);
    const size_t begin = size_t(cell) * kMapShares, end = begin + kMapShares;
    const bool same =
        std::equal(formula.maps + begin, formula.maps + end, network.maps + begin) &&
        std::equal(formula.lightTables + 3 * cell, formula.lightTables + 3 * cell + 3,
                   network.lightTables + 3 * cell) &&
        formula.decisions[cell].learnedLightFraction == network.decisions[cell].learnedLightFraction;
    if (CellGrid::isOfMedium(formula.keys[cell])) {
      EXPECT_TRUE(same);
      ++media;
    } else {
      different += !same;
    }
  }
  EXPECT_GT(media, 8u);
  EXPECT_GT(different, 8u);
}

TEST(CellsOfMedia, StayWhenTheyAreCarriedOverAndSaved) {
  const Float3 bright{0.6f, 0, 0.8f};
  CellStore store(20);
  const std::vector<PathVertex> vertices = fog(3000, 6, &bright);
  const std::vector<ArrayView<const PathVertex>> parts{vertices};
  store.add(parts, 8);
  const auto all = [&store] {
    for (const CellStatistics& cell : store.rollUp())
      if (!cell.inMedium) return false;
    const std::vector<uint64_t> keys = store.keys();
    return !keys.empty() && std::all_of(keys.begin(), keys.end(), CellGrid::isOfMedium);
  };
  EXPECT_TRUE(all());
  store.fade(0.3);
  EXPECT_TRUE(all());
  store.move(CellGrid({-1, -2, -3}, 0.21f));
  EXPECT_TRUE(all());
  CellStore copy(store);
  store.add(copy, 0.5);
  EXPECT_TRUE(all());
}

// Maps at pixels are for first vertices on surfaces; a host may ask for a pixel's without telling a place.
TEST(CellsOfMedia, MapsAtPixelsAreForSurfaces) {
  const uint32_t cells[] = {kNoCell, 7};
  GuideView view;
  view.cellCount = 8;
  view.pixels = {cells, 2};
  Place place{{0, 0, 0}, {0, 0, 1}, 1, 0, true};
  EXPECT_EQ(findCell(view, place), 7u);
  uint32_t found = 0;
  findCells(view, &place, 1, &found);
  EXPECT_EQ(found, 7u);
  place.normal = {};
  EXPECT_EQ(pixelCell(view, place), 7u);
  EXPECT_EQ(findCell(view, place), kNoCell);
  findCells(view, &place, 1, &found);
  EXPECT_EQ(found, kNoCell);
}

TEST(CellsOfMedia, GuideAVertexWithoutANormal) {
  const Float3 bright{0, 0.6f, -0.8f};
  GuideBuilder builder(ofFormulas());
  builder.add(fog(20000, 7, &bright));
  const Guide guide = builder.build({});
  const GuideView view = guide.view();
  ASSERT_NE(mediumCellAt(view, {0.5f, 0.5f, 0.5f}), kNoCell);
  GuidedVertex vertex(view, {{0.5f, 0.5f, 0.5f}, {}}, 1);
  ASSERT_TRUE(vertex.isKnown());
  vertex.prepare(1);
  ASSERT_TRUE(vertex.guides());
  const float phase = 1 / (4 * kPi);
  EXPECT_GT(vertex.pdf(bright, phase, phase), 5 * phase);
  EXPECT_LT(vertex.pdf(bright * -1.0f, phase, phase), phase);
  EXPECT_GT(vertex.pdf(bright * -1.0f, phase, phase), 0);
  EXPECT_FALSE(GuidedVertex(view, {{0.5f, 0.5f, 0.5f}, {0, 0, 1}}, 1).isKnown()) << "no surface was seen";
}

}  // namespace
}  // namespace odis::core
