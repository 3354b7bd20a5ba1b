// Time: how much is left, how many samples fit in it.
#include "eval/schedule.h"

#include <gtest/gtest.h>

#include "eval/equal_time.h"

using namespace odis::eval;

namespace {

TEST(Schedule, KnowsTheTimeLeftFromWhatWasDone) {
  Schedule schedule;
  schedule.plan("a", "path", 4);
  schedule.plan("a", "odis", 4);
  schedule.plan("b", "path", 8);
  EXPECT_EQ(schedule.outlook().total, 3);
  EXPECT_EQ(schedule.outlook().secondsLeft, 0);  // nothing is known
  // 0.5 s a sample: by the same scene and by the same method.
  schedule.finish("a", "path", 4, 2);
  EXPECT_EQ(schedule.outlook().done, 1);
  EXPECT_NEAR(schedule.outlook().secondsLeft, 4 * 0.5 + 8 * 0.5, 1e-12);
  // The method that is left is the one that takes 0.5.
  schedule.finish("a", "odis", 4, 6);
  EXPECT_NEAR(schedule.outlook().secondsLeft, 8 * 0.5, 1e-12);
  schedule.finish("b", "path", 8, 0);  // was found
  EXPECT_EQ(schedule.outlook().secondsLeft, 0);
  EXPECT_EQ(schedule.outlook().done, 3);
}

// By one sample, before anything of it is done.
TEST(Schedule, LearnsFromASample) {
  Schedule schedule;
  schedule.plan("a", "reference", 64);
  schedule.plan("b", "path", 4);
  EXPECT_TRUE(schedule.isPending("a"));
  EXPECT_FALSE(schedule.isPending("c"));
  schedule.learn("a", 0.5);
  EXPECT_NEAR(schedule.outlook().secondsLeft, 68 * 0.5, 1e-12);
  EXPECT_EQ(schedule.outlook().done, 0);
  schedule.finish("a", "reference", 64, 64);
  EXPECT_FALSE(schedule.isPending("a"));
}

TEST(EqualTime, FollowsTheLinesBetweenWhatWasMeasured) {
  // 1 s to begin with and 0.5 s a sample.
  const std::vector<TimePoint> guided{{4, 3}, {8, 5}, {16, 9}};
  EXPECT_EQ(samplesInTime(guided, 3), 4);
  EXPECT_EQ(samplesInTime(guided, 4), 6);
  EXPECT_EQ(samplesInTime(guided, 4.9), 7);  // what fits
  EXPECT_EQ(samplesInTime(guided, 9), 16);
  EXPECT_EQ(samplesInTime(guided, 17), 32);
  EXPECT_EQ(samplesInTime(guided, 2), 2);
  EXPECT_EQ(samplesInTime(guided, 0.5), 0);  // not one fits
}

TEST(EqualTime, IsProportionalWhereThereIsNoLine) {
  EXPECT_EQ(samplesInTime({{4, 2}}, 5), 10);
  EXPECT_EQ(samplesInTime({{4, 2}, {8, 1}}, 2), 16);  // noise
  EXPECT_EQ(samplesInTime({{4, 0}}, 2), 0);
}

}  // namespace
