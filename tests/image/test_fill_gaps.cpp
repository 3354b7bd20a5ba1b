// Pictures with gaps, as an unfinished image has them.
#include <gtest/gtest.h>

#include "render/image/fill_gaps.h"

namespace odis::render {
namespace {

constexpr float kNone = -1;  // a pixel without a value

// Fills the gaps of a picture whose pixels have one number each.
std::vector<float> filled(int width, int height, const std::vector<float>& values) {
  std::vector<Rgb> colors;
  std::vector<float> weights;
  for (const float value : values) {
    colors.emplace_back(value == kNone ? 1e30f : value);  // what stands there has no weight
    weights.push_back(value == kNone ? 0 : 1);
  }
  fillGaps(width, height, weights, colors);
  std::vector<float> result;
  for (const Rgb& color : colors) result.push_back(color.y);
  return result;
}

TEST(FillGaps, TakesTheSmallestSquareThatHasAValue) {
  EXPECT_EQ(filled(4, 4,
                   {1, kNone, kNone, kNone,  //
                    3, kNone, kNone, kNone,  //
                    kNone, kNone, 8, kNone,  //
                    kNone, kNone, kNone, kNone}),
            (std::vector<float>{1, 2, 4, 4,  // the mean of the picture where no pixel of the square has one
                                3, 2, 4, 4,  //
                                4, 4, 8, 8,  //
                                4, 4, 8, 8}));
}

TEST(FillGaps, OddSidesAndSinglePixels) {
  EXPECT_EQ(filled(3, 1, {kNone, 5, kNone}), (std::vector<float>{5, 5, 5}));
  EXPECT_EQ(filled(1, 5, {7, kNone, kNone, kNone, kNone}), (std::vector<float>{7, 7, 7, 7, 7}));
  EXPECT_EQ(filled(1, 1, {2}), (std::vector<float>{2}));
}

TEST(FillGaps, LeavesAPictureWithoutValues) {
  EXPECT_EQ(filled(2, 2, {kNone, kNone, kNone, kNone}), std::vector<float>(4, 1e30f));
}

TEST(FillGaps, WeighsWhatItAverages) {
  std::vector<Rgb> colors{Rgb(0, 0, 0), Rgb(4, 8, 12), Rgb(0, 0, 0), Rgb(0, 0, 0)};
  fillGaps(2, 2, {1, 3, 0, 0}, colors);
  EXPECT_EQ(colors[2], Rgb(3, 6, 9));
  EXPECT_EQ(colors[0], Rgb(0, 0, 0));
}

}  // namespace
}  // namespace odis::render
