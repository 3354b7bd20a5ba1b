// Every function with NULL, in the wrong order, with numbers that can't be: an error, no crash.
#include <cstdlib>
#include <fstream>
#include <limits>
#include <new>
#include <regex>
#include <sstream>

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
  const OdisMediumEvent medium;
  const OdisEmissionEvent emission;
  const OdisLightEvent light;
  const OdisBounceEvent bounce;
  const OdisFloat3 grey{1, 1, 1};
  size_t count = 0;
  REFUSED(odisNewModel(nullptr));
  REFUSED(odisNewModelFromFile(nullptr, "x"));
  REFUSED(odisNewModelFromMemory(nullptr, "x", 1));
  REFUSED(odisNewRecorder(nullptr));
  REFUSED(odisBeginPath(nullptr, nullptr) != UINT32_MAX);
  REFUSED(odisRecordSurface(nullptr, 0, &surface));
  REFUSED(odisRecordMedium(nullptr, 0, &medium));
  REFUSED(odisRecordAttenuation(nullptr, 0, &grey));
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
  REFUSED(odisExtendFrame(nullptr, 8));
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
  REFUSED(odisAddVertices(nullptr, &vertices, false));
  REFUSED(odisBuildGuide(nullptr, nullptr, 0));
  REFUSED(odisSetPartId(nullptr, 1));
  REFUSED(odisMergeGuideBuilders(nullptr, nullptr, 0));
  REFUSED(odisSaveGuideBuilder(nullptr, "x"));
  REFUSED(odisLoadGuideBuilder(nullptr, "x", nullptr));
  REFUSED(odisLoadGuideBuilder(Context::shared().get(), nullptr, nullptr));
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
  REFUSED(odisRecordMedium(recorder.get(), recorder.begin({}), nullptr));
  REFUSED(odisRecordAttenuation(recorder.get(), recorder.begin({}), nullptr));
  REFUSED(odisFinishPaths(recorder.get(), nullptr));
  GuideBuilder builder({}, context);
  const OdisPathVertices none;
  REFUSED(odisAddVertices(builder.get(), nullptr, false));
  REFUSED(odisBuildGuide(builder.get(), nullptr, 1));
  REFUSED(odisMergeGuideBuilders(builder.get(), nullptr, 1));
  const OdisGuideBuilder nobody = nullptr;
  REFUSED(odisMergeGuideBuilders(builder.get(), &nobody, 1));
  REFUSED(odisSaveGuideBuilder(builder.get(), nullptr));
  EXPECT_TRUE(odisMergeGuideBuilders(builder.get(), nullptr, 0));
  REFUSED(odisRebuildGuide(builder.get(), nullptr));
  REFUSED(odisGetVertexCounts(builder.get(), nullptr));
  EXPECT_TRUE(odisAddVertices(builder.get(), &none, false));
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

TEST(ApiMisuse, WhatStandsForNothingIsHarmless) {
  odisRetainContext(nullptr);
  odisRetainModel(nullptr);
  odisRetainRecorder(nullptr);
  odisRetainFrame(nullptr);
  odisRetainGuideBuilder(nullptr);
  odisRetainGuide(nullptr);
  EXPECT_EQ(odisGetMemoryUse(nullptr), 0u);
  EXPECT_EQ(odisGetError(nullptr), ODIS_ERROR_NONE);
  EXPECT_STREQ(odisGetErrorName(OdisError(99)), "unknown error");
  EXPECT_EQ(odisGetVersion(), uint32_t(ODIS_VERSION));
  EXPECT_NE(std::string(odisGetVersionText()).find('.'), std::string::npos);
}

TEST(ApiMisuse, StructsOfAnotherSizeAreRefused) {
  ContextOptions context;
  OdisFrameOptions frame;
  OdisGuideOptions guide;
  OdisSurfaceEvent surface;
  OdisMediumEvent medium;
  OdisEmissionEvent emission;
  OdisLightEvent light;
  OdisBounceEvent bounce;
  OdisPathVertex vertex;
  OdisPathVertices vertices;
  for (const size_t size : {size_t(0), size_t(3), size_t(4096)}) {
    odisInitContextOptions(&context, size);
    REFUSED(false);
    odisInitFrameOptions(&frame, size);
    REFUSED(false);
    odisInitGuideOptions(&guide, size);
    REFUSED(false);
    odisInitSurfaceEvent(&surface, size);
    REFUSED(false);
    odisInitMediumEvent(&medium, size);
    REFUSED(false);
    odisInitEmissionEvent(&emission, size);
    REFUSED(false);
    odisInitLightEvent(&light, size);
    REFUSED(false);
    odisInitBounceEvent(&bounce, size);
    REFUSED(false);
    odisInitPathVertex(&vertex, size);
    REFUSED(false);
    odisInitPathVertices(&vertices, size);
    REFUSED(false);
    context.size = size;
    REFUSED(odisNewContext(&context));
  }
}

TEST(ApiMisuse, SettingsThatThereAreNotAreRefused) {
  OdisSetting setting;
  REFUSED(odisGetSetting(0, nullptr));
  REFUSED(odisGetSetting(odisGetSettingCount(), &setting));
  REFUSED(odisReadSetting("", nullptr));
  REFUSED(odisReadSetting(nullptr, "cels"));
  REFUSED(odisReadSetting("cells=-1", "refine"));
  REFUSED(odisReadSetting("cells", "cells"));
  EXPECT_STREQ(odisReadSetting(nullptr, "cells"), "32");
  setting.size = 3;
  REFUSED(odisGetSetting(0, &setting));
}

// All of the interface is tried in this file.
TEST(ApiMisuse, IsTriedOfEveryFunction) {
  const auto textOf = [](const std::string& path) {
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  };
  const std::string tests = textOf(ODIS_SOURCE "/tests/api/test_misuse.cpp"),
                    interface = textOf(ODIS_SOURCE "/src/odis/api/abi.txt");
  const std::regex functionLine("function [^(]*?(odis\\w+)\\(");
  int functions = 0;
  for (std::sregex_iterator i(interface.begin(), interface.end(), functionLine), end; i != end; ++i) {
    const std::string name = (*i)[1];
    EXPECT_NE(tests.find(name + "("), std::string::npos) << name;
    ++functions;
  }
  EXPECT_GT(functions, 80);
}

// What is asked of a vertex of which nothing is known.
void expectUnguided(OdisGuidedVertex* vertex) {
  const float uv[2] = {0.5f, 0.5f};
  float u = 0.25f;
  OdisFloat3 wi{0, 0, 1}, radiance;
  EXPECT_EQ(odisGetSurvivalProbability(vertex, 0.1f, 0.7f), 0.7f);
  odisGetStandIn(vertex, 0.5f, false, &radiance);
  odisGetStandIn(vertex, 0.5f, false, nullptr);
  EXPECT_EQ(luminance(radiance), 0);
  EXPECT_FALSE(odisGetCachedRadiance(vertex, 0, INFINITY, &radiance));
  EXPECT_EQ(odisDrawLightGroup(vertex, &u), ODIS_NO_LIGHT_GROUP);
  EXPECT_EQ(odisGetLightProbability(vertex, 0, 0.3f, 1), 0.3f);
  EXPECT_EQ(odisGetShadowRayProbability(vertex, 0.001f), 1);
  EXPECT_FALSE(odisPrepareVertex(vertex, 1, 1));
  EXPECT_FALSE(odisDrawsFromMap(vertex, &u));
  EXPECT_EQ(u, 0.25f);
  EXPECT_FALSE(odisSampleMap(vertex, uv, &wi));
  EXPECT_EQ(odisGetMapPdf(vertex, &wi), 0);
  EXPECT_EQ(odisGetDirectionPdf(vertex, &wi, 0.2f, 0.2f), 0.2f);
}

TEST(ApiMisuse, LookUpsWithoutAGuideAnswerThatThereIsNone) {
  const OdisPlace place;
  const OdisGuideView empty;
  OdisGuidedVertex vertex;
  expectUnguided(nullptr);
  expectUnguided(&vertex);  // all zeros
  for (const OdisGuideView* view : {static_cast<const OdisGuideView*>(nullptr), &empty}) {
    EXPECT_FALSE(odisLookUp(view, &place, 1, &vertex));
    expectUnguided(&vertex);
  }
  EXPECT_FALSE(odisLookUp(&empty, nullptr, 1, &vertex));
  EXPECT_FALSE(odisLookUp(&empty, &place, 1, nullptr));
}

// Where there is a guide: what is left out, and what is no direction.
TEST(ApiMisuse, LookUpsRefuseWhatIsMissing) {
  GuideBuilder builder;
  builder.add(apiVertices());
  const Guide guide = builder.build();
  const GuideView view = guide.view();
  const OdisPathVertex& v = apiVertices().front();
  OdisPlace place{v.position, v.normal};
  OdisGuidedVertex vertex;
  ASSERT_TRUE(odisLookUp(&view, &place, 1, &vertex));
  ASSERT_TRUE(odisPrepareVertex(&vertex, 1, 1));
  const float uv[2] = {0.5f, 0.5f};
  OdisFloat3 wi;
  EXPECT_TRUE(odisSampleMap(&vertex, uv, &wi));
  EXPECT_GT(odisGetMapPdf(&vertex, &wi), 0);
  EXPECT_FALSE(odisSampleMap(&vertex, nullptr, &wi));
  EXPECT_FALSE(odisSampleMap(&vertex, uv, nullptr));
  EXPECT_EQ(odisDrawLightGroup(&vertex, nullptr), ODIS_NO_LIGHT_GROUP);
  EXPECT_FALSE(odisDrawsFromMap(&vertex, nullptr));
  EXPECT_FALSE(odisGetCachedRadiance(&vertex, 1, 1, nullptr));
  EXPECT_EQ(odisGetMapPdf(&vertex, nullptr), 0);
  EXPECT_EQ(odisGetDirectionPdf(&vertex, nullptr, 1, 1), 0);
  for (const OdisFloat3& nowhere : {OdisFloat3{NAN, 0, 1}, OdisFloat3{0, -INFINITY, 0}}) {
    EXPECT_EQ(odisGetMapPdf(&vertex, &nowhere), 0);
    EXPECT_EQ(odisGetDirectionPdf(&vertex, &nowhere, 1, 1), 0);
  }
  place.discrete = true;
  EXPECT_FALSE(odisLookUp(&view, &place, 1, &vertex)) << "mirrors have no cell";
  EXPECT_EQ(odisGetSurvivalProbability(&vertex, 0.1f, 0.7f), 1) << "no cell, but not the host's roulette";
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
  for (const float factor : {-0.5f, INFINITY, NAN}) {
    const OdisFloat3 attenuation{1, factor, 1};
    REFUSED(odisRecordAttenuation(recorder.get(), path, &attenuation));
  }
  OdisMediumEvent medium;
  medium.distance = -1;
  REFUSED(odisRecordMedium(recorder.get(), path, &medium));
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
  refuses([](Options& o, Guides&) { o.mostSamplesPerPixel = o.samplesPerPixel - 1; });
  refuses([](Options& o, Guides&) { o.settings = "pilot-weight=nan"; });
  refuses([](Options& o, Guides&) { o.settings = "pilot-spp=inf"; });
  refuses([](Options& o, Guides&) { o.settings = "built-cell-cost=-1"; });
  refuses([](Options& o, Guides&) { o.settings = "recorded-ray-cost=1e999"; });
  refuses([](Options&, Guides& g) { g.size = 1; });
  refuses([](Options&, Guides& g) { g.settings = "map-clamp=0"; });
  refuses([](Options&, Guides& g) { g.settings = "cells=-3"; });
  refuses([](Options&, Guides& g) { g.settings = "prior-samples=1:1:nan:1"; });
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
  const Guide guide = builder.build();
  const GuideView view = guide.view();
  ASSERT_GT(view.cellCount, 0u);
  const OdisFloat3 up{0, 0, 1};
  for (uint32_t cell = 0; cell < view.cellCount; ++cell) {
    const SamplingMap<float>::Sample sample = SamplingMap<float>(view.maps, int32_t(cell)).sample(0.3f, 0.6f);
    EXPECT_GT(sample.pdf, 0);
    EXPECT_LT(sample.pdf, INFINITY);
    const OdisCellDecisions& d = view.decisions[cell];
    EXPECT_TRUE(std::isfinite(d.bsdfFraction[0] + d.outgoingRadiance.x));
    EXPECT_FALSE(std::isnan(d.survivalFactor));
  }
}

}  // namespace
}  // namespace odis::test
