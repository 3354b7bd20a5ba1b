// The code of docs/from-openpgl.md: paths that are told by their events teach a guide, which draws directions
// with the densities that it says.
#include <odis/events.h>
#include <odis/guided_vertex.h>

#include <numbers>
#include <random>

#include "api/api_scene.h"

namespace odis::test {
namespace {

constexpr float kInversePi = 1 / std::numbers::pi_v<float>;

// A path that meets a floor under a small bright light, and what is said of it in the place of a segment.
void tellFloor(PathRecorder& recorder, uint32_t sample, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform;
  const Float3 position{uniform(random), uniform(random), 0}, normal{0, 0, 1}, wo{0, 0, 1};
  const float u = uniform(random), phi = 2 * std::numbers::pi_v<float> * uniform(random);
  const Float3 wi{std::sqrt(u) * std::cos(phi), std::sqrt(u) * std::sin(phi), std::sqrt(1 - u)};
  const bool bright = dot(wi, Float3{0.6f, 0, 0.8f}) > 0.95f;
  const uint32_t path = recorder.begin({0, sample});
  recorder.surface(path, surfaceEvent(position, normal, wo, 1));
  recorder.bounce(path, bounceEvent(wi, {0.5f, 0.5f, 0.5f}, wi.z * kInversePi, 1));
  recorder.escape(path);
  if (bright) recorder.emission(path, emissionEvent({50, 50, 50}, 1, 0));
}

TEST(FromOpenPgl, PathsTeachAGuideAndVerticesDrawFromIt) {
  PathRecorder recorder;
  std::mt19937 random(1);
  for (uint32_t sample = 0; sample < 20000; ++sample) tellFloor(recorder, sample, random);
  GuideBuilder builder;
  builder.add(recorder.finish());
  EXPECT_EQ(builder.vertexCounts().accepted, 20000u);
  const Guide guide = builder.build();

  const GuideView view = guide.view();
  GuidedVertex vertex(view, {{0.5f, 0.5f, 0}, {0, 0, 1}, 0, 0, false, 1}, 1);
  EXPECT_TRUE(vertex.isKnown());
  vertex.prepare(1);
  ASSERT_TRUE(vertex.guides());
  std::uniform_real_distribution<float> uniform;
  // The mean of 1 / density over directions that are drawn with it is the solid angle where it is not zero.
  double solidAngle = 0, fromMap = 0, bright = 0;
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) {
    float u = uniform(random), v = uniform(random);
    const bool isFromMap = vertex.drawsFromMap(u);
    const float phi = 2 * std::numbers::pi_v<float> * v;
    const Float3 ofBsdf{std::sqrt(u) * std::cos(phi), std::sqrt(u) * std::sin(phi), std::sqrt(1 - u)};
    const Float3 wi = isFromMap ? vertex.sampleMap(u, v).wi : ofBsdf;
    const float bsdfPdf = std::max(wi.z, 0.0f) * kInversePi, pdf = vertex.pdf(wi, bsdfPdf, bsdfPdf);
    ASSERT_GT(pdf, 0);
    fromMap += isFromMap;
    bright += dot(wi, Float3{0.6f, 0, 0.8f}) > 0.95f;
    if (wi.z > 0.1f) solidAngle += 1 / pdf;
  }
  EXPECT_NEAR(solidAngle / kDraws, 2 * std::numbers::pi * 0.9, 0.2);
  EXPECT_NEAR(fromMap / kDraws, 1 - vertex.bsdfFraction(), 0.02);
  EXPECT_GT(bright / kDraws, 0.2) << "a BSDF alone draws 4 % of its directions from there";
}

}  // namespace
}  // namespace odis::test
