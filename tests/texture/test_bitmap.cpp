// Bitmap look-ups against values by hand. The numbers marked "Mitsuba" were read off Mitsuba 3.9's bitmap
// plugin with the same image.
#include <gtest/gtest.h>

#include <random>

#include "render/texture/bitmap.h"

namespace odis::render {
namespace {

// 4 x 3 texels with the values 0, 1/16, ..., 11/16, row by row.
std::shared_ptr<const Image> ramp() {
  std::vector<float> pixels(12);
  for (int i = 0; i < 12; ++i) pixels[i] = float(i) / 16.0f;
  return std::make_shared<Image>(4, 3, 1, pixels);
}

BitmapTexture make(WrapMode wrap, bool nearest = false, const UvTransform& toUv = {}) {
  return BitmapTexture(ramp(), {wrap, wrap, nearest, toUv});
}

TEST(Bitmap, TexelCentresReturnTexels) {
  const BitmapTexture texture = make(WrapMode::repeat);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 4; ++x)
      EXPECT_NEAR(texture.scalar({(float(x) + 0.5f) / 4, (float(y) + 0.5f) / 3}), float(4 * y + x) / 16,
                  1e-6f);
}

TEST(Bitmap, BilinearAgreesWithMitsuba) {
  const Vec2 uvs[] = {{0.3f, 0.4f},  {0.02f, 0.03f}, {0.99f, 0.97f},
                      {-0.2f, 1.3f}, {1.7f, -2.4f},  {0.5f, 0.5f}};
  const std::pair<WrapMode, std::vector<float>> expected[] = {
      {WrapMode::repeat, {0.21875f, 0.28375f, 0.39625f, 0.26875f, 0.46875f, 0.34375f}},
      {WrapMode::clamp, {0.21875f, 0.0f, 0.6875f, 0.5f, 0.1875f, 0.34375f}},
      {WrapMode::mirror, {0.21875f, 0.0f, 0.6875f, 0.41875f, 0.21875f, 0.34375f}}};
  for (const auto& [mode, values] : expected) {
    const BitmapTexture texture = make(mode);
    for (int i = 0; i < 6; ++i)
      EXPECT_NEAR(texture.scalar(uvs[i]), values[i], 1e-4f) << int(mode) << ", " << i;
  }
}

TEST(Bitmap, NearestAgreesWithMitsuba) {
  const Vec2 uvs[] = {{0.3f, 0.4f}, {0.02f, 0.03f}, {0.99f, 0.97f}, {-0.2f, 1.3f}, {1.7f, -2.4f}};
  const std::pair<WrapMode, std::vector<float>> expected[] = {
      {WrapMode::repeat, {0.3125f, 0.0f, 0.6875f, 0.1875f, 0.375f}},
      {WrapMode::clamp, {0.3125f, 0.0f, 0.6875f, 0.5f, 0.1875f}},
      {WrapMode::mirror, {0.3125f, 0.0f, 0.6875f, 0.5f, 0.3125f}}};
  for (const auto& [mode, values] : expected) {
    const BitmapTexture texture = make(mode, true);
    for (int i = 0; i < 5; ++i)
      EXPECT_NEAR(texture.scalar(uvs[i]), values[i], 1e-6f) << int(mode) << ", " << i;
    EXPECT_EQ(texture.gradient({0.3f, 0.4f}), Vec2(0, 0));
  }
}

TEST(Bitmap, ZeroAndOneSurroundTheImage) {
  EXPECT_EQ(make(WrapMode::zero).scalar({-1.0f, 0.5f}), 0.0f);
  EXPECT_EQ(make(WrapMode::one).scalar({0.5f, 2.0f}), 1.0f);
  // Half a texel out of the left edge of row 1: between the border and texel 4/16.
  EXPECT_NEAR(make(WrapMode::one).scalar({0.0f, 0.5f}), 0.5f * (1 + 0.25f), 1e-6f);
  const BitmapTexture mixed(ramp(), {WrapMode::clamp, WrapMode::zero, true, {}});
  EXPECT_EQ(mixed.scalar({5.0f, 0.5f}), 7.0f / 16);
  EXPECT_EQ(mixed.scalar({0.5f, 5.0f}), 0.0f);
}

TEST(Bitmap, TransformAppliesBeforeTheLookUp) {
  const BitmapTexture plain = make(WrapMode::repeat);
  const UvTransform toUv{{2.0f, 0.5f}, {-0.25f, 3.0f}, {0.1f, 0.2f}};
  const BitmapTexture moved = make(WrapMode::repeat, false, toUv);
  EXPECT_NEAR(moved.scalar({0.3f, 0.4f}), plain.scalar({0.6f - 0.1f + 0.1f, 0.15f + 1.2f + 0.2f}), 1e-5f);
  // Mitsuba, to_uv = scale by (2, 3), then moved by (0.1, 0.2).
  const BitmapTexture scaled = make(WrapMode::repeat, false, {{2, 0}, {0, 3}, {0.1f, 0.2f}});
  EXPECT_NEAR(scaled.scalar({0.3f, 0.4f}), 0.31875f, 1e-4f);
  EXPECT_NEAR(scaled.gradient({0.3f, 0.4f}).x, 0.5f, 1e-4f);
  EXPECT_NEAR(scaled.gradient({0.3f, 0.4f}).y, 2.25f, 1e-4f);
}

TEST(Bitmap, GradientIsTheDerivative) {
  std::mt19937 engine(2);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<float> pixels(7 * 5 * 3);
  for (float& p : pixels) p = uniform(engine);
  const auto image = std::make_shared<Image>(7, 5, 3, pixels);
  const UvTransform transforms[] = {{}, {{1.5f, 0.4f}, {-0.7f, 0.8f}, {0.3f, 0.1f}}};
  for (WrapMode mode : {WrapMode::repeat, WrapMode::clamp, WrapMode::mirror, WrapMode::zero, WrapMode::one})
    for (const UvTransform& toUv : transforms) {
      const BitmapTexture texture(image, {mode, mode, false, toUv});
      int compared = 0;
      for (int i = 0; i < 500; ++i) {
        const Vec2 uv(uniform(engine) * 3 - 1, uniform(engine) * 3 - 1);
        // The patch is smooth only between texel centres: keep the difference inside of one.
        constexpr float h = 2e-3f;
        const Vec2 st = toUv.apply(uv);
        const float x = st.x * 7 - 0.5f, y = st.y * 5 - 0.5f;
        const float fx = x - std::floor(x), fy = y - std::floor(y);
        if (std::min({fx, fy, 1 - fx, 1 - fy}) < 0.05f) continue;
        const Vec2 gradient = texture.gradient(uv);
        const float du = (texture.scalar({uv.x + h, uv.y}) - texture.scalar({uv.x - h, uv.y})) / (2 * h);
        const float dv = (texture.scalar({uv.x, uv.y + h}) - texture.scalar({uv.x, uv.y - h})) / (2 * h);
        EXPECT_NEAR(gradient.x, du, 5e-3f) << int(mode);
        EXPECT_NEAR(gradient.y, dv, 5e-3f) << int(mode);
        ++compared;
      }
      EXPECT_GT(compared, 300);
    }
}

TEST(Bitmap, ScalarIsTheLuminanceAndMeanTheAverage) {
  const std::vector<float> pixels = {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
  const BitmapTexture texture(std::make_shared<Image>(2, 2, 3, pixels), {});
  EXPECT_NEAR(texture.scalar({0.25f, 0.25f}), 0.212671f, 1e-6f);
  EXPECT_NEAR(texture.scalar({0.4f, 0.6f}), luminance(texture.rgb({0.4f, 0.6f})), 1e-6f);
  EXPECT_EQ(texture.mean(), Rgb(0.5f));
  EXPECT_FALSE(texture.isConstant());
}

TEST(Bitmap, OnePixelIsConstant) {
  const auto image = std::make_shared<Image>(1, 1, 3, std::vector<float>{0.1f, 0.2f, 0.3f});
  const BitmapTexture texture(image, {});
  EXPECT_TRUE(texture.isConstant());
  EXPECT_EQ(texture.mean(), Rgb(0.1f, 0.2f, 0.3f));
  EXPECT_TRUE(texture.rgb({0.7f, -3.1f}).equalWithAbsError(texture.mean(), 1e-6f));
  EXPECT_FALSE(BitmapTexture(image, {WrapMode::zero, WrapMode::repeat, false, {}}).isConstant());
}

TEST(Bitmap, AbsurdCoordinatesReadSomeTexel) {
  for (WrapMode mode : {WrapMode::repeat, WrapMode::clamp, WrapMode::mirror, WrapMode::zero, WrapMode::one})
    for (bool nearest : {false, true}) {
      const BitmapTexture texture = make(mode, nearest);
      for (float x : {NAN, INFINITY, -INFINITY, 1e30f, -1e30f, 4e8f, -0.0f, 1.0f}) {
        EXPECT_TRUE(std::isfinite(texture.scalar({x, 0.5f}))) << x;
        EXPECT_TRUE(std::isfinite(texture.gradient({0.5f, x}).y)) << x;
      }
    }
}

}  // namespace
}  // namespace odis::render
