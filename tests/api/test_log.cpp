// What ODIS_LOG_INFO tells of frames.
#include "api/api_scene.h"
#include "api/listening.h"
#include "frame/run_frame.h"

namespace odis::test {
namespace {

TEST(ApiLog, TellsOfTheGuidesOfAFrameAndHowItFared) {
  Heard heard;
  ContextOptions context = heardBy(heard);
  context.logLevel = ODIS_LOG_INFO;
  FrameOptions options = toyOptions(40, 40, 8);
  Frame frame(options, Context(context));
  runFrame(frame, options, {});
  const FrameStatistics statistics = frame.statistics();
  EXPECT_GT(statistics.guidesBuilt, 1u);
  EXPECT_LT(statistics.predictedVarianceRatio, 1);
  EXPECT_GT(statistics.predictedVarianceRatio, 0);
  EXPECT_FALSE(statistics.guidingGivenUp);
  EXPECT_EQ(heard.count("a guide of"), long(statistics.guidesBuilt));
  EXPECT_EQ(heard.count("a guide of " + std::to_string(statistics.cells) + " cells"), 1);
  ASSERT_FALSE(heard.messages.empty());
  const std::string& last = heard.messages.back();
  EXPECT_EQ(heard.count("the frame has ended"), 1);
  for (const std::string& part :
       {"ended with " + std::to_string(statistics.samples) + " samples",
        std::to_string(frame.vertexCounts().accepted) + " vertices were taken", std::string("are predicted")})
    EXPECT_NE(last.find(part), std::string::npos) << last;
  EXPECT_FALSE(frame.beginPass());
  const Guide guide = frame.guide();
  EXPECT_EQ(&heard.messages.back(), &last) << "a handle to a guide builds none";
}

TEST(ApiLog, TellsWhyGuidingIsGivenUp) {
  Heard heard;
  ContextOptions context = heardBy(heard);
  context.logLevel = ODIS_LOG_INFO;
  FrameOptions options = toyOptions(64, 64, 6);
  options.set("guided-cost=50");
  Frame frame(options, Context(context));
  runFrame(frame, options, {});
  const FrameStatistics statistics = frame.statistics();
  EXPECT_TRUE(statistics.guidingGivenUp);
  EXPECT_GT(statistics.measuredCostRatio, 1);
  EXPECT_EQ(heard.count("guiding is given up"), 1);
  EXPECT_NE(heard.messages.back().find("guiding was given up"), std::string::npos) << heard.messages.back();
}

TEST(ApiLog, AnInterruptedFrameEndsToo) {
  Heard heard;
  ContextOptions context = heardBy(heard);
  context.logLevel = ODIS_LOG_INFO;
  FrameOptions options = toyOptions(16, 16, 2);
  Frame frame(options, Context(context));
  runPass(frame, *frame.beginPass(), ToyHost({}, 16, 16), 100);
  frame.endPass(true);
  EXPECT_EQ(heard.count("the frame has ended with 100 samples; no guide was built"), 1);
}

}  // namespace
}  // namespace odis::test
