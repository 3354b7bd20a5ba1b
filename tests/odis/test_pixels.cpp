// Maps at pixels: what a neighbourhood tells, and guides that hold such maps.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "odis/maps/pack.h"
#include "odis/maps/texel_directions.h"
#include "odis/paper_method.h"
#include "odis/same_guide.h"

namespace odis::core {
namespace {

const Float3 kUp{0, 0, 1};

Float3 normalized(const Float3& v) {
  return v / std::sqrt(dot(v, v));
}

// A floor at z = 0, seen from above: pixel (x, y) is the point (x, y, 0) / 100. Every pixel has drawn a
// direction towards `source`.
FirstVertices floorTowards(int width, int height, const Float3& source) {
  FirstVertices vertices(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      FirstVertex& v = vertices.at(x, y);
      v.there = true;
      v.position = {float(x) / 100, float(y) / 100, 0};
      v.normal = kUp;
      const Float3 to = source - v.position;
      v.distance = std::sqrt(dot(to, to));
      v.wi = to / v.distance;
      v.radiance = 2;
      v.pdf = 1;
      v.albedo = 0.5f;
    }
  return vertices;
}

// The far energy of a texel, which is given by its index in a sampling map.
float farEnergy(const Neighbourhood& seen, int texel) {
  for (int t = 0; t < kMapTexels; ++t)
    if (texelAt(t % kMapSize, t / kMapSize) == texel) return seen.sums[t][kFarEnergy];
  return NAN;
}

size_t brightest(const Histogram& map) {
  return size_t(std::max_element(map.begin(), map.end()) - map.begin());
}

TEST(Neighbourhood, SamplesAreAimedFromThePlace) {
  // So near that neighbours see it in other directions.
  const Float3 source{0.2f, 0.1f, 0.15f};
  const FirstVertices vertices = floorTowards(40, 40, source);
  const PixelPlace place{vertices.at(20, 20).position, kUp, 1, 0.5f, 20, 20, 1};
  Neighbourhood seen;
  look(vertices, place, seen);
  // A splat reaches four texels, from the place as from nowhere else.
  const Splat expected = splat(normalized(source - place.position));
  float inside = 0, all = 0;
  for (const auto& texel : seen.sums) all += texel[kFarEnergy];
  for (const int texel : expected.texel) inside += farEnergy(seen, texel);
  EXPECT_GT(all, 0);
  EXPECT_NEAR(inside, all, 1e-3f * all);
}

TEST(Neighbourhood, OtherSurfacesDoNotCount) {
  FirstVertices vertices = floorTowards(40, 40, {0.9f, 0.5f, 1});
  // The right half is a wall, lit from elsewhere.
  for (int y = 0; y < 40; ++y)
    for (int x = 22; x < 40; ++x) {
      FirstVertex& v = vertices.at(x, y);
      v.normal = {-1, 0, 0};
      v.wi = {-1, 0, 0};
      v.distance = INFINITY;
      v.radiance = 100;
    }
  const PixelPlace place{vertices.at(20, 20).position, kUp, 1, 0.5f, 20, 20, 1};
  Neighbourhood seen;
  look(vertices, place, seen);
  EXPECT_EQ(farEnergy(seen, texelOf(Float3{-1, 0, 0})), 0);
  EXPECT_EQ(brightest(histogramOf(seen)),
            size_t(texelOf(normalized(Float3{0.9f, 0.5f, 1} - place.position))));
}

// A map that knew the samples of its own pixels would depend on the points that their other samples share.
TEST(Neighbourhood, ATilesOwnSamplesAreLeftOut) {
  const FirstVertices vertices = floorTowards(40, 40, {0.9f, 0.5f, 1});
  FirstVertices others = vertices;
  for (int y = 20; y < 22; ++y)
    for (int x = 20; x < 22; ++x) {
      others.at(x, y).radiance = 100;
      others.at(x, y).wi = {-1, 0, 0};
    }
  Neighbourhood seen[2];
  for (int size = 2; size > 0; --size) {
    const PixelPlace place{vertices.at(20, 20).position, kUp, 1, 0.5f, 20, 20, size};
    look(vertices, place, seen[0]);
    look(others, place, seen[1]);
    const bool same = std::memcmp(seen[0].sums, seen[1].sums, sizeof seen[0].sums) == 0 &&
                      std::memcmp(seen[0].scalars, seen[1].scalars, sizeof seen[0].scalars) == 0;
    EXPECT_EQ(same, size == 2) << "a tile of " << size << " x " << size;
  }
}

TEST(Neighbourhood, AnEmptyOneKnowsNothing) {
  const FirstVertices vertices(8, 8);
  Neighbourhood seen;
  look(vertices, {{0, 0, 0}, kUp, 1, 0, 4, 4, 1}, seen);
  for (const float share : histogramOf(seen)) EXPECT_FLOAT_EQ(share, 1.0f / kMapTexels);
  std::vector<float> maps(size_t(kMapTexels) * kPixelChannels), scalars(kPixelScalars);
  describe(seen, kUp, maps, scalars);
  for (const float value : maps) EXPECT_TRUE(std::isfinite(value));
  for (const float value : scalars) EXPECT_TRUE(std::isfinite(value));
}

TEST(Neighbourhood, HistogramsSumToOneWhateverTheSamples) {
  FirstVertices vertices = floorTowards(30, 30, {0.1f, 0.1f, 1});
  vertices.at(15, 15).radiance = 1e30f;  // a firefly
  vertices.at(14, 15).pdf = 1e-20f;
  vertices.at(13, 15).distance = 0;
  Neighbourhood seen;
  look(vertices, {vertices.at(15, 16).position, kUp, 1, 0.5f, 15, 16, 1}, seen);
  double sum = 0;
  for (const float share : histogramOf(seen)) {
    EXPECT_GE(share, 0);
    sum += share;
  }
  EXPECT_NEAR(sum, 1, 1e-4);
}

// Descriptions don't depend on exposure or scale.
TEST(Neighbourhood, HasNoUnits) {
  FirstVertices vertices = floorTowards(30, 30, {0.1f, 0.1f, 1}), scaled = vertices;
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 30; ++x) {
      vertices.at(x, y).radiance = 1 + float((x * 7 + y * 3) % 5);
      scaled.at(x, y) = vertices.at(x, y);
      scaled.at(x, y).radiance *= 1024;
      scaled.at(x, y).position = scaled.at(x, y).position * 16.0f;
      scaled.at(x, y).distance *= 16;
    }
  std::vector<float> maps[2], scalars[2];
  for (int i = 0; i < 2; ++i) {
    const FirstVertices& of = i == 0 ? vertices : scaled;
    Neighbourhood seen;
    look(of, {of.at(15, 15).position, kUp, 1, 0.5f, 15, 15, 1}, seen);
    maps[i].resize(size_t(kMapTexels) * kPixelChannels);
    scalars[i].resize(kPixelScalars);
    describe(seen, kUp, maps[i], scalars[i]);
  }
  for (size_t i = 0; i < maps[0].size(); ++i) EXPECT_NEAR(maps[0][i], maps[1][i], 1e-3f) << i;
  for (size_t i = 0; i < scalars[0].size(); ++i) EXPECT_NEAR(scalars[0][i], scalars[1][i], 1e-3f) << i;
}

TEST(FirstVertices, AreThoseThatMayBeGuided) {
  PathVertex mirror, rough;
  mirror.depth = 1;
  mirror.discrete = true;
  mirror.guidableProbability = 0;
  rough.depth = 2;
  rough.position = {1, 2, 3};
  rough.normal = rough.wi = kUp;
  rough.radiance = {3, 3, 3};
  rough.weight = {0.5f, 0.5f, 0.5f};
  rough.pdf = 0.5f;
  rough.indirect = 1;
  rough.emission = 1;
  rough.emissionLightPdf = 0.5f;  // MIS gives either half
  mirror.pixel = rough.pixel = 1;
  const std::vector<PathVertex> path{mirror, rough};
  FirstVertices full(2, 1), rest(2, 1);
  full.add(path, IncidentRadiance::full);
  rest.add(path, IncidentRadiance::withoutDirect);
  EXPECT_FALSE(full.at(0, 0).there);
  ASSERT_TRUE(full.at(1, 0).there);
  EXPECT_EQ(full.at(1, 0).position.y, 2);
  EXPECT_NEAR(rest.at(1, 0).radiance, 3, 1e-5);
  EXPECT_NEAR(full.at(1, 0).radiance, 3 * (1 + 1) / (1 + 0.5), 1e-5);
  EXPECT_NEAR(full.at(1, 0).albedo, 0.5, 1e-5);
}

PixelMaps floorMaps(int tile) {
  FirstVertices vertices = floorTowards(32, 20, {0.1f, 0.1f, 0.5f});
  // A step: the right part lies lower.
  for (int y = 0; y < 20; ++y)
    for (int x = 18; x < 32; ++x) vertices.at(x, y).position.z = -1;
  vertices.at(0, 0) = {};  // sees nothing
  return makePixelMaps(vertices, tile, *pixelHistogram(IncidentRadiance::full), *libraryTasks(1), {});
}

TEST(PixelMaps, EveryPixelHasOneOfItsSurface) {
  const PixelMaps maps = floorMaps(4);
  EXPECT_EQ(maps.size(), 8u * 5u);
  ASSERT_EQ(maps.ofPixel.size(), 32u * 20u);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 32; ++x) {
      const uint32_t map = maps.ofPixel[size_t(32 * y + x)];
      ASSERT_LT(map, maps.size());
      if (x > 0 || y > 0) EXPECT_EQ(maps.places[map].position.z, x < 18 ? 0 : -1) << x << ", " << y;
    }
}

TEST(PixelMaps, AreTheSameForAnyNumberOfThreads) {
  const FirstVertices vertices = floorTowards(64, 40, {0.1f, 0.1f, 0.5f});
  const auto model = pixelHistogram(IncidentRadiance::full);
  const PixelMaps one = makePixelMaps(vertices, 1, *model, *libraryTasks(1), {}),
                  many = makePixelMaps(vertices, 1, *model, *libraryTasks(3), {});
  EXPECT_EQ(one.texels, many.texels);
  EXPECT_EQ(one.ofPixel, many.ofPixel);
}

std::vector<PathVertex> manyVertices() {
  std::vector<PathVertex> vertices;
  for (uint32_t i = 0; i < 2000; ++i) {
    PathVertex& v = vertices.emplace_back();
    v.position = {float(i % 32) / 100, float(i / 32 % 20) / 100, 0};
    v.normal = kUp;
    v.wi = normalized({float(i % 7) - 3, float(i % 11) - 5, 4});
    v.radiance = {float(i % 3), 1, 1};
    v.weight = {0.5f, 0.5f, 0.5f};
    v.pdf = 0.3f;
    v.depth = 1;
    v.pixel = i % 640;
    v.lightGroup = i % 2;
    v.lightGroupProbability = 0.5f;
    v.direct = {1, 1, 1};
  }
  return vertices;
}

class PixelGuide : public ::testing::Test {
 protected:
  PixelGuide() {
    m_options.lightGroups = 2;
    m_options.cached = true;
    m_options.cachedError = 0.5f;
    GuideBuilder builder(m_options);
    const std::vector<PathVertex> vertices = manyVertices();
    builder.add(vertices);
    m_cells = builder.build();
  }
  GuideOptions m_options;
  Guide m_cells;
  PixelMaps m_maps = floorMaps(1);
};

TEST_F(PixelGuide, HoldsTheCellsAndAMapForEachPixel) {
  const Guide guide = PaperMethod::over(m_cells, m_maps, m_options, *libraryTasks(1));
  const GuideView cells = m_cells.view(), view = guide.view();
  ASSERT_EQ(view.cellCount, cells.cellCount + m_maps.size());
  ASSERT_EQ(view.pixels.count, 640u);
  EXPECT_TRUE(sameBits(view.maps, cells.maps, cells.cellCount * kMapShares));
  const Place first{m_maps.places[m_maps.ofPixel[37]].position, kUp, 37, 0, true};
  Place later = first;
  later.first = false;
  EXPECT_EQ(findCell(view, first), cells.cellCount + m_maps.ofPixel[37]);
  EXPECT_EQ(findCell(view, later), findCell(cells, later));
  // A pixel beyond the frame has no map, and many look-ups are like one.
  const Place beyond{first.position, kUp, 640, 0, true};
  const Place places[] = {later, first, later, beyond, first};
  uint32_t found[5];
  findCells(view, places, 5, found);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(found[i], findCell(view, places[i])) << i;
  EXPECT_EQ(found[3], findCell(cells, later));
  // Other decisions are those of the cell around.
  const uint32_t cell = findCell(cells, later), own = findCell(view, first);
  EXPECT_TRUE(sameBits(view.decisions + own, cells.decisions + cell, 1));
  EXPECT_TRUE(sameBits(view.lightTables + 3 * size_t(own), cells.lightTables + 3 * size_t(cell), 3));
  EXPECT_TRUE(sameBits(view.cached + 2 * size_t(own), cells.cached + 2 * size_t(cell), 2));
  EXPECT_TRUE(sameView(PaperMethod::cellsOf(guide).view(), cells));
}

TEST_F(PixelGuide, WithoutCellsHalfOfTheDrawsAreGuided) {
  m_options.cellsPerDiagonal = 0;
  const Guide guide = PaperMethod::over(Guide(), m_maps, m_options, *libraryTasks(1));
  const GuideView view = guide.view();
  EXPECT_EQ(view.cellCount, m_maps.size());
  EXPECT_EQ(view.decisions[5].bsdfFraction[0], 0.5f);
  EXPECT_EQ(view.decisions[5].survivalFactor, INFINITY);
  EXPECT_EQ(findCell(view, {{0, 0, 0}, kUp, 5, 0, false}), kNoCell);
}

// How far shares of 2^-15, of which each entry has one at least, are from probabilities.
constexpr double kOfShares = 18.0 / kWhole;

TEST_F(PixelGuide, BlendsAPixelsMapWithItsCells) {
  m_options.pixelShare = 0.25f;
  m_options.floor = 0;
  const Guide guide = PaperMethod::over(m_cells, m_maps, m_options, *libraryTasks(1));
  const GuideView view = guide.view(), cells = m_cells.view();
  const uint32_t own = view.pixels.cells[100];
  const PixelMaps::Place& place = m_maps.places[m_maps.ofPixel[100]];
  const uint32_t cell = findCell(cells, {place.position, place.normal});
  const Histogram radiance = m_maps.radiance(m_maps.ofPixel[100]), cosines = meanCosines(place.normal, 0),
                  blended = probabilitiesOf(SamplingMap<float>(view.maps, int32_t(own))),
                  ofCell = probabilitiesOf(SamplingMap<float>(cells.maps, int32_t(cell)));
  double sum = 0;
  for (size_t t = 0; t < kMapTexels; ++t) sum += radiance[t] * cosines[t];
  for (size_t t = 0; t < kMapTexels; ++t)
    EXPECT_NEAR(blended[t], 0.25 * radiance[t] * cosines[t] / sum + 0.75 * ofCell[t], kOfShares);
}

// Without the product the density is that of the radiance.
TEST_F(PixelGuide, MapsWithoutCosineAreThemselves) {
  m_options.cosineProduct = false;
  const Guide guide = PaperMethod::over(Guide(), m_maps, m_options, *libraryTasks(1));
  const Histogram radiance = m_maps.radiance(3),
                  probabilities = probabilitiesOf(SamplingMap<float>(guide.view().maps, 3));
  double sum = 0;
  for (const float value : radiance) sum += value;
  for (size_t t = 0; t < kMapTexels; ++t)
    EXPECT_NEAR(probabilities[t], (1 - m_options.floor) * radiance[t] / sum + m_options.floor / kMapTexels,
                kOfShares);
}

TEST(PixelOptions, MistakesAreRefused) {
  GuideOptions options;
  for (const auto spoil :
       {+[](GuideOptions& o) { o.pixelMaps = PixelMapKind(4); },
        +[](GuideOptions& o) { o.pixelMaps = PixelMapKind(-1); }, +[](GuideOptions& o) { o.pixelTile = 0; },
        +[](GuideOptions& o) { o.pixelTile = 17; }, +[](GuideOptions& o) { o.pixelShare = 1.5f; },
        +[](GuideOptions& o) { o.pixelShare = NAN; },
        +[](GuideOptions& o) { o.pixelMaps = PixelMapKind::network; }}) {
    GuideOptions bad = options;
    spoil(bad);
    EXPECT_THROW(GuideBuilder{bad}, std::invalid_argument);
  }
}

}  // namespace
}  // namespace odis::core
