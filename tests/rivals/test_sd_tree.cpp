#include "render/rivals/sd_tree.h"

#include <gtest/gtest.h>

#include <random>

namespace odis::render {
namespace {

// A tree that got samples along a diagonal, halved until no leaf has more than so many.
SdTree diagonalTree(float most) {
  SdTree tree({-1, -1, -1}, {1, 0.5f, 0});
  std::mt19937 engine(2);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (int round = 0; round < 8; ++round) {
    for (SdLeaf& leaf : tree.leaves()) leaf.weight = 0;
    for (int i = 0; i < 10000; ++i) {
      const float t = uniform(engine);
      tree.leaves()[tree.find({t, t, t})].weight += 1;
    }
    tree.refine(most);
  }
  return tree;
}

TEST(SdTree, FillsACube) {
  const SdTree tree({-1, -1, -1}, {1, 0.5f, 0});
  EXPECT_EQ(tree.clipped({5, 5, -5}), Vec3(1, 1, -1));
  EXPECT_EQ(tree.clipped({0.1f, 0.2f, 0.3f}), Vec3(0.1f, 0.2f, 0.3f));
}

TEST(SdTree, IsFineWhereThereAreSamples) {
  const SdTree tree = diagonalTree(500);
  EXPECT_GT(tree.leaves().size(), 20u);
  EXPECT_LT(tree.leaves().size(), 200u);
  const SdTree::Place near = tree.place({0.3f, 0.3f, 0.3f}), far = tree.place({0.9f, -0.9f, 0.9f});
  EXPECT_LT(near.high.x - near.low.x, far.high.x - far.low.x);
}

TEST(SdTree, PlaceIsWhatFindFinds) {
  const SdTree tree = diagonalTree(300);
  std::mt19937 engine(4);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (int i = 0; i < 10000; ++i) {
    const Vec3 p(uniform(engine), uniform(engine), uniform(engine));
    const SdTree::Place place = tree.place(p);
    ASSERT_EQ(place.leaf, tree.find(p));
    for (int a = 0; a < 3; ++a) {
      ASSERT_GE(p[a], place.low[a] - 1e-5f);
      ASSERT_LE(p[a], place.high[a] + 1e-5f);
    }
  }
}

TEST(SdTree, ABoxIsSharedOut) {
  const SdTree tree = diagonalTree(300);
  std::mt19937 engine(4);
  std::uniform_real_distribution<float> uniform(-0.6f, 0.6f);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 middle(uniform(engine), uniform(engine), uniform(engine)), half(0.3f, 0.2f, 0.1f);
    float sum = 0, own = 0;
    tree.overlapping(middle - half, middle + half, [&](uint32_t leaf, float share) {
      sum += share;
      if (leaf == tree.find(middle)) own += share;
    });
    ASSERT_NEAR(sum, 1, 1e-4f);
    ASSERT_GT(own, 0);
  }
}

TEST(SdTree, HalvesKnowWhatTheWholeKnew) {
  SdTree tree({0, 0, 0}, {1, 1, 1});
  tree.leaves()[0].known.record({0.1f, 0.1f}, 3, QuadtreeFilter::nearest);
  tree.leaves()[0].known.build();
  tree.leaves()[0].weight = 100;
  tree.refine(60);
  ASSERT_EQ(tree.leaves().size(), 2u);
  for (const SdLeaf& leaf : tree.leaves()) {
    EXPECT_EQ(leaf.weight, 50);
    EXPECT_EQ(leaf.known.total(), 3);
  }
  EXPECT_NE(tree.find({0.2f, 0.5f, 0.5f}), tree.find({0.7f, 0.5f, 0.5f}));
  EXPECT_EQ(tree.find({0.2f, 0.1f, 0.9f}), tree.find({0.2f, 0.9f, 0.1f}));
}

TEST(SdTree, EndsWhereAllSamplesLieAtOnePoint) {
  SdTree tree({1, 1, 1}, {1, 1, 1});
  for (int round = 0; round < 100; ++round) {
    tree.leaves()[tree.find({1, 1, 1})].weight = 1000;
    tree.refine(600);
  }
  EXPECT_LE(tree.leaves().size(), 101u);
}

TEST(Adam, FindsTheMinimum) {
  Adam adam;
  for (int i = 0; i < 5000; ++i) adam.step(2 * (adam.value() - 1.5f), 0.01f, 4);
  EXPECT_NEAR(adam.value(), 1.5f, 0.05f);
  for (int i = 0; i < 5000; ++i) adam.step(-1, 0.01f, 4);
  EXPECT_EQ(adam.value(), 4);
}

}  // namespace
}  // namespace odis::render
