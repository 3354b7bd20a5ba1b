// Whether lights are chosen by what was learned is decided by what the pilot's vertices predict.
#include "odis/models/light_decision.h"

#include <gtest/gtest.h>

#include <random>
#include <sstream>

#include "odis/files/archive.h"
#include "odis/floor_under_patch.h"
#include "odis/guide_data.h"

namespace odis::core {
namespace {

constexpr int kVertices = 20000;

// A floor whose vertices drew one of two groups of lights, each as often. The first gives `first`, the second
// `second` where x is below .5, and the other way round beyond.
std::vector<PathVertex> floorUnderLamps(float first, float second) {
  std::vector<PathVertex> vertices = floorUnderPatch(kBright, kVertices, 1);
  std::mt19937 engine(2);
  for (PathVertex& v : vertices) {
    v.radiance = {0, 0, 0};
    v.lightGroup = uint32_t(engine() & 1);
    v.lightGroupProbability = 0.5f;
    v.lightableGroups = ~0u;
    const bool isFirst = (v.lightGroup == 0) == (v.position.x < 0.5f);
    const float direct = 2 * (isFirst ? first : second);
    v.direct = {direct, direct, direct};
    v.light = direct;
    v.lightDirection = {0, 0, 1};
    v.lightPdf = 0;  // as of a point
  }
  return vertices;
}

// Believes in one group everywhere.
class Stubborn : public LightModel {
 public:
  LightSquares predict(const CellChain&, const LightSquares*, uint32_t) const override { return {1, 1e-4}; }
  double reliability(const CellChain&, uint32_t) const override { return 1; }
};

// A guide of these vertices, with a model of the tests in place of the network.
class Decision {
 public:
  Decision(const std::vector<PathVertex>& vertices, std::shared_ptr<const LightModel> model)
      : m_builder(options(std::move(model))) {
    m_builder.add(vertices);
    m_guide = m_builder.build();
  }
  const Guide& guide() const { return m_guide; }
  CellDecisions at(const Float3& position) const {
    const GuideView view = m_guide.view();
    const uint64_t key = CellGrid(view.grid).key(position, {0, 0, 1}, 0);
    return view.decisions[findSlot(view.slots, view.slotMask, key)];
  }
  float firstShareAt(const Float3& position) const {
    const GuideView view = m_guide.view();
    const uint64_t key = CellGrid(view.grid).key(position, {0, 0, 1}, 0);
    return view.lightTables[findSlot(view.slots, view.slotMask, key) * 3 + 1];
  }

 private:
  static GuideOptions options(std::shared_ptr<const LightModel> model) {
    GuideOptions result;
    result.model = Model();
    result.model->lights = std::move(model);
    result.lightGroups = 2;
    return result;
  }
  GuideBuilder m_builder;
  Guide m_guide;
};

TEST(LightDecision, FollowsTheFormulaWhereTheModelIsTooSure) {
  const Decision decision(floorUnderLamps(1, 4), std::make_shared<Stubborn>());
  EXPECT_TRUE(decision.guide().choosesLights());
  EXPECT_NEAR(decision.firstShareAt({0.25f, 0.5f, 0}), 0.2, 0.05);
  EXPECT_NEAR(decision.firstShareAt({0.75f, 0.5f, 0}), 0.8, 0.05);
}

TEST(LightDecision, FollowsTheModelWhereItIsBetter) {
  // What the stubborn model believes is right here: the second group gives nothing where x is below .5.
  std::vector<PathVertex> vertices = floorUnderLamps(3, 0.03f);
  std::erase_if(vertices, [](const PathVertex& v) { return v.position.x > 0.45f; });
  const Decision decision(vertices, std::make_shared<Stubborn>());
  EXPECT_NEAR(decision.firstShareAt({0.25f, 0.5f, 0}), 1 / 1.01, 1e-3);
}

TEST(LightDecision, LearnsNothingWhereAllGroupsGiveTheSame) {
  const Decision decision(floorUnderLamps(1, 1), std::make_shared<Stubborn>());
  EXPECT_FALSE(decision.guide().choosesLights());
  EXPECT_EQ(decision.at({0.25f, 0.5f, 0}).learnedLightFraction, 0);
}

// E[X^2] under the best choice among two lights that give 1 and 4, over that of an even one.
TEST(LightDecision, MomentsAreThoseOfTheChoice) {
  const std::vector<PathVertex> vertices = floorUnderLamps(1, 4);
  CellStore store(20);
  const ArrayView<const PathVertex> all(vertices);
  store.add(VertexParts(&all, 1), 4);
  const std::vector<CellStatistics>& cells = store.rollUp();
  std::vector<FractionSample> samples;
  for (const PathVertex& v : vertices) samples.push_back(fractionSampleOf(v, true));
  const ArrayView<const FractionSample> part(samples);
  const LightDecisionInputs inputs{store, FractionParts(&part, 1), 1, {}, 2};
  LightChoice choice;
  choice.decisions.resize(cells.size());
  choice.tables.assign(cells.size() * 3, 0);
  for (size_t c = 0; c < cells.size(); ++c) {
    choice.decisions[c].learnedLightFraction = 0.5f;
    choice.tables[3 * c + 1] = 0.25f;
    choice.tables[3 * c + 2] = 1;
  }
  // Both groups are drawn as often, so one of 1 and 4 by each: P = .375 or .625 in place of .5.
  double expected = 0, pilot = 0;
  for (const PathVertex& v : vertices) {
    const double square = double(v.light) * v.light;
    pilot += square;
    expected += square * 0.5 / (v.lightGroup == 0 ? 0.375 : 0.625);
  }
  EXPECT_NEAR(lightMoment(inputs, choice, 0), expected / pilot, 1e-6);
  EXPECT_NEAR(lightMoment(inputs, choice, 3), expected / pilot, 1e-6);
  samples.clear();
  const ArrayView<const FractionSample> none(samples);
  EXPECT_EQ(lightMoment({store, FractionParts(&none, 1), 1, {}, 2}, choice, 0), 0);
}

// A guide that is saved, or built again, goes on with the choice that was made.
TEST(LightDecision, StaysAsItWasDecided) {
  for (const float second : {1.0f, 4.0f}) {
    GuideOptions options;
    options.lightGroups = 2;
    GuideBuilder builder(options);
    builder.add(floorUnderLamps(1, second));
    const Guide guide = builder.build();
    EXPECT_EQ(guide.choosesLights(), second > 1);
    ArchiveWriter file("guide");
    guide.save(file);
    std::ostringstream stream;
    file.write(stream);
    const Guide loaded = Guide::load(Archive::parse("guide", stream.str()));
    builder.forgetFractions();
    EXPECT_EQ(builder.rebuild(loaded).choosesLights(), second > 1);
  }
}

}  // namespace
}  // namespace odis::core
