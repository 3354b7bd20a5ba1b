// A room full of fog: guided images have the expectation of plain path tracing. Images of 32 x 32 pixels.
#include "frame/run_frame.h"
#include "frame/wrong_models.h"
#include "support/models.h"

namespace odis::test {

namespace {

constexpr uint32_t kFogSide = 32;

// Thick enough that most paths are scattered in it; a patch on the floor glows, which only they find that are
// scattered.
ToyRoom foggyRoom() {
  ToyRoom room;
  room.extinction = 1.5f;
  room.patchSize = 0.3f;
  room.patchRadiance = 3;
  return room;
}

class FrameInFog : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    FrameOptions options = toyOptions(kFogSide, kFogSide, 32);
    options.set("guided=off");
    s_reference = estimate(options, foggyRoom(), 48, 5000);
  }
  static void expectUnbiased(const FrameOptions& options) {
    expectSameExpectation(estimate(options, foggyRoom(), 96, 1), s_reference);
  }
  static inline Estimate s_reference;
};

TEST_F(FrameInFog, ByTheNetworksHasTheSameExpectation) {
  expectUnbiased(toyOptions(kFogSide, kFogSide, 4));
}

TEST_F(FrameInFog, ByFormulasHasTheSameExpectation) {
  FrameOptions options = toyOptions(kFogSide, kFogSide, 4);
  options.guide.model = makeModel(nullptr, nullptr);
  options.set("refine=3");
  expectUnbiased(options);
}

TEST_F(FrameInFog, ByWrongMapsAndTablesHasTheSameExpectation) {
  using Kind = WrongDirections::Kind;
  for (const Kind kind : {Kind::random, Kind::oneTexel, Kind::zero, Kind::notANumber})
    expectUnbiased(decidedWrongly(toyOptions(kFogSide, kFogSide, 4), kind));
}

// What the camera's rays meet in fog scatters back what the pixel is.
TEST_F(FrameInFog, RecordsWhatThePixelsAre) {
  const FrameOptions options = toyOptions(kFogSide, kFogSide, 4);
  Frame frame(options);
  const FramePass* pass = frame.beginPass();
  ASSERT_NE(pass, nullptr);
  const ToyHost host(foggyRoom(), kFogSide, kFogSide);
  PathRecorder recorder;
  int compared = 0;
  for (uint32_t pixel = 0; pixel < kFogSide * kFogSide; ++pixel) {
    const FrameSample sample = host.trace(*pass, pixel, 0, recorder);
    const ArrayView<const PathVertex> vertices = recorder.finish();
    if (vertices.empty() || !isInMedium(vertices[0]) || vertices[0].emission > 0) continue;
    const PathVertex& v = vertices[0];
    const float scattered = v.weight.x * v.radiance.x;
    if (!(scattered > 0)) continue;
    const float upToHere = v.indirect / scattered;  // what the camera's ray is multiplied by
    EXPECT_NEAR(sample.value.x / (upToHere * (v.direct.x + scattered)), 1, 1e-4f) << pixel;
    ++compared;
  }
  EXPECT_GT(compared, 200);
}

TEST_F(FrameInFog, LearnsFromVerticesInMedia) {
  FrameOptions options = toyOptions(kFogSide, kFogSide, 8);
  Frame frame(options);
  runFrame(frame, options, foggyRoom());
  const VertexCounts counts = frame.vertexCounts();
  EXPECT_EQ(refusedVertices(counts), 0u);
  EXPECT_GT(counts.inMedia, counts.accepted / 4);
  EXPECT_LT(counts.inMedia, counts.accepted);
  const Guide guide = frame.guide();
  const GuideView view = guide.view();
  const GuidedVertex inFog(view, {{0.5f, 0.3f, 0.8f}, {}}, 1);
  ASSERT_TRUE(inFog.isKnown());
  EXPECT_TRUE(CellGrid::isOfMedium(view.keys[inFog.cell()]));
  const GuidedVertex onFloor(view, {{0.5f, 0.3f, 0}, {0, 0, 1}}, 1);
  ASSERT_TRUE(onFloor.isKnown());
  EXPECT_FALSE(CellGrid::isOfMedium(view.keys[onFloor.cell()]));
  // Without fog there is nothing of the kind.
  Frame clear(options);
  runFrame(clear, options, {});
  EXPECT_EQ(clear.vertexCounts().inMedia, 0u);
}

}  // namespace

}  // namespace odis::test
