// SSIM against scikit-image 0.26: structural_similarity(a, b, gaussian_weights=True, sigma=1.5,
// use_sample_covariance=False, data_range=1, channel_axis=-1), whose mean leaves out 5 pixels at the border.
#include "eval/ssim.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "render/image/srgb.h"

using namespace odis::eval;
using odis::render::Rgb;

namespace {

constexpr int kColumns = 32, kRows = 24, kBorder = 5;

// Patterns of values as a screen has them, in linear light: a red one that may be moved, a green one that may
// be darkened, and a blue ramp.
ColorImage pattern(int moved, float green) {
  ColorImage image{kColumns, kRows, {}};
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x)
      image.pixels.emplace_back(odis::render::srgbDecode(float((x * 7 + y * 13 + moved) % 32) / 31),
                                odis::render::srgbDecode(float((x * 5 + y * 3) % 17) / 16 * green),
                                odis::render::srgbDecode(float(x + y) / 54));
  return image;
}

TEST(Ssim, AgreesWithScikitImage) {
  const std::vector<float> map = ssimMap(pattern(0, 1), pattern(3, 0.8f));
  const auto at = [&](int x, int y) { return map[size_t(y * kColumns + x)]; };
  double sum = 0;
  for (int y = kBorder; y < kRows - kBorder; ++y)
    for (int x = kBorder; x < kColumns - kBorder; ++x) sum += at(x, y);
  EXPECT_NEAR(sum / ((kColumns - 2 * kBorder) * (kRows - 2 * kBorder)), 0.8169738612, 1e-5);
  EXPECT_NEAR(at(16, 12), 0.7650751056, 1e-5);
  EXPECT_NEAR(at(5, 5), 0.6911714114, 1e-5);
  EXPECT_NEAR(at(26, 18), 0.8755011228, 1e-5);
}

TEST(Ssim, IsOneForTheSameImage) {
  for (const float value : ssimMap(pattern(0, 1), pattern(0, 1))) ASSERT_NEAR(value, 1, 1e-6);
}

// Two even images differ in their means only: (2 a b + C1) / (a^2 + b^2 + C1), up to the border.
TEST(Ssim, OfEvenImages) {
  const ColorImage dark{3, 2, std::vector<Rgb>(6, Rgb(odis::render::srgbDecode(0.25f)))},
      bright{3, 2, std::vector<Rgb>(6, Rgb(odis::render::srgbDecode(0.75f)))};
  for (const float value : ssimMap(dark, bright))
    ASSERT_NEAR(value, (2 * 0.25 * 0.75 + 1e-4) / (0.25 * 0.25 + 0.75 * 0.75 + 1e-4), 1e-5);
}

TEST(Ssim, RefusesOtherSizes) {
  EXPECT_THROW(ssimMap({1, 1, {Rgb(0)}}, {2, 1, {Rgb(0), Rgb(0)}}), std::invalid_argument);
  EXPECT_THROW(ssimMap({}, {}), std::invalid_argument);
}

}  // namespace
