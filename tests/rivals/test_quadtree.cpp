// Quadtrees and SD-trees: densities integrate to one, and what is sampled is what is stated.
#include "render/rivals/quadtree.h"

#include <random>

#include "render/path/path.h"
#include "render/rivals/sd_tree.h"
#include "support/chi2.h"

namespace odis::render {
namespace {

// A few lobes, two of which lie on the square's edge, and nothing elsewhere.
Vec2 lobePoint(std::mt19937& engine) {
  static const Vec2 kCentres[] = {{0.3f, 0.4f}, {0.8f, 0.99f}, {0.8f, 0.01f}, {0.55f, 0.7f}};
  std::normal_distribution<float> normal(0, 0.04f);
  const Vec2 p = kCentres[engine() % 4] + Vec2(normal(engine), normal(engine));
  const auto within = [](float x) { return std::clamp(x, 0.0f, kOneMinusEpsilon); };
  return {within(p.x), within(p.y)};
}

Quadtree learned(QuadtreeFilter filter, int rounds = 4, float share = 0.01f) {
  std::mt19937 engine(3);
  Quadtree tree;
  for (int round = 0; round < rounds; ++round) {
    if (round > 0) tree = tree.refined(share);
    for (int i = 0; i < 20000; ++i) tree.record(lobePoint(engine), 1 + float(engine() % 3), filter);
    tree.build();
  }
  return tree;
}

double integral(const Quadtree& tree) {
  const int n = 1024;
  double sum = 0;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) sum += tree.pdf({(float(x) + 0.5f) / float(n), (float(y) + 0.5f) / float(n)});
  return sum / (double(n) * n);
}

TEST(Quadtree, EmptyIsUniform) {
  Quadtree tree;
  tree.build();
  EXPECT_EQ(tree.pdf({0.1f, 0.9f}), 1);
  const Quadtree::Sample sample = tree.sample({0.25f, 0.75f});
  EXPECT_EQ(sample.point, Vec2(0.25f, 0.75f));
  EXPECT_EQ(sample.pdf, 1);
  // Four levels: a leaf has 4^-4 of the square, its parent more than a hundredth.
  EXPECT_EQ(tree.refined(0.01f).nodeCount(), 1u + 4 + 16 + 64);
}

TEST(Quadtree, IntegratesToOne) {
  for (const QuadtreeFilter filter : {QuadtreeFilter::nearest, QuadtreeFilter::box})
    EXPECT_NEAR(integral(learned(filter)), 1, 1e-4);
}

TEST(Quadtree, SamplesHaveTheStatedDensity) {
  const Quadtree tree = learned(QuadtreeFilter::box);
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> uniform(0, kOneMinusEpsilon);
  for (int i = 0; i < 100000; ++i) {
    const Quadtree::Sample sample = tree.sample({uniform(engine), uniform(engine)});
    ASSERT_GT(sample.pdf, 0);
    ASSERT_LT(std::max(sample.point.x, sample.point.y), 1);
    ASSERT_NEAR(tree.pdf(sample.point) / sample.pdf, 1, 1e-4);
  }
}

TEST(Quadtree, IsFineWhereThereIsMuch) {
  const Quadtree tree = learned(QuadtreeFilter::nearest, 8);
  // No quadrant holds more than a hundredth: around the lobes' centres there are some hundred leaves, so at
  // least a third as many nodes; and not many more.
  const Quadtree next = tree.refined(0.01f);
  EXPECT_GT(next.nodeCount(), 40u);
  EXPECT_LT(next.nodeCount(), 400u);
  EXPECT_GT(tree.pdf({0.3f, 0.4f}), 10);
  EXPECT_EQ(tree.refined(1).nodeCount(), 1u);
}

TEST(Quadtree, DepthIsLimited) {
  Quadtree tree;
  for (int round = 0; round < 30; ++round) {
    tree.record({0.123456f, 0.654321f}, 1, QuadtreeFilter::nearest);
    tree.build();
    tree = tree.refined(0.01f);
  }
  EXPECT_EQ(tree.nodeCount(), size_t(Quadtree::kMaxDepth));
}

TEST(Quadtree, ABoxKeepsItsValueAroundTheSeam) {
  Quadtree tree = learned(QuadtreeFilter::box).refined(0.01f);
  tree.record({0.8f, 0.0001f}, 5, QuadtreeFilter::box);
  tree.record({0.8f, 0.9999f}, 7, QuadtreeFilter::box);
  tree.build();
  EXPECT_NEAR(tree.total(), 12, 1e-4);
  EXPECT_GT(tree.pdf({0.8f, 0.0001f}), 1);
}

TEST(Quadtree, RecordsNothingThatIsNotPositive) {
  Quadtree tree;
  for (const float value : {0.0f, -1.0f, float(NAN)}) tree.record({0.5f, 0.5f}, value, QuadtreeFilter::box);
  tree.build();
  EXPECT_EQ(tree.total(), 0);
}

TEST(Cylinder, InvertsItself) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> uniform(0, kOneMinusEpsilon);
  for (int i = 0; i < 100000; ++i) {
    const Vec2 point(uniform(engine), uniform(engine));
    const Vec3 w = cylinderToDirection(point);
    ASSERT_NEAR(dot(w, w), 1, 1e-5);
    ASSERT_NEAR(dot(cylinderToDirection(directionToCylinder(w)), w), 1, 1e-5);
  }
  for (const Vec3 w : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(1, -0.0f, 0), Vec3(-1, -0.0f, 0)})
    EXPECT_LT(std::max(directionToCylinder(w).x, directionToCylinder(w).y), 1);
}

TEST(SdLeaf, SamplesFollowTheirDensity) {
  for (const QuadtreeFilter filter : {QuadtreeFilter::nearest, QuadtreeFilter::box}) {
    SdLeaf leaf;
    leaf.known = learned(filter);
    test::Chi2Options options;
    options.testCount = 2;
    options.quadrature = 24;
    int differ = 0;
    const auto sample = [&](float, float u, float v) {
      const SamplingMap<float>::Sample drawn = leaf.sample({u, v});
      const Vec3 wi = fromOdis(drawn.wi);
      // Next to a quadrant's edge, the way there and back may end on its other side.
      differ += std::abs(leaf.pdf(wi) / drawn.pdf - 1) > 1e-4f;
      return std::optional(wi);
    };
    EXPECT_TRUE(test::chi2Test(
        sample, [&](const Vec3& w) { return leaf.pdf(w); }, options));
    EXPECT_LT(differ, options.samples / 1000);
  }
}

}  // namespace
}  // namespace odis::render
