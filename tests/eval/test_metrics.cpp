#include "eval/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

using odis::eval::ColorImage;
using odis::eval::ErrorMetrics;
using odis::render::Rgb;

namespace {

std::vector<Rgb> grey(size_t count, float value) {
  return std::vector<Rgb>(count, Rgb(value));
}

// Of images that are one row.
ErrorMetrics compareImages(const std::vector<Rgb>& image, const std::vector<Rgb>& reference) {
  return odis::eval::compareImages({int(image.size()), 1, image}, {int(reference.size()), 1, reference});
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
  EXPECT_NEAR(m.mean, 1.25, 1e-5);
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
  EXPECT_NEAR(m.mean, 1, 1e-5);
  EXPECT_TRUE(std::isinf(m.relMse));
  EXPECT_TRUE(std::isinf(m.smape));
  EXPECT_EQ(m.trimmedRelMse, 0);
  EXPECT_GT(m.flip, 0.001);  // the pixel itself counts 1
  EXPECT_LT(m.flip, 0.1);
}

TEST(Metrics, BlackReferenceIsNotScaled) {
  const ErrorMetrics m = compareImages({Rgb(0.1f)}, {Rgb(0)});
  EXPECT_NEAR(m.relMse, 0.01 / 0.01, 1e-6);
}

// Mean 2: pixels are scaled by 0.5, variances by 0.25.
TEST(Metrics, ReferenceBringsInItsOwnError) {
  const ColorImage reference{2, 1, {Rgb(1), Rgb(3)}};
  const auto error = odis::eval::referenceError(reference, {Rgb(0.04f), Rgb(0)});
  EXPECT_NEAR(error.relMse, 0.01 / 0.26 / 2, 1e-6);
  EXPECT_NEAR(error.trimmedRelMse, error.relMse, 1e-12);
  EXPECT_THROW(odis::eval::referenceError(reference, {Rgb(1)}), std::invalid_argument);
}

// An image with noise of a known variance against a noisy reference: the errors add.
TEST(Metrics, ErrorsOfImageAndReferenceAdd) {
  uint32_t state = 1;
  const auto noise = [&](float deviation) {  // uniform
    state = state * 1664525u + 1013904223u;
    return deviation * std::sqrt(12.0f) * (float(state >> 8) / float(1 << 24) - 0.5f);
  };
  ColorImage image{200, 100, {}}, reference = image;
  for (int i = 0; i < 20000; ++i) {
    image.pixels.emplace_back(1 + noise(0.2f), 1 + noise(0.2f), 1 + noise(0.2f));
    reference.pixels.emplace_back(1 + noise(0.05f), 1 + noise(0.05f), 1 + noise(0.05f));
  }
  const ColorImage truth{200, 100, grey(20000, 1)};
  const double alone = odis::eval::compareImages(image, truth).relMse;
  const double both = odis::eval::compareImages(image, reference).relMse;
  const double own =
      odis::eval::referenceError(reference, std::vector<Rgb>(20000, Rgb(0.05f * 0.05f))).relMse;
  EXPECT_NEAR(both, alone + own, 0.03 * both);
  EXPECT_GT(both - alone, 0.5 * own);
}

TEST(Metrics, RefuseWhatCannotBeCompared) {
  EXPECT_THROW(compareImages(grey(2, 1), grey(3, 1)), std::invalid_argument);
  EXPECT_THROW(compareImages({}, {}), std::invalid_argument);
  EXPECT_THROW(compareImages(grey(1, 1), grey(1, std::numeric_limits<float>::infinity())),
               std::invalid_argument);
}

}  // namespace
