// Light hierarchies are descended for several paths at once: as for each by itself.
#include <gtest/gtest.h>

#include "emitter/light_scenes.h"
#include "render/emitter/directional.h"
#include "render/emitter/light_descents.h"
#include "render/emitter/light_sampler.h"
#include "render/emitter/point.h"

using namespace odis::render;
using namespace odis::test;

// From the root and through groups, of trees of one light and of many, by fewer paths than there is room for:
// the same bits. Some end in the dark.
TEST(LightDescents, FindWhatEachFinds) {
  constexpr size_t kCount = 13;
  Random random(1);
  int lit = 0, dark = 0, turned = 0;
  for (const int count : {1, 2, 5, 300}) {
    const LightTree tree(someLights(count, random), 8);
    for (int round = 0; round < 100; ++round) {
      LightDescents descents;
      std::array<LightTree::Descent, kCount> expected;
      for (size_t i = 0; i < kCount; ++i) {
        const LightReference ref = someReference(int(i), random);
        const auto group = std::min(uint32_t(random() * float(tree.groupCount())), tree.groupCount() - 1);
        const LightTree::Descent from =
            i % 2 == 0 ? tree.fromRoot(random()) : tree.throughGroup(group, random());
        turned += from.trail != 1;
        expected[i] = tree.descend(ref, from);
        descents.add(ref, from);
      }
      descents.find(tree);
      ASSERT_EQ(descents.size(), kCount);
      for (size_t i = 0; i < kCount; ++i) {
        EXPECT_EQ(descents[i].light(), expected[i].light());
        EXPECT_EQ(descents[i].toGroup, expected[i].toGroup);
        EXPECT_EQ(descents[i].probability, expected[i].probability);
        EXPECT_EQ(descents[i].u, expected[i].u);
        ++(expected[i].light() == LightTree::kNone ? dark : lit);
      }
    }
  }
  EXPECT_GT(lit, 500);
  EXPECT_GT(dark, 100);
  EXPECT_GT(turned, 500);
}

// Choices for several references at once are those for each, whether lights are in a tree or infinitely far
// away, and whether something was learned of their groups or not.
TEST(LightDescents, ChooseWhatEachChooses) {
  Random random(2);
  std::vector<std::unique_ptr<Emitter>> lights;
  std::vector<Emitter*> all;
  for (int i = 0; i < 40; ++i)
    lights.push_back(std::make_unique<PointLight>(random.inCube(3), Rgb(1, 1, 1) * (0.1f + random())));
  for (int i = 0; i < 3; ++i)
    lights.push_back(std::make_unique<DirectionalLight>(random.direction(), Rgb(1, 1, 1) * random()));
  for (const auto& light : lights) all.push_back(light.get());
  const LightSampler sampler(indexed(all));
  std::vector<float> cdf(sampler.groupCount() + 1);
  for (size_t i = 0; i < cdf.size(); ++i) cdf[i] = float(i) / float(cdf.size() - 1);
  for (int round = 0; round < 200; ++round) {
    std::array<LightReference, 11> refs;
    std::array<LightSampler::Request, 11> requests;
    std::array<LightSampler::Choice, 11> choices;
    for (size_t i = 0; i < refs.size(); ++i) {
      refs[i] = someReference(int(i), random);
      if (i % 3 > 0) refs[i].learned = {cdf.data(), 0.5f};
      requests[i] = {&refs[i], random(), Vec2(random(), random())};
    }
    sampler.sample(requests, choices);
    for (size_t i = 0; i < refs.size(); ++i) {
      const LightSampler::Choice alone = sampler.sample(refs[i], requests[i].uChoice, requests[i].u);
      EXPECT_EQ(choices[i].emitter, alone.emitter);
      EXPECT_EQ(choices[i].part, alone.part);
      EXPECT_EQ(choices[i].group, alone.group);
      EXPECT_EQ(choices[i].probability, alone.probability);
      EXPECT_EQ(choices[i].u, alone.u);
    }
  }
}
