// Every function with NULL, in the wrong order, with numbers that can't be: an error, no crash.
#include <cstdlib>
#include <limits>
#include <new>

#include "api/api_scene.h"

namespace odis::test {
namespace {

// Each call must fail with this code, and leave no error for the next one.
struct Refusal {
  OdisError code = ODIS_ERROR_INVALID_ARGUMENT;
  int line = 0;
  void operator()(bool succeeded) const {
    EXPECT_FALSE(succeeded) << "line " << line;
    EXPECT_EQ(takeError(), code) << "line " << line;
  }
};
#define REFUSED (Refusal{ODIS_ERROR_INVALID_ARGUMENT, __LINE__})
#define OUT_OF_ORDER (Refusal{ODIS_ERROR_INVALID_OPERATION, __LINE__})

TEST(ApiMisuse, NullIsAnError) {
  OdisFramePass pass;
  OdisPixelMean mean;
  OdisFrameStatistics statistics;
  OdisVertexCounts counts;
  OdisGuideView view;
  const OdisPathVertices vertices;
  const OdisSurfaceEvent surface;
  const OdisEmissionEvent emission;
  const OdisLightEvent light;
  const OdisBounceEvent bounce;
  const OdisFloat3 grey{1, 1, 1};
  size_t count = 0;
  REFUSED(odisNewModel(nullptr));
  REFUSED(odisNewModelFromFile(nullptr, "x"));
  REFUSED(odisNewModelFromMemory(nullptr, "x", 1));
  REFUSED(odisNewModelWithFormulas(nullptr, true, true));
  REFUSED(odisNewRecorder(nullptr));
  REFUSED(odisBeginPath(nullptr, nullptr) != UINT32_MAX);
  REFUSED(odisRecordSurface(nullptr, 0, &surface));
  REFUSED(odisRecordEscape(nullptr, 0));
  REFUSED(odisRecordEmission(nullptr, 0, &emission));
  REFUSED(odisRecordSurvival(nullptr, 0, 1));
  REFUSED(odisRecordCachedRadiance(nullptr, 0, &grey));
  REFUSED(odisRecordLight(nullptr, 0, &light));
  REFUSED(odisRecordLightHidden(nullptr, 0));
  REFUSED(odisRecordBounce(nullptr, 0, &bounce));
  REFUSED(odisFinishPaths(nullptr, &count));
  REFUSED(odisNewFrame(nullptr, nullptr));
  REFUSED(odisBeginPass(nullptr, &pass));
  REFUSED(odisGetSamples(nullptr, 0, nullptr));
  REFUSED(odisWantsVertices(nullptr, 0));
  REFUSED(odisGetPixelValues(nullptr));
  REFUSED(odisAddSamples(nullptr, nullptr, 0, &vertices));
  REFUSED(odisEndPass(nullptr, false));
  REFUSED(odisStartEndPass(nullptr, false));
  REFUSED(odisWaitForPass(nullptr));
  REFUSED(odisGuideIsFinal(nullptr));
  REFUSED(odisGetSampleWeight(nullptr, 0, 0) != 0);
  REFUSED(odisGetPixelMean(nullptr, 0, &mean));
  REFUSED(odisGetSampleCount(nullptr, 0));
  REFUSED(odisGetFrameStatistics(nullptr, &statistics));
  REFUSED(odisGetFrameVertexCounts(nullptr, &counts));
  REFUSED(odisGetFrameGuide(nullptr));
  REFUSED(odisGetPilotImage(nullptr));
  REFUSED(odisGetPilotVertices(nullptr, nullptr, 0));
  REFUSED(odisNewGuideBuilder(nullptr, nullptr));
  REFUSED(odisAddVertices(nullptr, &vertices));
  REFUSED(odisBuildGuide(nullptr, &vertices, nullptr, 0));
  REFUSED(odisRebuildGuide(nullptr, nullptr));
  REFUSED(odisFadeVertices(nullptr, 1));
  REFUSED(odisForgetVertices(nullptr));
  REFUSED(odisSetBounds(nullptr, nullptr, nullptr));
  REFUSED(odisGetVertexCounts(nullptr, &counts));
  REFUSED(odisGetGuideBuilderBytes(nullptr));
  REFUSED(odisGetGuideBytes(nullptr));
  REFUSED(odisGetPredictedVarianceRatio(nullptr) != 1);
  REFUSED(odisGetGuideView(nullptr, &view));
  REFUSED(odisSaveFrame(nullptr, "x"));
  REFUSED(odisLoadFrame(nullptr, "x", nullptr));
  REFUSED(odisSetFrameHostData(nullptr, "x", 1));
  REFUSED(odisGetFrameHostData(nullptr, &count));
  REFUSED(odisSetFrameProgress(nullptr, nullptr, nullptr));
  REFUSED(odisSaveGuide(nullptr, "x"));
  REFUSED(odisLoadGuide(nullptr, "x"));
  REFUSED(odisSaveVertices(nullptr, "x"));
  REFUSED(odisLoadVertices(nullptr, nullptr, 0));
  odisInitFrameOptions(nullptr, sizeof(OdisFrameOptions));
  REFUSED(false);
  odisDescribeVertices(nullptr, nullptr, 0);
  REFUSED(false);
}

TEST(ApiMisuse, NullArgumentsOfObjectsAreErrors) {
  const Context context;
  REFUSED(odisNewModelFromFile(context.get(), nullptr));
  REFUSED(odisNewModelFromMemory(context.get(), nullptr, 5));
  REFUSED(odisNewFrame(context.get(), nullptr));
  FrameOptions options;
  options.width = options.height = 4;
  Frame frame(options, context);
  REFUSED(odisBeginPass(frame.get(), nullptr));
  REFUSED(odisGetSamples(frame.get(), 0, nullptr));
  frame.beginPass();
  REFUSED(odisAddSamples(frame.get(), nullptr, 3, nullptr));
  REFUSED(odisGetPixelMean(frame.get(), 0, nullptr));
  REFUSED(odisGetFrameStatistics(frame.get(), nullptr));
  REFUSED(odisGetFrameVertexCounts(frame.get(), nullptr));
  PathRecorder recorder(context);
  REFUSED(odisBeginPath(recorder.get(), nullptr) != UINT32_MAX);
  REFUSED(odisRecordSurface(recorder.get(), recorder.begin({}), nullptr));
  REFUSED(odisFinishPaths(recorder.get(), nullptr));
  GuideBuilder builder({}, context);
  const OdisPathVertices none;
  REFUSED(odisAddVertices(builder.get(), nullptr));
  REFUSED(odisBuildGuide(builder.get(), nullptr, nullptr, 0));
  REFUSED(odisRebuildGuide(builder.get(), nullptr));
  REFUSED(odisGetVertexCounts(builder.get(), nullptr));
  EXPECT_TRUE(odisAddVertices(builder.get(), &none));
  REFUSED(odisSetBounds(builder.get(), nullptr, nullptr));
  REFUSED(odisSaveFrame(frame.get(), nullptr));
  REFUSED(odisSetFrameHostData(frame.get(), nullptr, 3));
  REFUSED(odisGetFrameHostData(frame.get(), nullptr));
  REFUSED(odisLoadFrame(context.get(), nullptr, nullptr));
  REFUSED(odisLoadGuide(context.get(), nullptr));
  REFUSED(odisSaveVertices(&none, nullptr));
  // Releasing nothing is fine, as free() of nothing is.
  odisReleaseContext(nullptr);
  odisReleaseModel(nullptr);
  odisReleaseRecorder(nullptr);
  odisReleaseFrame(nullptr);
  odisReleaseGuideBuilder(nullptr);
  odisReleaseGuide(nullptr);
  EXPECT_EQ(takeError(), ODIS_ERROR_NONE);
}

TEST(ApiMisuse, LookUpsWithoutAGuideAnswerThatThereIsNone) {
  const OdisPlace place;
  const OdisFloat3 up{0, 0, 1};
  const float uv[2] = {0.5f, 0.5f};
  OdisMapSample sample;
  OdisFloat3 radiance;
  const float* cdf = uv;
  const OdisGuideView empty;
  for (const OdisGuideView* view : {static_cast<const OdisGuideView*>(nullptr), &empty}) {
    EXPECT_EQ(odisFindCell(view, &place), ODIS_NO_CELL);
    EXPECT_EQ(odisGetBsdfFraction(view, 0, 1), 1);
    EXPECT_FALSE(odisSampleMap(view, 0, &up, false, uv, &sample));
    EXPECT_EQ(odisGetMapPdf(view, 0, &up, false, &up), 0);
    EXPECT_EQ(odisGetSurvivalProbability(view, 0, 0.1f), 1);
    EXPECT_EQ(odisGetSurvivalProbability(view, ODIS_NO_CELL, 0.1f, 31), 1);
    EXPECT_EQ(odisGetSurvivalProbability(view, ODIS_NO_CELL, 0.1f, 32), 0.95f);
    EXPECT_FALSE(odisGetCachedRadiance(view, &place, 0, 0, INFINITY, &radiance));
    EXPECT_EQ(odisGetLearnedLights(view, 0, &cdf), 0);
    EXPECT_EQ(cdf, nullptr);
  }
  EXPECT_EQ(odisGetShadowRayProbability(nullptr, 0.001f), 1);
}

TEST(ApiMisuse, TheOrderOfEventsIsChecked) {
  PathRecorder recorder;
  const OdisBounceEvent bounce;
  const OdisLightEvent light;
  const uint32_t path = recorder.begin({});
  const OdisFloat3 radiance;
  OUT_OF_ORDER(odisRecordBounce(recorder.get(), path, &bounce));
  OUT_OF_ORDER(odisRecordCachedRadiance(recorder.get(), path, &radiance));
  OUT_OF_ORDER(odisRecordLight(recorder.get(), path, &light));
  OUT_OF_ORDER(odisRecordLightHidden(recorder.get(), path));
  REFUSED(odisRecordEscape(recorder.get(), path + 1));
  recorder.finish();
  REFUSED(odisRecordEscape(recorder.get(), path));
}

TEST(ApiMisuse, APassOnItsWayIsWaitedFor) {
  FrameOptions options;
  options.width = options.height = 16;
  Frame frame(options);
  OUT_OF_ORDER(odisWaitForPass(frame.get()));
  ASSERT_TRUE(frame.beginPass());
  EXPECT_TRUE(odisStartEndPass(frame.get(), true));
  OdisFramePass pass;
  OUT_OF_ORDER(odisBeginPass(frame.get(), &pass));
  OUT_OF_ORDER(odisStartEndPass(frame.get(), false));
  OUT_OF_ORDER(odisGetSampleCount(frame.get(), 0));
  EXPECT_TRUE(odisWaitForPass(frame.get()));
  EXPECT_FALSE(odisBeginPass(frame.get(), &pass));
  EXPECT_EQ(takeError(), ODIS_ERROR_NONE) << "a frame that is done is no error";
  // A frame that is let go of while a pass ends.
  Frame other(options);
  other.beginPass();
  other.startEndPass(true);
}

TEST(ApiMisuse, NumbersThatCannotBeAreRefused) {
  const Context context;
  const auto refuses = [&](auto spoil) {
    OdisFrameOptions options;
    options.width = options.height = 4;
    OdisGuideOptions guide;
    options.guide = &guide;
    spoil(options, guide);
    const OdisFrame frame = odisNewFrame(context.get(), &options);
    EXPECT_EQ(frame, nullptr);
    EXPECT_EQ(takeError(), ODIS_ERROR_INVALID_ARGUMENT);
    odisReleaseFrame(frame);
  };
  using Options = OdisFrameOptions;
  using Guides = OdisGuideOptions;
  refuses([](Options& o, Guides&) { o.width = 0; });
  refuses([](Options& o, Guides&) { o.width = o.height = UINT32_MAX; });
  refuses([](Options& o, Guides&) { o.size = 0; });
  refuses([](Options& o, Guides&) { o.pilotWeight = NAN; });
  refuses([](Options& o, Guides&) { o.pilotSamplesPerPixel = INFINITY; });
  refuses([](Options& o, Guides&) { o.builtCellCost = -1; });
  refuses([](Options& o, Guides&) { o.recordedRayCost = INFINITY; });
  refuses([](Options&, Guides& g) { g.size = 1; });
  refuses([](Options&, Guides& g) { g.clamp = 0; });
  refuses([](Options&, Guides& g) { g.cellsPerDiagonal = -3; });
  refuses([](Options&, Guides& g) { g.priorSamples[2] = NAN; });
  refuses([](Options&, Guides& g) { g.lightPartCount = 2; });
  refuses([](Options&, Guides& g) {
    static const OdisLightParts beyond{1, 2};
    g.lightGroups = 2;
    g.lightParts = &beyond;
    g.lightPartCount = 1;
  });
}

// What is not a number in any field of vertices ends in a guide whose densities are numbers.
TEST(ApiMisuse, SpoiledVerticesLeaveAGuideOfNumbers) {
  const float spoiled[] = {NAN,
                           INFINITY,
                           -INFINITY,
                           -1,
                           0,
                           std::numeric_limits<float>::denorm_min(),
                           std::numeric_limits<float>::max()};
  std::vector<OdisPathVertex> vertices = apiVertices();
  for (size_t i = 0; i < vertices.size(); i += 3) {
    float values[44];
    std::memcpy(values, &vertices[i], sizeof values);
    values[i / 3 % 44] = spoiled[i / 3 / 44 % std::size(spoiled)];
    std::memcpy(static_cast<void*>(&vertices[i]), values, sizeof values);
    vertices[i].pixel = 0;
  }
  GuideBuilder builder;
  builder.add(vertices);
  const Guide guide = builder.build(vertices);
  const GuideView view = guide.view();
  ASSERT_GT(view.cellCount, 0u);
  const OdisFloat3 up{0, 0, 1};
  for (uint32_t cell = 0; cell < view.cellCount; ++cell) {
    const float uv[2] = {0.3f, 0.6f};
    OdisMapSample sample;
    ASSERT_TRUE(odisSampleMap(&view, cell, &up, true, uv, &sample));
    for (const OdisFloat3& nowhere : {OdisFloat3{NAN, 0, 1}, OdisFloat3{0, -INFINITY, 0}})
      EXPECT_EQ(odisGetMapPdf(&view, cell, &up, true, &nowhere), 0);
    EXPECT_GT(sample.pdf, 0);
    EXPECT_LT(sample.pdf, INFINITY);
    const OdisCellDecisions& d = view.decisions[cell];
    EXPECT_TRUE(std::isfinite(d.bsdfFraction[0] + d.outgoingRadiance.x));
    EXPECT_FALSE(std::isnan(d.survivalFactor));
  }
}

}  // namespace
}  // namespace odis::test
