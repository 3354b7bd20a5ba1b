#include <gtest/gtest.h>

#include "render/texture/bitmap.h"
#include "render/texture/checkerboard.h"
#include "render/texture/constant.h"
#include "render/texture/scale.h"

namespace odis::render {
namespace {

TexturePtr constant(const Rgb& value) {
  return std::make_shared<ConstantTexture>(value);
}

// f(u, v) = u + 2 v on the unit square, where the bilinear patch of 64 x 64 texels is exact.
TexturePtr slope() {
  std::vector<float> pixels;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) pixels.push_back((float(x) + 0.5f) / 64 + 2 * (float(y) + 0.5f) / 64);
  return std::make_shared<BitmapTexture>(std::make_shared<Image>(64, 64, 1, pixels),
                                         BitmapTexture::Options{});
}

TEST(Constant, IsConstant) {
  const ConstantTexture texture({0.2f, 0.4f, 0.6f});
  EXPECT_TRUE(texture.isConstant());
  EXPECT_EQ(texture.rgb({3, 4}), Rgb(0.2f, 0.4f, 0.6f));
  EXPECT_EQ(texture.mean(), Rgb(0.2f, 0.4f, 0.6f));
  EXPECT_FLOAT_EQ(texture.scalar({0, 0}), luminance(Rgb(0.2f, 0.4f, 0.6f)));
  EXPECT_EQ(texture.gradient({0, 0}), Vec2(0, 0));
  EXPECT_EQ(ConstantTexture(Rgb(0.3f)).scalar({0, 0}), 0.3f);
}

TEST(Checkerboard, CellsOfMitsuba) {
  const CheckerboardTexture texture(constant(Rgb(0.1f)), constant(Rgb(0.9f)), {});
  for (const Vec2& uv :
       {Vec2(0.25f, 0.25f), Vec2(0.5f, 0.25f), Vec2(0, 0), Vec2(0.75f, 0.75f), Vec2(1.25f, 1.25f)})
    EXPECT_EQ(texture.rgb(uv), Rgb(0.1f)) << uv.x << ", " << uv.y;
  for (const Vec2& uv : {Vec2(0.75f, 0.25f), Vec2(0.5f, 0.75f), Vec2(-0.25f, 0.25f)})
    EXPECT_EQ(texture.rgb(uv), Rgb(0.9f)) << uv.x << ", " << uv.y;
  // Single numbers are swapped: what Mitsuba 3.9 looks up as opacity or roughness.
  EXPECT_EQ(texture.scalar({0.25f, 0.25f}), 0.9f);
  EXPECT_EQ(texture.scalar({0.75f, 0.25f}), 0.1f);
  EXPECT_NEAR(texture.mean().x, 0.5f, 1e-6f);
  EXPECT_FALSE(texture.isConstant());
  const CheckerboardTexture fine(constant(Rgb(0.1f)), constant(Rgb(0.9f)), {{2, 0}, {0, 3}, {0, 0}});
  EXPECT_EQ(fine.rgb({0.25f, 0.25f}), Rgb(0.9f));  // (0.5, 0.75)
  EXPECT_EQ(fine.rgb({0.6f, 0.6f}), Rgb(0.9f));    // (0.2, 0.8)
}

TEST(Scale, MultipliesValueAndGradient) {
  const ScaleTexture texture(slope(), constant(Rgb(10.0f)));
  EXPECT_NEAR(texture.scalar({0.3f, 0.4f}), 11.0f, 1e-4f);
  EXPECT_NEAR(texture.rgb({0.3f, 0.4f}).z, 11.0f, 1e-4f);
  EXPECT_NEAR(texture.gradient({0.3f, 0.4f}).x, 10.0f, 1e-3f);
  EXPECT_NEAR(texture.gradient({0.3f, 0.4f}).y, 20.0f, 1e-3f);
  EXPECT_NEAR(texture.mean().x, 15.0f, 1e-3f);
  EXPECT_FALSE(texture.isConstant());
  EXPECT_TRUE(ScaleTexture(constant(Rgb(2.0f)), constant(Rgb(3.0f))).isConstant());
}

TEST(Scale, ByAColourOrATexture) {
  const ScaleTexture coloured(slope(), constant({1, 0, 2}));
  EXPECT_NEAR(coloured.rgb({0.5f, 0.25f}).z, 2.0f, 1e-4f);
  EXPECT_NEAR(coloured.scalar({0.5f, 0.25f}), luminance(Rgb(1, 0, 2)), 1e-4f);
  // f^2 has the gradient 2 f f'.
  const ScaleTexture squared(slope(), slope());
  EXPECT_NEAR(squared.gradient({0.5f, 0.25f}).x, 2.0f, 0.01f);
  EXPECT_NEAR(squared.gradient({0.5f, 0.25f}).y, 4.0f, 0.01f);
}

}  // namespace
}  // namespace odis::render
