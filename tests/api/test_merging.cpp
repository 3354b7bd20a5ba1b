// A farm: machines that save what their builders have gathered, and one that merges it.
#include "api/api_scene.h"
#include "frame/run_frame.h"
#include "support/models.h"
#include "support/temporary_folder.h"

namespace odis::test {
namespace {

const Float3 kFarmLower{-8, -8, -8}, kFarmUpper{8, 8, 8};

GuideBuilder farmBuilder(uint64_t id, const GuideOptions& options = {},
                         const Context& context = Context::shared()) {
  GuideBuilder builder(options, context);
  builder.setPartId(id);
  builder.setBounds(kFarmLower, kFarmUpper);
  return builder;
}

// What a machine's builder knows that renders an image of its own seed by a frame.
GuideBuilder trainedByFrame(uint64_t id) {
  FrameOptions options = toyOptions(24, 24, 4);
  options.seed = id;
  options.set("guided-cost=0");
  options.builder = farmBuilder(id, options.guide);
  Frame frame(options);
  EXPECT_TRUE(frame.beginPass());
  // Nobody takes from a builder that is about to learn.
  GuideBuilder other = farmBuilder(90);
  const OdisGuideBuilder learning = options.builder->get(), whole = other.get();
  EXPECT_FALSE(odisMergeGuideBuilders(whole, &learning, 1));
  EXPECT_EQ(takeError(), ODIS_ERROR_INVALID_OPERATION);
  EXPECT_FALSE(odisMergeGuideBuilders(learning, &whole, 1));
  EXPECT_EQ(takeError(), ODIS_ERROR_INVALID_OPERATION);
  EXPECT_FALSE(odisSetPartId(learning, 4));
  EXPECT_EQ(takeError(), ODIS_ERROR_INVALID_OPERATION);
  EXPECT_FALSE(odisSaveGuideBuilder(learning, "nowhere"));
  EXPECT_EQ(takeError(), ODIS_ERROR_INVALID_OPERATION);
  frame.endPass(true);
  Frame again(options);
  runFrame(again, options, {});
  return *options.builder;
}

TEST(MergedBuilders, OfFramesOfSeveralMachinesMakeOneGuide) {
  const TemporaryFolder folder;
  const auto pathOf = [&](uint64_t id) { return folder.path(std::to_string(id) + ".builder"); };
  const GuideOptions options = toyOptions(24, 24, 4).guide;
  std::vector<GuideBuilder> machines;
  GuideBuilder inMemory(options), fromFiles(options);
  for (const uint64_t id : {1, 2, 3}) {
    machines.push_back(trainedByFrame(id));
    machines.back().save(pathOf(id));
  }
  inMemory.merge(machines);
  for (const uint64_t id : {3, 1, 2}) fromFiles.merge({GuideBuilder::load(pathOf(id), options.model)});
  const Guide guide = inMemory.build();
  EXPECT_TRUE(sameBits(guide.view(), fromFiles.build().view()));
  // The frames have left what BSDF sampling fractions are chosen by, of pixels that have values.
  EXPECT_LT(guide.predictedVarianceRatio(), 1);
  const std::vector<float> values(24 * 24, 1.0f);
  EXPECT_NE(inMemory.build(values).predictedVarianceRatio(), guide.predictedVarianceRatio());
  // A frame learns on from what all machines know, and is no slower to converge than one that knows nothing.
  FrameOptions next = toyOptions(24, 24, 4);
  next.builder = inMemory;
  Frame frame(next);
  runFrame(frame, next, {});
  EXPECT_GT(frame.guide().view().cellCount, 0u);
  EXPECT_GT(inMemory.vertexCounts().accepted, fromFiles.vertexCounts().accepted);
}

TEST(MergedBuilders, AreRefusedWithAReason) {
  GuideOptions other;
  other.set("map-floor=0.1");
  GuideBuilder into = farmBuilder(1), different = farmBuilder(2, other), same = farmBuilder(1);
  for (GuideBuilder* builder : {&into, &different, &same}) builder->add(apiVertices());
  const auto refuse = [&](const GuideBuilder& builder, const std::string& part) {
    const OdisGuideBuilder handle = builder.get();
    std::string message;
    EXPECT_FALSE(odisMergeGuideBuilders(into.get(), &handle, 1));
    EXPECT_EQ(takeError(&message), ODIS_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  refuse(different, "odisMergeGuideBuilders: the builders differ in map-floor");
  refuse(same, "two parts have the id 1");
  refuse(into, "two parts have the id 1");
  GuideBuilder second = farmBuilder(2);
  second.add(apiVertices());
  into.merge({second});
  EXPECT_FALSE(odisSetPartId(into.get(), 2));
  EXPECT_EQ(takeError(), ODIS_ERROR_INVALID_ARGUMENT);
  const TemporaryFolder folder;
  into.save(folder.path("a"));
  EXPECT_EQ(odisLoadGuideBuilder(Context::shared().get(), folder.path("a").c_str(), formulas()), nullptr);
  std::string message;
  EXPECT_EQ(takeError(&message), ODIS_ERROR_FILE);
  EXPECT_NE(message.find("another model"), std::string::npos) << message;
}

TEST(MergedBuilders, KeepTheMemorysLimit) {
  std::vector<GuideBuilder> parts;
  for (const uint64_t id : {1, 2, 3, 4}) {
    parts.push_back(farmBuilder(id));
    parts.back().add(apiVertices());
  }
  ContextOptions options;
  options.memoryLimit = uint64_t(1) << 18;
  const Context context(options);
  GuideBuilder into = farmBuilder(9, {}, context);
  const OdisGuideBuilder first = parts[0].get();
  bool merged = odisMergeGuideBuilders(into.get(), &first, 1);
  for (size_t i = 1; merged && i < parts.size(); ++i) {
    const OdisGuideBuilder next = parts[i].get();
    merged = odisMergeGuideBuilders(into.get(), &next, 1);
  }
  EXPECT_FALSE(merged);
  EXPECT_EQ(takeError(), ODIS_ERROR_OUT_OF_MEMORY);
  EXPECT_LE(context.memoryUse(), options.memoryLimit);
}

}  // namespace
}  // namespace odis::test
