// FLIP against the values of its authors' own program, and how it is applied to high dynamic range.
#include "eval/flip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "eval/exposure.h"
#include "eval/metrics.h"

using namespace odis::eval;
using odis::render::Rgb;

namespace {

// A ramp in red and green with a checkerboard in blue.
ColorImage makeReference(int width, int height) {
  ColorImage image{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.pixels.emplace_back(float(x) / float(width - 1), float(y) / float(height - 1),
                                float((x / 4 + y / 4) % 2) * 0.8f + 0.1f);
  return image;
}

// The same with a bright pixel, half of the red on the left and a patch of constant green.
ColorImage makeImage(int width, int height) {
  ColorImage image = makeReference(width, height);
  const auto pixel = [&](int x, int y) -> Rgb& { return image.pixels[size_t(y * width + x)]; };
  pixel(width / 2, height / 2) = Rgb(1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width / 4; ++x) pixel(x, y).x *= 0.5f;
  for (int y = height / 4; y < height / 2; ++y)
    for (int x = width / 2; x < width; ++x) pixel(x, y).y = 0.25f;
  return image;
}

double mean(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

// Made with the Python package flip-evaluator 1.7, with the arrays of makeReference and makeImage, 32 x 24
// and 150 x 90: evaluate(reference, image, "LDR", inputsRGB=False, applyMagma=False).
TEST(Flip, IsThatOfItsAuthors) {
  const std::vector<float> small = flipMap(makeImage(32, 24), makeReference(32, 24));
  ASSERT_EQ(small.size(), 32u * 24);
  const auto at = [&](int x, int y) { return small[size_t(y * 32 + x)]; };
  EXPECT_NEAR(at(0, 0), 0.026896, 2e-4);
  EXPECT_NEAR(at(16, 12), 0.225078, 2e-4);
  EXPECT_NEAR(at(20, 8), 0.430951, 2e-4);
  EXPECT_NEAR(at(31, 23), 0.000000, 2e-4);
  EXPECT_NEAR(at(3, 5), 0.163229, 2e-4);
  EXPECT_NEAR(at(16, 13), 0.174962, 2e-4);
  EXPECT_NEAR(mean(small), 0.126796, 1e-4);
  const std::vector<float> large = flipMap(makeImage(150, 90), makeReference(150, 90));
  EXPECT_NEAR(mean(large), 0.102703, 1e-4);
}

TEST(Flip, IsZeroForEqualImagesAndLargeForOpposites) {
  EXPECT_EQ(mean(flipMap(makeImage(20, 10), makeImage(20, 10))), 0);
  const ColorImage black{8, 8, std::vector<Rgb>(64, Rgb(0))}, white{8, 8, std::vector<Rgb>(64, Rgb(1))};
  EXPECT_NEAR(mean(flipMap(black, white)), 0.967388, 1e-4);  // as the package has it
  EXPECT_THROW(flipMap(black, makeImage(8, 9)), std::invalid_argument);
  EXPECT_THROW(flipMap({}, {}), std::invalid_argument);
}

// Two blocks of 8 pixels in a row.
ColorImage makeBlocks(const std::vector<Rgb>& left, const std::vector<Rgb>& right) {
  ColorImage image{16, 1, {}};
  for (size_t i = 0; i < 16; ++i)
    image.pixels.push_back(i < 8 ? left[i % left.size()] : right[i % right.size()]);
  return image;
}

// Grey of any brightness is brought to 0.18; a black half counts as a hundredth of the mean.
TEST(Exposure, BringsTheLogAverageToMiddleGrey) {
  EXPECT_NEAR(autoExposure(makeBlocks({Rgb(4)}, {Rgb(4)})), 0.18 / 4, 1e-6);
  EXPECT_NEAR(autoExposure(makeBlocks({Rgb(1)}, {Rgb(4)})), 0.18 / 2, 1e-6);
  EXPECT_NEAR(autoExposure(makeBlocks({Rgb(0)}, {Rgb(4)})), 0.18 / std::sqrt(0.02 * 4), 1e-6);
  EXPECT_EQ(autoExposure({1, 1, {Rgb(0)}}), 1);
  // Noise within a block is no darkness, and what is not finite does not count.
  EXPECT_NEAR(autoExposure(makeBlocks({Rgb(0), Rgb(8)}, {Rgb(4)})), 0.18 / 4, 1e-6);
  EXPECT_NEAR(autoExposure(makeBlocks({Rgb(NAN), Rgb(4)}, {Rgb(4)})), 0.18 / 4, 1e-6);
}

TEST(Exposure, ShowsWhatAScreenCan) {
  const ColorImage shown = displayed({3, 1, {Rgb(0.1f), Rgb(100), Rgb(-1, NAN, 0.2f)}}, 2);
  EXPECT_NEAR(shown.pixels[0].x, 0.2f, 1e-6);  // below the shoulder
  EXPECT_LE(shown.pixels[1].x, 1);
  EXPECT_GT(shown.pixels[1].x, 0.99f);
  EXPECT_EQ(shown.pixels[2], Rgb(0, 0, 0.4f));
}

// The same for an image a thousand times as bright, in other units.
TEST(Flip, DoesNotDependOnExposure) {
  ColorImage image = makeImage(40, 30), reference = makeReference(40, 30);
  const double before = compareImages(image, reference).flip;
  for (ColorImage* each : {&image, &reference})
    for (Rgb& pixel : each->pixels) pixel *= 1024.0f;
  EXPECT_NEAR(compareImages(image, reference).flip, before, 1e-5);
  EXPECT_GT(before, 0.01);
}

}  // namespace
