// Medians, ratios, intervals, means and tables of measurements that are made up.
#include "eval/summary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "eval/comparison_json.h"
#include "eval/markdown.h"
#include "eval/median.h"

using namespace odis::eval;

namespace {

Measurement run(const char* scene, const char* method, int spp, uint64_t seed, double error,
                double seconds = 1, uint64_t rays = 100) {
  Measurement m;
  m.scene = scene;
  m.method = method;
  m.spp = spp;
  m.samples = spp;
  m.seed = seed;
  m.error.trimmedRelMse = error;
  m.cpuSeconds = seconds;
  m.seconds = 7;  // of a busy machine: nothing is told by them
  m.rays = rays;
  return m;
}

TEST(Summary, TakesMediansRatiosAndGeometricMeans) {
  const std::vector<ComparisonRow> rows = summarize({
      run("a", "path", 4, 0, 1.0, 2),
      run("a", "odis", 4, 0, 0.5, 3),
      run("a", "path", 4, 1, 9.0, 2),
      run("a", "odis", 4, 1, 0.9, 3),
      run("a", "path", 4, 2, 2.0, 2),
      run("a", "odis", 4, 2, 0.1, 3),
      run("b", "path", 4, 0, 4.0, 1, 50),
      run("b", "odis", 4, 0, 4.0, 1, 200),
  });
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_EQ(rows[0].error.trimmedRelMse, 2.0);
  EXPECT_EQ(rows[0].errorRatio.value, 1.0);
  EXPECT_EQ(rows[1].error.trimmedRelMse, 0.5);
  EXPECT_EQ(rows[1].seeds, 3);
  EXPECT_NEAR(rows[1].errorRatio.value, 0.25, 1e-12);
  EXPECT_NEAR(rows[1].cpuSecondsRatio, 1.5, 1e-12);
  EXPECT_NEAR(rows[1].errorTimeRatio.value, 0.25 * 1.5, 1e-12);
  EXPECT_NEAR(rows[3].raysRatio, 4.0, 1e-12);
  EXPECT_NEAR(rows[3].errorRaysRatio.value, 4.0, 1e-12);
  EXPECT_TRUE(rows[5].isMean());
  EXPECT_EQ(rows[5].method, "odis");
  EXPECT_NEAR(rows[5].errorRatio.value, std::sqrt(0.25 * 1.0), 1e-12);
  EXPECT_NEAR(rows[5].errorRaysRatio.value, std::sqrt(0.25 * 4.0), 1e-12);
  EXPECT_NEAR(rows[5].raysRatio, std::sqrt(1.0 * 4.0), 1e-12);
  EXPECT_NEAR(rows[5].cpuSecondsRatio, std::sqrt(1.5 * 1.0), 1e-12);
}

// One firefly in three seeds leaves medians as they are, but not what is said to be untrimmed; means of
// images are over seeds, too.
TEST(Summary, ShowsFirefliesAndMeans) {
  std::vector<Measurement> measurements;
  for (uint64_t seed = 0; seed < 3; ++seed)
    for (const char* method : {"path", "odis"}) {
      measurements.push_back(run("a", method, 4, seed, 1));
      const bool odis = method[0] == 'o';
      measurements.back().error.relMse = odis && seed == 1 ? 28 : 1;
      measurements.back().error.mean = odis ? 0.9 + 0.1 * double(seed) : 1;
    }
  const std::vector<ComparisonRow> rows = summarize(measurements);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1].errorRatio.value, 1);
  EXPECT_NEAR(rows[1].untrimmedRatio.value, 10, 1e-12);
  EXPECT_NEAR(rows[1].untrimmedRatio.low, 1, 1e-12);
  EXPECT_NEAR(rows[1].untrimmedRatio.high, 28, 1e-12);  // one resample in 27 has it three times
  EXPECT_NEAR(rows[1].mean.value, 1, 1e-12);
  // Three values, 0.1 apart: 4.303 * 0.1 / sqrt(3).
  EXPECT_NEAR(rows[1].mean.high, 1.2484, 1e-4);
  EXPECT_NEAR(rows[1].mean.low, 0.7516, 1e-4);
  EXPECT_EQ(rows[0].mean.low, rows[0].mean.high);
  SceneRecord scene;
  scene.name = "a";
  EXPECT_NE(markdownTables(rows, {scene}).find("| 1.000 [0.752, 1.248] |"), std::string::npos);
  EXPECT_NE(markdownTables(rows, {scene}).find("| 10.000 [1.000, 28.000] |"), std::string::npos);
}

TEST(Bootstrap, FewNumbersMakeWideIntervals) {
  EXPECT_EQ(meanWithInterval({2}).low, meanWithInterval({2}).high);
  EXPECT_NEAR(meanWithInterval({1, 3}).high, 2 + 12.706, 1e-9);
  const Interval twelve = meanWithInterval({0, 2, 0, 2, 0, 2, 0, 2, 0, 2, 0, 2});
  EXPECT_NEAR(twelve.high, 1 + 2.201 * std::sqrt(12.0 / 11 / 12), 0.01);
}

// Ratios at equal time are to the first method at the number of samples whose time it was.
TEST(Summary, KeepsSamplesAndEqualTimeApart) {
  Measurement timed = run("a", "odis", 16, 0, 0.3);
  timed.equalTime = true;
  timed.samples = 12;
  const std::vector<ComparisonRow> rows =
      summarize({run("a", "path", 4, 0, 2), run("a", "odis", 4, 0, 1), run("a", "path", 16, 0, 0.5),
                 run("a", "odis", 16, 0, 0.25), timed});
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_NEAR(rows[1].errorRatio.value, 0.5, 1e-12);
  EXPECT_TRUE(rows[4].equalTime);
  EXPECT_EQ(rows[4].samples, 12);
  EXPECT_NEAR(rows[4].errorRatio.value, 0.6, 1e-12);
  // path: 2 at 4 samples, 0.5 at 16, so error 1 at 8.
  EXPECT_NEAR(rows[1].needed.samples, 8, 1e-9);
  EXPECT_EQ(rows[3].needed.where, SamplesNeeded::beyond);
}

TEST(Summary, LeavesOutMeansOverSomeScenesOnly) {
  const std::vector<ComparisonRow> rows =
      summarize({run("a", "path", 4, 0, 2), run("a", "odis", 4, 0, 1), run("b", "path", 4, 0, 2)});
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[3].method, "path");
  EXPECT_TRUE(summarize({}).empty());
}

TEST(SamplesNeeded, FollowsTheCurveInLogarithms) {
  // Error 1 / n: n samples for an error of 1 / n.
  std::vector<CurvePoint> curve;
  for (const double n : {4.0, 8.0, 16.0, 64.0}) curve.push_back({n, 1 / n});
  for (const double n : {4.0, 5.0, 16.0, 23.4, 64.0}) {
    const SamplesNeeded needed = samplesNeeded(curve, 1 / n);
    EXPECT_EQ(needed.where, SamplesNeeded::within) << n;
    EXPECT_NEAR(needed.samples, n, 1e-9) << n;
  }
  EXPECT_EQ(samplesNeeded(curve, 1 / 65.0).where, SamplesNeeded::beyond);
  EXPECT_EQ(samplesNeeded(curve, 1 / 65.0).samples, 64);
  EXPECT_EQ(samplesNeeded(curve, 1 / 3.0).where, SamplesNeeded::below);
  EXPECT_EQ(samplesNeeded(curve, 1 / 3.0).samples, 4);
}

// Denoised images are compared with denoised ones of the first method only, and have a curve of their own.
TEST(Summary, KeepsDenoisedApart) {
  std::vector<Measurement> measurements;
  for (const bool denoised : {false, true})
    for (const int spp : {4, 16})
      for (const char* method : {"path", "odis"}) {
        const double error = (denoised ? 0.1 : 1.0) * 4 / spp * (method[0] == 'o' ? 0.5 : 1);
        measurements.push_back(run("a", method, spp, 0, denoised ? std::sqrt(error) : error));
        measurements.back().denoised = denoised;
      }
  const std::vector<ComparisonRow> rows = summarize(measurements);
  ASSERT_EQ(rows.size(), 8u);
  EXPECT_FALSE(rows[1].denoised);
  EXPECT_NEAR(rows[1].errorRatio.value, 0.5, 1e-12);
  EXPECT_NEAR(rows[1].needed.samples, 8, 1e-9);
  EXPECT_TRUE(rows[5].denoised);
  EXPECT_NEAR(rows[5].errorRatio.value, std::sqrt(0.5), 1e-12);
  EXPECT_EQ(rows[5].needed.where, SamplesNeeded::within);
  EXPECT_NEAR(rows[5].needed.samples, 8, 1e-9);
  SceneRecord scene;
  scene.name = "a";
  const std::string text = markdownTables(rows, {scene});
  EXPECT_LT(text.find("0.500"), text.find("The same images denoised:"));
  EXPECT_NE(text.find("0.707", text.find("The same images denoised:")), std::string::npos) << text;
}

// Where noise lets the curve rise again, its first way down counts.
TEST(SamplesNeeded, TakesTheLeastOfSeveral) {
  const std::vector<CurvePoint> curve{{1, 1}, {4, 0.25}, {16, 0.5}, {64, 0.1}};
  EXPECT_NEAR(samplesNeeded(curve, 0.5).samples, 2, 1e-9);
  EXPECT_EQ(samplesNeeded({{4, 1}}, 0.5).where, SamplesNeeded::unknown);
  EXPECT_EQ(samplesNeeded(curve, 0).where, SamplesNeeded::unknown);
  EXPECT_EQ(samplesNeeded(curve, INFINITY).where, SamplesNeeded::unknown);
}

// Of two seeds with ratios 1 and 3 (over 1) the resampled medians are 1, 2 or 3 with probability 1/4, 1/2,
// 1/4.
TEST(Bootstrap, DrawsSeedsWithReplacement) {
  const std::vector<double> ratios = resampledRatios({1, 3}, {1, 1}, 7, median);
  int counts[4] = {};
  for (const double ratio : ratios) ++counts[int(ratio)];
  ASSERT_EQ(counts[1] + counts[2] + counts[3], kResamples);
  const double deviation = std::sqrt(kResamples * 0.25 * 0.75);
  EXPECT_NEAR(counts[1], kResamples * 0.25, 4 * deviation);
  EXPECT_NEAR(counts[3], kResamples * 0.25, 4 * deviation);
  const Interval interval = intervalOf(2, ratios);
  EXPECT_EQ(interval.value, 2);
  EXPECT_EQ(interval.low, 1);
  EXPECT_EQ(interval.high, 3);
  EXPECT_EQ(resampledRatios({1, 3}, {1, 1}, 7, median), ratios);  // the same draws again
}

// Noise that both share is no reason for doubt.
TEST(Bootstrap, DrawsBothMethodsTogether) {
  const std::vector<double> a{1, 2, 3, 4, 5}, b{2, 4, 6, 8, 10};
  for (const double ratio : resampledRatios(a, b, 1, median)) EXPECT_EQ(ratio, 0.5);
}

// 0, 1, ..., 1000: the middle 95 % are 25 to 975.
TEST(Bootstrap, IntervalIsOfPercentiles) {
  std::vector<double> values;
  for (int i = 1000; i >= 0; --i) values.push_back(i);
  const Interval interval = intervalOf(500, values);
  EXPECT_EQ(interval.low, 25);
  EXPECT_EQ(interval.high, 975);
}

TEST(Markdown, IsATableThatLinesUp) {
  std::vector<Measurement> measurements{run("room", "path", 4, 0, 0.125, 1, 2000000),
                                        run("room", "odis", 4, 0, 0.0625, 1, 2000000)};
  measurements[1].equalTime = true;
  measurements[1].samples = 3;
  SceneRecord scene;
  scene.name = "room";
  scene.referenceError = ReferenceError{0.01, 0.00625};
  const std::string text = markdownTables(summarize(measurements), {scene});
  EXPECT_NE(text.find("| room  | path   |              4 |  0.125 |"), std::string::npos) << text;
  EXPECT_NE(text.find("| 3 in time of 4 |"), std::string::npos) << text;
  EXPECT_NE(text.find("0.500"), std::string::npos) << text;
  EXPECT_NE(text.find("10.0 %"), std::string::npos) << text;  // of the smallest error is the reference's
  scene.referenceError.reset();
  EXPECT_NE(markdownTables(summarize(measurements), {scene}).find("not known"), std::string::npos);
  EXPECT_NE(markdownTables(summarize({}), {}).find("scene"), std::string::npos);
}

// Whatever the names and the figures are, what is printed fits a terminal.
TEST(Markdown, IsNarrow) {
  std::vector<Measurement> measurements;
  const std::string longName(60, 'n');
  for (const std::string& scene : {std::string("breakfast-room"), longName})
    for (uint64_t seed = 0; seed < 3; ++seed)
      for (const std::string& method : {std::string("path"), longName})
        for (const bool equalTime : {false, true}) {
          if (equalTime && method == "path") continue;
          Measurement m = run(scene.c_str(), method.c_str(), 16384, seed,
                              0.000123456 * double(1 + seed * seed), 12345.678);
          m.equalTime = equalTime;
          measurements.push_back(m);
        }
  std::vector<SceneRecord> scenes(2);
  scenes[0].name = "breakfast-room";
  scenes[1].name = longName;
  const std::vector<ComparisonRow> rows = summarize(measurements);
  std::istringstream lines(narrowTables(rows, scenes));
  size_t count = 0;
  for (std::string line; std::getline(lines, line); ++count) EXPECT_LE(line.size(), 100u) << line;
  EXPECT_GT(count, 16u);
  const std::string few =
      narrowTables(summarize({run("room", "path", 4, 0, 0.125), run("room", "odis", 4, 0, 0.0625)}), {});
  EXPECT_NE(few.find("| room "), std::string::npos) << few;
  EXPECT_NE(few.find("|   odis        |   4 | 0.0625 |  1.00 |"), std::string::npos) << few;
}

// A row at equal time whose images are those of another one says so in place of its figures.
TEST(Markdown, SaysWhichImagesAreTheSame) {
  Measurement first = run("room", "path", 4, 0, 1), other = run("room", "odis", 4, 0, 0.5);
  other.image = "images/odis.exr";
  Measurement same = other;
  same.equalTime = true;
  same.spp = 8;
  const std::vector<ComparisonRow> rows = summarize({first, run("room", "path", 8, 0, 1), other, same});
  EXPECT_EQ(rows.back().sameAs, "4 spp");
  EXPECT_EQ(rows[2].sameAs, "");
  EXPECT_NE(narrowTables(rows, {}).find("odis, time of 8 |   4 | = 4 spp |"), std::string::npos)
      << narrowTables(rows, {});
  EXPECT_NE(markdownTables(rows, {}).find("| 4 in time of 8 | = 4 spp |"), std::string::npos)
      << markdownTables(rows, {});
}

TEST(Markdown, SaysWhereACurveEnds) {
  EXPECT_EQ(neededText({SamplesNeeded::beyond, 64}), "beyond 64");
  EXPECT_EQ(neededText({SamplesNeeded::below, 4}), "under 4");
  EXPECT_EQ(neededText({SamplesNeeded::within, 9.314}), "9.31");
  EXPECT_EQ(neededText({}), "");
}

TEST(ComparisonJson, HoldsEverythingAndNoInfinity) {
  Comparison comparison;
  comparison.measurements = {run("room", "path", 4, 0, 0.5), run("room", "odis", 4, 0, INFINITY)};
  comparison.scenes.emplace_back().name = "room";
  const auto rows = summarize(comparison.measurements);
  const auto json = nlohmann::json::parse(
      comparisonJson(comparison, rows, {{"path", "--integrator path", {}}}, {"odis compare", "a machine"})
          .dump());
  EXPECT_EQ(json.at("rows").size(), 2u);
  EXPECT_TRUE(json.at("rows").at(1).at("trimmedRelMse").is_null());
  EXPECT_TRUE(json.at("scenes").at(0).at("referenceError").is_null());
  EXPECT_EQ(json.at("methods").at(0).at("options"), "--integrator path");
  EXPECT_EQ(json.at("machine"), "a machine");
  EXPECT_EQ(json.at("runs").at(0).at("trimmedRelMse"), 0.5);
}

}  // namespace
