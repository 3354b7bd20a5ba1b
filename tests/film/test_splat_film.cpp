// A film that splats: what it makes of constants, of edges and of pixels that have unlike numbers of samples.
#include "render/film/splat_film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace odis::render {
namespace {

struct SplatCase {
  std::string name;
  std::shared_ptr<const Filter> filter;
};

std::vector<SplatCase> splatCases() {
  return {{"box of 3 pixels", makeBoxFilter(1.5f)},       {"tent", makeTentFilter()},
          {"wide tent", makeTentFilter(2.25f)},           {"gaussian", makeGaussianFilter()},
          {"wide gaussian", makeGaussianFilter(2)},       {"mitchell", makeMitchellFilter()},
          {"catmullrom", makeMitchellFilter(0.0f, 0.5f)}, {"lanczos", makeLanczosFilter()}};
}

FilmSettings filmOf(const std::shared_ptr<const Filter>& filter, int width, int height) {
  FilmSettings film;
  film.width = width;
  film.height = height;
  film.crop = {0, 0, width, height};
  film.filter = filter;
  return film;
}

SampledTiles tilesOf(const FilmSettings& film) {
  return {sampledPixels(film, FilmKind::splat), FilmKind::splat};
}

struct Sample {
  Vec2i pixel;
  SplatPlace place;
  std::vector<float> channels;
};

// Adds samples to a film tile by tile.
void addAll(SplatFilm& film, const SampledTiles& tiles, const std::vector<Sample>& samples) {
  for (uint32_t tile = 0; tile < tiles.count(); ++tile) {
    std::vector<SplatPlace> places;
    std::vector<float> channels;
    for (const Sample& s : samples) {
      const Vec2i at = s.pixel - tiles.corner(tile);
      if (at.x < 0 || at.y < 0 || at.x >= int(kTileSize) || at.y >= int(kTileSize)) continue;
      places.push_back({s.place.offset, s.place.weight, uint16_t(at.x), uint16_t(at.y)});
      channels.insert(channels.end(), s.channels.begin(), s.channels.end());
    }
    if (!places.empty()) film.add(tile, places, channels);
  }
}

// How many samples a pixel has, what each weighs, and the colour at a place.
using CountOf = std::function<int(const Vec2i& pixel)>;
using WeightOf = std::function<float(const Vec2i& pixel)>;
using ColorAt = std::function<float(float x, float y)>;

std::vector<Sample> samplesOf(const Crop& sampled, const CountOf& count, const WeightOf& weight,
                              const ColorAt& color, uint32_t seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<float> uniform(-0.5f, 0.4999f);
  std::vector<Sample> samples;
  for (int y = sampled.y; y < sampled.y + sampled.height; ++y)
    for (int x = sampled.x; x < sampled.x + sampled.width; ++x)
      for (int i = 0; i < count({x, y}); ++i) {
        const Vec2 offset(uniform(engine), uniform(engine));
        const float value = color(float(x) + 0.5f + offset.x, float(y) + 0.5f + offset.y);
        samples.push_back({{x, y}, {offset, weight({x, y})}, {value, value, value, 1}});
      }
  return samples;
}

TEST(SplatFilm, FiltersTellTheirValuesAtPixels) {
  for (const SplatCase& c : splatCases()) {
    const int reach = c.filter->reach();
    const double scale = 1 / double(c.filter->value({0, 0}));
    std::vector<float> taps(size_t(2 * reach + 1));
    for (int i = 0; i < 1000; ++i) {
      const float offset = -0.5f + (float(i) + 0.37f) / 1000;
      c.filter->taps(offset, taps.data());
      float center[100];
      c.filter->taps(0, center);
      for (int k = -reach; k <= reach; ++k)
        EXPECT_NEAR(taps[size_t(k + reach)] / center[reach],
                    double(c.filter->value({float(k) - offset, 0})) * scale, 2e-5)
            << c.name << " at " << k - offset;
    }
  }
}

TEST(SplatFilm, ConstantsStayConstant) {
  for (const SplatCase& c : splatCases())
    for (const Vec2i& size : {Vec2i(1, 1), Vec2i(5, 3), Vec2i(40, 21)}) {
      const FilmSettings settings = filmOf(c.filter, size.x, size.y);
      const SampledTiles tiles = tilesOf(settings);
      SplatFilm film(settings, tiles, {});
      const auto samples = samplesOf(
          tiles.sampled(), [](const Vec2i& p) { return 4 + (p.x + 3 * p.y) % 5; },
          [](const Vec2i& p) { return 8.0f / float(4 + (p.x + 3 * p.y) % 5); },
          [](float, float) { return 0.7f; }, 1);
      addAll(film, tiles, samples);
      const std::vector<float> sums = film.sums();
      ASSERT_EQ(sums.size(), size_t(size.x * size.y) * 4);
      for (size_t i = 0; i < sums.size(); i += 4)
        EXPECT_NEAR(sums[i] / sums[i + 3], 0.7f, 7e-7) << c.name << ", pixel " << i / 4;
    }
}

// The filter's value of an edge at x = 8: the share of it that lies to the right.
double edgeValue(const Filter& filter, int column) {
  constexpr int steps = 20000;
  const double center = column + 0.5, from = std::max(center - double(filter.radius()), 0.0),
               to = std::min(center + double(filter.radius()), 16.0);
  double all = 0, lit = 0;
  for (int i = 0; i < steps; ++i) {
    const double x = from + (i + 0.5) / steps * (to - from), value = filter.value({float(x - center), 0});
    all += value;
    if (x >= 8) lit += value;
  }
  return lit / all;
}

// Left of the edge pixels have half as many samples as were asked for, right of it three times as many.
double worstAtEdge(const SplatCase& c, bool withWeights) {
  const FilmSettings settings = filmOf(c.filter, 16, 16);
  const SampledTiles tiles = tilesOf(settings);
  SplatFilm film(settings, tiles, {});
  constexpr int asked = 8, images = 60;
  const auto count = [](const Vec2i& p) { return p.x < 8 ? asked / 2 : asked * 3; };
  const auto weight = [&](const Vec2i& p) { return withWeights ? float(asked) / float(count(p)) : 1.0f; };
  for (uint32_t seed = 0; seed < images; ++seed)
    addAll(film, tiles,
           samplesOf(
               tiles.sampled(), count, weight, [](float x, float) { return x >= 8; }, seed));
  const std::vector<float> sums = film.sums();
  double worst = 0;
  for (int x = 0; x < 16; ++x) {
    double mean = 0;
    for (int y = 0; y < 16; ++y) {
      const float* pixel = &sums[size_t(16 * y + x) * 4];
      mean += pixel[0] / pixel[3] / 16;
    }
    worst = std::max(worst, std::abs(mean - edgeValue(*c.filter, x)));
  }
  return worst;
}

TEST(SplatFilm, WeightsKeepEdgesWhereTheyAre) {
  for (const SplatCase& c : splatCases()) {
    EXPECT_LT(worstAtEdge(c, true), 0.008) << c.name;
    EXPECT_GT(worstAtEdge(c, false), 0.03) << c.name;
  }
}

// A crop's tiles begin elsewhere, and it has samples around it.
TEST(SplatFilm, CropsAreAsTheWhole) {
  for (const SplatCase& c : splatCases()) {
    FilmSettings settings = filmOf(c.filter, 50, 37);
    const SampledTiles tiles = tilesOf(settings);
    SplatFilm whole(settings, tiles, {});
    const std::vector<Sample> samples = samplesOf(
        tiles.sampled(), [](const Vec2i&) { return 2; }, [](const Vec2i&) { return 1.0f; },
        [](float x, float y) { return std::sin(x) * std::sin(y * 3) + 1; }, 7);
    addAll(whole, tiles, samples);
    const std::vector<float> expected = whole.sums();
    settings.crop = {9, 18, 23, 11};
    const SampledTiles some = tilesOf(settings);
    SplatFilm crop(settings, some, {});
    std::vector<Sample> inside;
    const Crop& sampled = some.sampled();
    for (const Sample& s : samples)
      if (s.pixel.x >= sampled.x && s.pixel.x < sampled.x + sampled.width && s.pixel.y >= sampled.y &&
          s.pixel.y < sampled.y + sampled.height)
        inside.push_back(s);
    addAll(crop, some, inside);
    const std::vector<float> sums = crop.sums();
    for (int y = 0; y < 11; ++y)
      for (int x = 0; x < 23; ++x)
        for (int k = 0; k < 4; ++k)
          EXPECT_EQ(sums[size_t(23 * y + x) * 4 + size_t(k)],
                    expected[size_t(50 * (y + 18) + x + 9) * 4 + size_t(k)])
              << c.name << " at " << x << ", " << y;
  }
}

TEST(SplatFilm, NothingIsSampledBeyondTheFilmUnlessAskedFor) {
  FilmSettings settings = filmOf(makeGaussianFilter(), 20, 10);
  EXPECT_EQ(sampledPixels(settings, FilmKind::splat), settings.crop);
  settings.crop = {1, 4, 5, 6};
  EXPECT_EQ(sampledPixels(settings, FilmKind::splat), (Crop{0, 2, 8, 8}));
  EXPECT_EQ(sampledPixels(settings, FilmKind::pixels), settings.crop);
  settings.sampleBorder = true;
  EXPECT_EQ(sampledPixels(settings, FilmKind::splat), (Crop{-1, 2, 9, 10}));
}

TEST(SplatFilm, SamplesThatWereKeptAreAddedWithTheWeightOfTheirPixel) {
  const FilmSettings settings = filmOf(makeGaussianFilter(), 20, 20);
  const SampledTiles tiles = tilesOf(settings);
  SplatFilm kept(settings, tiles, {}), added(settings, tiles, {});
  const SplatPlace place{{0.2f, -0.3f}, 1, 3, 5}, weighted{{0.2f, -0.3f}, 2.5f, 3, 5};
  const float color[4] = {1, 2, 3, 1};
  added.add(1, {&weighted, 1}, color);
  kept.keep(1, {&place, 1}, color);
  for (const float sum : kept.sums()) EXPECT_EQ(sum, 0);
  kept.addKept([&](uint32_t pixel) { return pixel == tiles.pixelIndex({19, 5}) ? 2.5f : NAN; });
  EXPECT_EQ(kept.sums(), added.sums());
}

TEST(SplatFilm, GoesOnWhereItWasSaved) {
  const FilmSettings settings = filmOf(makeTentFilter(), 20, 20);
  const SampledTiles tiles = tilesOf(settings);
  SplatFilm film(settings, tiles, {8, 8}), again(settings, tiles, {8, 8});
  const SplatPlace place{{0.2f, -0.3f}, 1.5f, 3, 5};
  const float channels[8] = {1, 2, 3, 1, 1, 2, 3, 1};
  film.add(0, {&place, 1}, channels);
  film.keep(1, {&place, 1}, channels);
  std::vector<uint8_t> bytes{1, 2, 3};
  film.save(bytes);
  std::span<const uint8_t> rest(bytes.data() + 3, bytes.size() - 3);
  ASSERT_TRUE(again.restore(rest));
  EXPECT_TRUE(rest.empty());
  for (SplatFilm* f : {&film, &again}) f->addKept([](uint32_t) { return 3.0f; });
  EXPECT_EQ(film.sums(), again.sums());
  // Whatever is cut off is refused, and so is a film of other channels.
  for (size_t size = 0; size + 3 < bytes.size(); ++size) {
    SplatFilm damaged(settings, tiles, {8, 8});
    std::span<const uint8_t> part(bytes.data() + 3, size);
    EXPECT_FALSE(damaged.restore(part)) << size;
  }
  SplatFilm other(settings, tiles, {});
  rest = {bytes.data() + 3, bytes.size() - 3};
  EXPECT_FALSE(other.restore(rest));
}

// Channels behind the filtered ones are means between what was added, also where lobes are negative.
TEST(SplatFilm, MeansStayBetweenWhatWasAdded) {
  const FilmSettings settings = filmOf(makeLanczosFilter(), 16, 16);
  const SampledTiles tiles = tilesOf(settings);
  SplatFilm film(settings, tiles, {6, 4});
  std::vector<Sample> samples = samplesOf(
      tiles.sampled(), [](const Vec2i&) { return 2; }, [](const Vec2i&) { return 1.0f; },
      [](float x, float) { return x < 8 ? 10.0f : 20.0f; }, 3);
  for (Sample& s : samples) s.channels.insert(s.channels.end(), {s.channels[0], 1});
  addAll(film, tiles, samples);
  const std::vector<float> sums = film.sums();
  float least = 100, most = 0;
  for (size_t i = 0; i < sums.size(); i += 6) {
    const float mean = sums[i + 4] / sums[i + 5], filtered = sums[i] / sums[i + 3];
    EXPECT_GE(mean, 9.999f);
    EXPECT_LE(mean, 20.001f);
    least = std::min(least, filtered);
    most = std::max(most, filtered);
  }
  EXPECT_LT(least, 9.9f);
  EXPECT_GT(most, 20.1f);
}

}  // namespace
}  // namespace odis::render
