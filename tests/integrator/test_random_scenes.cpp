// Random scenes of everything that a scene can hold come out in finite numbers, however they are rendered.
// The fuzz target of the same name renders many more of them, with the sanitizers' eyes open.
#include <gtest/gtest.h>

#include "support/random_scene_check.h"

namespace odis::test {
namespace {

TEST(RandomScenes, AreRenderedInFiniteNumbers) {
  constexpr int kScenes = 100;
  const SceneFiles files(ODIS_SOURCE);
  int rendered = 0;
  for (int seed = 0; seed < kScenes; ++seed) {
    Draws draws(std::to_string(seed));
    const std::string text = RandomScene(draws, files).text();
    try {
      EXPECT_EQ(failureOfScene(files.scene(text)), "") << "seed " << seed << ": " << text;
      ++rendered;
    } catch (const render::SceneError& error) {
      EXPECT_STREQ(error.what(), "") << "seed " << seed;
    }
  }
  EXPECT_GT(rendered, 0.9 * kScenes);
}

}  // namespace
}  // namespace odis::test
