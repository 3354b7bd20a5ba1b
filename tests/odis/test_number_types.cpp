// The code of a vertex gives the same bits for every number type: what a lane computes is what a float
// computes.
#include <gtest/gtest.h>
#include <odis/mixture.h>
#include "odis/guide.h"

#include <random>

#include "odis/floor_under_patch.h"
#include "odis/lanes.h"
#include "support/models.h"

namespace odis::core {
namespace {

using test::kLaneCount, test::LaneInteger, test::LaneReal;

LaneReal lanesOf(const float* values) {
  LaneReal result;
  std::copy_n(values, kLaneCount, result.lane);
  return result;
}

TEST(NumberTypes, OctahedralMap) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (int i = 0; i < 1000; ++i) {
    float u[kLaneCount], v[kLaneCount];
    for (int k = 0; k < kLaneCount; ++k) u[k] = uniform(engine), v[k] = uniform(engine);
    const Vector3<LaneReal> w = squareToDirection(Vector2<LaneReal>{lanesOf(u), lanesOf(v)});
    const Vector2<LaneReal> back = directionToSquare(w);
    for (int k = 0; k < kLaneCount; ++k) {
      const Float3 expected = squareToDirection(Float2{u[k], v[k]});
      EXPECT_EQ(w.x.lane[k], expected.x);
      EXPECT_EQ(w.y.lane[k], expected.y);
      EXPECT_EQ(w.z.lane[k], expected.z);
      EXPECT_EQ(back.x.lane[k], directionToSquare(expected).x);
      EXPECT_EQ(back.y.lane[k], directionToSquare(expected).y);
    }
  }
}

TEST(NumberTypes, MapsAndDecisions) {
  GuideOptions options;
  options.model = Model();
  GuideBuilder builder(options);
  const std::vector<PathVertex> vertices = floorUnderPatch(kBright, 20000, 7);
  builder.add(vertices);
  const Guide guide = builder.build();
  const GuideView view = guide.view();
  std::mt19937 engine(2);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (int i = 0; i < 200; ++i) {
    LaneInteger cells;
    float u[kLaneCount], v[kLaneCount], roughness[kLaneCount];
    for (int k = 0; k < kLaneCount; ++k) {
      cells.lane[k] = int32_t(engine() % view.cellCount);
      u[k] = uniform(engine), v[k] = uniform(engine), roughness[k] = uniform(engine);
    }
    const SamplingMap<LaneReal> map(view.maps, cells);
    const SamplingMap<LaneReal>::Sample sample = map.sample(lanesOf(u), lanesOf(v));
    const LaneReal pdf = map.pdf(sample.wi);
    const LaneReal fraction = bsdfFraction(view, cells, lanesOf(roughness));
    const LaneReal survival = survivalProbability(view.rules, lanesOf(u), lanesOf(v));
    const LaneReal shadow = shadowRayProbability(view.rules, lanesOf(u));
    for (int k = 0; k < kLaneCount; ++k) {
      const SamplingMap<float> scalar(view.maps, cells.lane[k]);
      const SamplingMap<float>::Sample expected = scalar.sample(u[k], v[k]);
      EXPECT_EQ(sample.pdf.lane[k], expected.pdf);
      EXPECT_EQ(sample.wi.x.lane[k], expected.wi.x);
      EXPECT_EQ(sample.wi.z.lane[k], expected.wi.z);
      EXPECT_EQ(pdf.lane[k], scalar.pdf(expected.wi));
      EXPECT_EQ(fraction.lane[k], bsdfFraction(view, cells.lane[k], roughness[k]));
      EXPECT_EQ(survival.lane[k], survivalProbability(view.rules, u[k], v[k]));
      EXPECT_EQ(shadow.lane[k], shadowRayProbability(view.rules, u[k]));
    }
  }
}

TEST(NumberTypes, Mixture) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> uniform(0, 1);
  const auto draw = [&](float(&values)[kLaneCount]) {
    for (float& value : values) value = engine() % 8 == 0 ? 0 : uniform(engine);
  };
  for (int i = 0; i < 1000; ++i) {
    float u[kLaneCount], fraction[kLaneCount], guidable[kLaneCount], pdf[kLaneCount], guidablePdf[kLaneCount],
        mapPdf[kLaneCount];
    for (auto* values : {&u, &fraction, &guidable, &pdf, &guidablePdf, &mapPdf}) draw(*values);
    for (float& value : fraction) value = value > 0 ? value : 1;
    const odis::Mixture<LaneReal> mixture(lanesOf(fraction), lanesOf(guidable));
    const LaneReal mixed = mixture.pdf(lanesOf(pdf), lanesOf(guidablePdf), lanesOf(mapPdf)),
                   weight = powerHeuristic(lanesOf(pdf), lanesOf(mapPdf));
    const auto choice = mixture.choose(lanesOf(u));
    const auto guides = mixture.guides();
    for (int k = 0; k < kLaneCount; ++k) {
      const odis::Mixture<float> scalar(fraction[k], guidable[k]);
      EXPECT_EQ(mixed.lane[k], scalar.pdf(pdf[k], guidablePdf[k], mapPdf[k]));
      EXPECT_EQ(weight.lane[k], powerHeuristic(pdf[k], mapPdf[k]));
      EXPECT_EQ(choice.fromMap.lane[k], scalar.choose(u[k]).fromMap);
      EXPECT_EQ(choice.u.lane[k], scalar.choose(u[k]).u);
      EXPECT_EQ(guides.lane[k], scalar.guides());
    }
  }
}

}  // namespace
}  // namespace odis::core
