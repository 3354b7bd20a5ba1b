#include <gtest/gtest.h>

#include "render/image/tonemap.h"

namespace odis::render {
namespace {

TEST(ToneMap, SrgbCurveIsItsOwnInverseAndKnown) {
  // 50 % grey is stored as 0.735357; the stored byte 128 decodes to 0.215861 (IEC 61966-2-1).
  EXPECT_NEAR(srgbEncode(0.5f), 0.735357f, 1e-5f);
  EXPECT_NEAR(srgbDecode(128.0f / 255.0f), 0.215861f, 1e-5f);
  for (int i = 0; i < 256; ++i) EXPECT_EQ(toByte(srgbDecode(float(i) / 255.0f)), i);
}

TEST(ToneMap, FilmicKeepsMidtonesRisesAndStaysBelowOne) {
  EXPECT_EQ(filmicCurve(0.18f), 0.18f);
  EXPECT_EQ(filmicCurve(kShoulder), kShoulder);
  // Continuous in value and slope where the shoulder begins.
  EXPECT_NEAR((filmicCurve(kShoulder + 1e-3f) - kShoulder) / 1e-3f, 1.0f, 5e-3f);
  for (float x = 0; x < 4; x += 0.01f) EXPECT_LT(filmicCurve(x), filmicCurve(x + 0.01f));
  EXPECT_LE(filmicCurve(1e30f), 1.0f);
}

TEST(ToneMap, AbsurdLightBecomesBlackOrWhite) {
  EXPECT_EQ(toByte(filmicCurve(NAN)), 0);
  EXPECT_EQ(toByte(filmicCurve(INFINITY)), 255);
  EXPECT_EQ(toByte(-1.0f), 0);
  EXPECT_EQ(toByte(1e10f), 255);
}

}  // namespace
}  // namespace odis::render
