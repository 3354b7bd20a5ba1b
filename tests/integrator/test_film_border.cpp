// The border of the film: pixels see nothing of what lies beyond it, as in Mitsuba 3.
#include <gtest/gtest.h>

#include "integrator/test_scenes.h"

namespace odis::render {
namespace {

struct Film {
  int width, height;
};

// Looks along z at a wall that shines over the film's columns up to `end`, and beyond the film to the left.
std::string lamp(const Film& size, const std::string& filter, double end, const std::string& more = "") {
  const double right = 1 - 2 * end / size.width;  // in x at z = 1, where the film's columns end at 1 and -1
  return "<sensor type=\"perspective\"><float name=\"fov\" value=\"90\"/><film type=\"hdrfilm\"><integer "
         "name=\"width\" value=\"" +
         std::to_string(size.width) + "\"/><integer name=\"height\" value=\"" + std::to_string(size.height) +
         "\"/>" + more + "<rfilter type=\"" + filter +
         "\"/></film></sensor><shape type=\"rectangle\"><transform name=\"to_world\"><scale x=\"5\" "
         "y=\"20\"/><rotate y=\"1\" angle=\"180\"/><translate x=\"" +
         std::to_string(right + 5) +
         "\" z=\"1\"/></transform><emitter type=\"area\"><rgb name=\"radiance\" value=\"1\"/></emitter>"
         "</shape>";
}

const char* const kFilters[] = {"box", "tent", "gaussian", "mitchell", "catmullrom", "lanczos"};

// The share of the filter of a column on the film that lies before `end`.
double expectedShare(const Filter& filter, int column, int width, double end) {
  constexpr int steps = 20000;
  const double center = column + 0.5, from = std::max(center - double(filter.radius()), 0.0),
               to = std::min(center + double(filter.radius()), double(width));
  double all = 0, lit = 0;
  for (int i = 0; i < steps; ++i) {
    const double x = from + (i + 0.5) / steps * (to - from), value = filter.value({float(x - center), 0});
    all += value;
    if (x < end) lit += value;
  }
  return lit / all;
}

RenderOptions pathTracing(int spp) {
  RenderOptions options;
  options.integrator = IntegratorKind::path;
  options.sampler = SamplerKind::independent;
  options.spp = spp;
  options.variance = true;
  return options;
}

TEST(FilmBorder, ShowsNothingOfWhatLiesBeside) {
  for (const char* filter : kFilters)
    for (const Film& size : {Film{16, 16}, Film{1, 1}, Film{2, 3}, Film{3, 1}}) {
      const auto scene = test::loadScene(lamp(size, filter, 0));
      for (const Rgb& color : test::renderScene(*scene, pathTracing(64)).image.color)
        ASSERT_EQ(color, Rgb(0, 0, 0)) << filter << ", " << size.width << " x " << size.height;
    }
}

// What converges is the sum of filter times radiance over the sum of the filter, over places on the film.
TEST(FilmBorder, IsWeighedByTheFilterOnTheFilm) {
  constexpr int spp = 4096;
  const Film sizes[] = {{8, 8}, {1, 1}, {2, 3}};
  const double tests = 6 * (64 + 1 + 6), alpha = 1 - std::pow(0.99, 1 / tests);
  double bound = 0;
  while (std::erfc(bound / std::sqrt(2.0)) > alpha) bound += 1e-3;
  for (const char* filter : kFilters)
    for (const Film& size : sizes) {
      const double end = 0.7;
      const auto scene = test::loadScene(lamp(size, filter, end));
      const RenderedImage image = test::renderScene(*scene, pathTracing(spp)).image;
      for (int i = 0; i < size.width * size.height; ++i) {
        const double expected = expectedShare(*scene->film().filter, i % size.width, size.width, end);
        EXPECT_NEAR(image.color[size_t(i)].x, expected, bound * std::sqrt(image.variance[size_t(i)].x) + 1e-3)
            << filter << ", " << size.width << " x " << size.height << ", pixel " << i;
      }
    }
}

// Only the film has a border. A crop shows the same pixels.
TEST(FilmBorder, IsNotTheCrops) {
  const Film size{8, 6};
  for (const char* filter : {"gaussian", "lanczos"}) {
    const auto whole = test::loadScene(lamp(size, filter, 2.7));
    const auto part = test::loadScene(
        lamp(size, filter, 2.7,
             "<integer name=\"crop_offset_x\" value=\"2\"/><integer name=\"crop_offset_y\" value=\"0\"/>"
             "<integer name=\"crop_width\" value=\"3\"/><integer name=\"crop_height\" value=\"4\"/>"));
    const std::vector<Rgb> all = test::renderScene(*whole, pathTracing(16)).image.color,
                           some = test::renderScene(*part, pathTracing(16)).image.color;
    for (size_t y = 0; y < 4; ++y)
      for (size_t x = 0; x < 3; ++x) EXPECT_EQ(some[y * 3 + x], all[y * 8 + x + 2]) << filter;
  }
}

// With `sample_border` pixels at the border see beyond it.
TEST(FilmBorder, MayBeSampled) {
  const Film size{2, 2};
  const auto scene =
      test::loadScene(lamp(size, "tent", 0, "<boolean name=\"sample_border\" value=\"true\"/>"));
  EXPECT_NEAR(test::renderScene(*scene, pathTracing(4096)).image.color[0].x, 0.125, 0.03);
}

}  // namespace
}  // namespace odis::render
