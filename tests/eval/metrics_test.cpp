#include "eval/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

using odis::eval::compareImages;
using odis::eval::ErrorMetrics;
using odis::render::Rgb;

namespace {

std::vector<Rgb> grey(size_t count, float value) {
  return std::vector<Rgb>(count, Rgb(value));
}

TEST(Metrics, AreZeroForTheReferenceItself) {
  const ErrorMetrics m = compareImages(grey(10, 0.3f), grey(10, 0.3f));
  EXPECT_EQ(m.mse, 0);
  EXPECT_EQ(m.relMse, 0);
  EXPECT_EQ(m.trimmedRelMse, 0);
  EXPECT_EQ(m.smape, 0);
}

// Reference 1 and 3 (mean 2, so 0.5 and 1.5), image 2 and 3 (1 and 1.5): the first pixel differs by 0.5.
TEST(Metrics, AgreeWithPaper) {
  const ErrorMetrics m = compareImages({Rgb(2), Rgb(3)}, {Rgb(1), Rgb(3)});
  EXPECT_NEAR(m.mse, 0.25 / 2, 1e-5);
  EXPECT_NEAR(m.relMse, 0.25 / 0.26 / 2, 1e-5);
  EXPECT_NEAR(m.smape, 0.5 / 0.76 / 2, 1e-5);
  EXPECT_NEAR(m.trimmedRelMse, m.relMse, 1e-12);  // two pixels: 0.1 % of them is none
}

// Only red differs, by 1, from a reference of 1: a third of the error of a grey pixel.
TEST(Metrics, AverageChannels) {
  const ErrorMetrics m = compareImages({Rgb(2, 1, 1)}, {Rgb(1)});
  EXPECT_NEAR(m.mse, 1.0 / 3, 1e-5);
  EXPECT_NEAR(m.relMse, 1 / 1.01 / 3, 1e-5);
}

TEST(Metrics, DoNotDependOnExposure) {
  const std::vector<Rgb> reference{Rgb(1, 2, 3), Rgb(0.5f), Rgb(0, 0, 4)};
  const std::vector<Rgb> image{Rgb(1.5f, 2, 2), Rgb(0.25f), Rgb(0.5f, 0, 4)};
  std::vector<Rgb> brightReference = reference, brightImage = image;
  for (Rgb& pixel : brightReference) pixel *= 1024.0f;
  for (Rgb& pixel : brightImage) pixel *= 1024.0f;
  const ErrorMetrics a = compareImages(image, reference), b = compareImages(brightImage, brightReference);
  EXPECT_NEAR(a.mse, b.mse, 1e-9);
  EXPECT_NEAR(a.relMse, b.relMse, 1e-9);
  EXPECT_NEAR(a.smape, b.smape, 1e-9);
}

// 2,000 pixels of which two, 0.1 %, are fireflies and one more is off by 1.
TEST(Metrics, TrimmingDropsTheWorstPixels) {
  std::vector<Rgb> image = grey(2000, 1);
  image[3] = Rgb(1000);
  image[700] = Rgb(500);
  image[1999] = Rgb(2);
  const ErrorMetrics m = compareImages(image, grey(2000, 1));
  EXPECT_NEAR(m.trimmedRelMse, 1 / 1.01 / 1998, 1e-8);
  EXPECT_NEAR(m.relMse, (999.0 * 999 + 499.0 * 499 + 1) / 1.01 / 2000, 1e-2);
}

TEST(Metrics, PixelsThatAreNotFiniteAreInfinitelyWrong) {
  std::vector<Rgb> image = grey(1000, 1);
  image[10].y = std::numeric_limits<float>::quiet_NaN();
  const ErrorMetrics m = compareImages(image, grey(1000, 1));
  EXPECT_EQ(m.nonFinitePixels, 1u);
  EXPECT_TRUE(std::isinf(m.relMse));
  EXPECT_TRUE(std::isinf(m.smape));
  EXPECT_EQ(m.trimmedRelMse, 0);
}

TEST(Metrics, BlackReferenceIsNotScaled) {
  const ErrorMetrics m = compareImages({Rgb(0.1f)}, {Rgb(0)});
  EXPECT_NEAR(m.relMse, 0.01 / 0.01, 1e-6);
}

TEST(Metrics, RefuseWhatCannotBeCompared) {
  EXPECT_THROW(compareImages(grey(2, 1), grey(3, 1)), std::invalid_argument);
  EXPECT_THROW(compareImages({}, {}), std::invalid_argument);
  EXPECT_THROW(compareImages(grey(1, 1), grey(1, std::numeric_limits<float>::infinity())),
               std::invalid_argument);
}

}  // namespace
