// Pictures of an unfinished image: they show all of it, and change nothing.
#include <gtest/gtest.h>

#include <atomic>
#include <cstring>

#include "integrator/test_scenes.h"

namespace odis::render {
namespace {

// Asks for a picture after every tile.
class ShowAlways : public Progress {
 public:
  void advance(uint64_t samples) override { m_news += samples; }
  bool wantsPicture() const override { return m_news > 0; }
  void showPicture(int width, int height, std::vector<Rgb> colors) override {
    m_news = 0;
    EXPECT_EQ(width, 40);
    EXPECT_EQ(height, 24);
    pictures.push_back(std::move(colors));
  }
  std::vector<std::vector<Rgb>> pictures;

 private:
  std::atomic<uint64_t> m_news{0};
};

class Pictures : public ::testing::TestWithParam<IntegratorKind> {};

TEST_P(Pictures, ShowAllAndChangeNothing) {
  // A furnace: no sample is black.
  const auto scene = test::loadScene(R"(
    <sensor type="perspective">
      <film type="hdrfilm"><integer name="width" value="40"/><integer name="height" value="24"/>
        <rfilter type="box"/></film></sensor>
    <shape type="sphere"><point name="center" x="0" y="0" z="4"/>
      <bsdf type="diffuse"><rgb name="reflectance" value="0.5"/></bsdf></shape>
    <emitter type="constant"/>)");
  RenderOptions options;
  options.integrator = GetParam();
  options.spp = 6;
  options.set("pilot-spp=0.25");
  options.threads = 1;
  const RenderResult quiet = test::renderScene(*scene, options);
  ShowAlways progress;
  const RenderResult shown = render(*scene, options, progress);

  ASSERT_EQ(shown.image.color.size(), quiet.image.color.size());
  EXPECT_EQ(std::memcmp(static_cast<const void*>(shown.image.color.data()), quiet.image.color.data(),
                        quiet.image.color.size() * sizeof(Rgb)),
            0);
  EXPECT_EQ(shown.stats.rays, quiet.stats.rays);
  ASSERT_GT(progress.pictures.size(), 6u);  // 6 tiles, each of which has samples in more than one pass
  for (const std::vector<Rgb>& picture : progress.pictures) {
    ASSERT_EQ(picture.size(), 40u * 24);
    for (const Rgb& color : picture) {
      EXPECT_GT(color.y, 0);
      EXPECT_LT(color.y, 3);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Pictures, ::testing::Values(IntegratorKind::path, IntegratorKind::odis));

}  // namespace
}  // namespace odis::render
