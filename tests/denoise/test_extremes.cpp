// Images that Open Image Denoise by itself makes nonsense of: very bright, very dim, very small, grey.
#include <cmath>
#include <random>

#include "render/denoise/denoiser.h"
#include "support/denoiser.h"

namespace odis::render {
namespace {

constexpr int kSide = 64;

// Squares of .3 and .5, with noise; grey.
std::vector<Rgb> squares(int width = kSide, int height = kSide) {
  std::mt19937 random(3);
  std::gamma_distribution<float> noise(4, 0.25f);
  std::vector<Rgb> image;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.push_back(Rgb((x / 8 + y / 8) % 2 ? 0.5f : 0.3f) * noise(random));
  return image;
}

std::vector<Rgb> denoised(const std::vector<Rgb>& image, int width = kSide) {
  Progress quiet;
  return Denoiser(1)
      .denoise({width, int(image.size()) / width, image, {}, {}}, Auxiliaries::none, quiet)
      .value();
}

double mean(const std::vector<Rgb>& image) {
  double sum = 0;
  for (const Rgb& color : image) sum += average(color) / double(image.size());
  return sum;
}

// Pixels more than `distance` away from the middle.
double meanDifferenceBeyond(const std::vector<Rgb>& a, const std::vector<Rgb>& b, int distance) {
  double sum = 0;
  int count = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      if (std::max(std::abs(x - 32), std::abs(y - 32)) <= distance) continue;
      sum += std::abs(a[size_t(y * kSide + x)].x - b[size_t(y * kSide + x)].x);
      ++count;
    }
  return sum / count;
}

TEST(DenoisedExtremes, OneBrightPixelHarmsNoOther) {
  ODIS_NEEDS_DENOISER();
  std::vector<Rgb> image = squares();
  const std::vector<Rgb> expected = denoised(image);
  for (const float bright : {1e6f, 1e10f, 1e15f, 1e20f, 1e30f, 1e38f}) {
    image[32 * kSide + 32] = Rgb(bright);
    const std::vector<Rgb> found = denoised(image);
    EXPECT_LT(meanDifferenceBeyond(found, expected, 0), 0.005) << bright;
    EXPECT_LT(found[32 * kSide + 32].x, 2) << bright;
  }
}

// A lamp stays one, and what is around it stays what it is.
TEST(DenoisedExtremes, ALampStaysAsBrightAsItIs) {
  ODIS_NEEDS_DENOISER();
  std::vector<Rgb> image = squares();
  const std::vector<Rgb> expected = denoised(image);
  for (const float bright : {100.0f, 1e4f, 1e9f, 1e30f}) {
    const Rgb lamp = Rgb(1, 0.5f, 0.25f) * bright;
    for (int y = 28; y < 36; ++y)
      for (int x = 28; x < 36; ++x) image[size_t(y * kSide + x)] = lamp;
    const std::vector<Rgb> found = denoised(image);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(found[32 * kSide + 32][c] / lamp[c], 1, 0.1) << bright;
      for (const Rgb& color : found) ASSERT_LE(color[c], lamp[c]) << bright;
    }
    EXPECT_LT(meanDifferenceBeyond(found, expected, 16), 0.05) << bright;
  }
}

TEST(DenoisedExtremes, ALampIsNoBrighterThanWhatIsNear) {
  ODIS_NEEDS_DENOISER();
  // A dark room with a few lamps of few pixels, each behind glass that shows it with noise.
  std::mt19937 random(1);
  std::exponential_distribution<float> light(1);
  std::vector<Rgb> image(kSide * kSide);
  for (Rgb& color : image) color = Rgb(0.5f, 0.3f, 0.2f) * light(random);
  for (const int at : {12, 20, 40, 52})
    for (int y = at; y < at + 3; ++y)
      for (int x = at; x < at + 3; ++x) image[size_t(y * kSide + x)] = Rgb(900, 500, 200) * light(random);
  const std::vector<Rgb> found = denoised(image);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      for (int c = 0; c < 3; ++c) {
        float most = 0;
        for (int v = std::max(y - 8, 0); v <= std::min(y + 8, kSide - 1); ++v)
          for (int u = std::max(x - 8, 0); u <= std::min(x + 8, kSide - 1); ++u)
            most = std::max(most, image[size_t(v * kSide + u)][c]);
        if (const float value = found[size_t(y * kSide + x)][c]; value > 200) ASSERT_LE(value, most);
      }
}

TEST(DenoisedExtremes, FollowTheScale) {
  ODIS_NEEDS_DENOISER();
  const std::vector<Rgb> image = squares(), expected = denoised(image);
  for (const float scale : {1e-44f, 1e-38f, 1e-20f, 4e-11f, 1e-9f, 1e-3f, 1e3f, 1e10f, 1e20f, 1e37f}) {
    std::vector<Rgb> scaled = image;
    for (Rgb& color : scaled) color *= scale;
    const std::vector<Rgb> found = denoised(scaled);
    // Among the smallest numbers there are steps.
    const double tolerance = scale < 1e-40f ? 0.2 : 1e-3;
    for (size_t i = 0; i < image.size(); i += 5)
      ASSERT_NEAR(double(found[i].x) / double(scale), expected[i].x, tolerance) << scale;
  }
}

TEST(DenoisedExtremes, BlackStaysBlack) {
  ODIS_NEEDS_DENOISER();
  for (const Rgb& color : denoised(std::vector<Rgb>(kSide * kSide, Rgb(0, 0, 0))))
    EXPECT_EQ(color, Rgb(0, 0, 0));
  for (const Rgb& color : denoised(std::vector<Rgb>(9, Rgb(NAN, -1, INFINITY)), 3))
    EXPECT_EQ(color, Rgb(0, 0, 0));
}

TEST(DenoisedExtremes, SmallImagesKeepTheirMean) {
  ODIS_NEEDS_DENOISER();
  for (const auto& [width, height] : std::vector<std::pair<int, int>>{
           {1, 1}, {2, 2}, {64, 1}, {64, 2}, {64, 3}, {1, 64}, {2, 64}, {5, 3}, {15, 15}, {100, 15}}) {
    const std::vector<Rgb> image = squares(width, height);
    const std::vector<Rgb> found = denoised(image, width);
    ASSERT_EQ(found.size(), image.size());
    EXPECT_NEAR(mean(found) / mean(image), 1, 0.03) << width << " x " << height;
  }
}

// With whatever the auxiliaries show, also where some pixels are no numbers.
TEST(DenoisedExtremes, GreyStaysGrey) {
  ODIS_NEEDS_DENOISER();
  std::vector<Rgb> image = squares();
  image[100] = Rgb(NAN, 1, 1);
  image[300] = Rgb(1e30f);
  std::vector<Rgb> albedo;
  for (int i = 0; i < kSide * kSide; ++i) albedo.emplace_back(0.9f, i % 16 < 8 ? 0.2f : 0.7f, 0.4f);
  const std::vector<Vec3> normal(image.size(), Vec3(0, 0.6f, 0.8f));
  Progress quiet;
  for (const Auxiliaries auxiliaries :
       {Auxiliaries::none, Auxiliaries::noisy, Auxiliaries::clean, Auxiliaries::prefiltered}) {
    const auto found = Denoiser(1).denoise({kSide, kSide, image, albedo, normal}, auxiliaries, quiet).value();
    for (const Rgb& color : found) {
      ASSERT_EQ(color.x, color.y);
      ASSERT_EQ(color.x, color.z);
    }
    EXPECT_NEAR(mean(found), 0.4, 0.02);
  }
}

}  // namespace
}  // namespace odis::render
