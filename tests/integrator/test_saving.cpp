// Renderings that are saved, interrupted and gone on with: the image is the one of a rendering that never
// ended, to the bit.
#include <gtest/gtest.h>

#include <atomic>
#include <cstring>

#include "integrator/test_scenes.h"
#include "support/temporary_folder.h"

namespace odis::render {
namespace {

// Ends a rendering after so many tiles.
class CancelAfter : public Progress {
 public:
  explicit CancelAfter(int tiles) : m_tiles(tiles) {}
  void advance(uint64_t samples) override { m_tiles -= samples > 0; }
  bool cancelled() const override { return m_tiles <= 0; }

 private:
  std::atomic<int> m_tiles;
};

class NoteWarnings : public Progress {
 public:
  void warn(const std::string& message) override { text += message + "\n"; }
  std::string text;
};

template <class T>
bool equalBits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(static_cast<const void*>(a.data()), b.data(), a.size() * sizeof(T)) == 0);
}

void expectSame(const RenderResult& a, const RenderResult& b) {
  EXPECT_TRUE(equalBits(a.image.color, b.image.color));
  EXPECT_TRUE(equalBits(a.image.variance, b.image.variance));
  EXPECT_TRUE(equalBits(a.image.albedo, b.image.albedo));
  EXPECT_TRUE(equalBits(a.image.position, b.image.position));
  EXPECT_TRUE(equalBits(a.image.guideEntropy, b.image.guideEntropy));
  EXPECT_TRUE(equalBits(a.image.guideSamples, b.image.guideSamples));
  EXPECT_TRUE(equalBits(a.pilotEmitted, b.pilotEmitted));
  EXPECT_TRUE(equalBits(a.records, b.records));
  EXPECT_EQ(a.stats.samples, b.stats.samples);
  EXPECT_EQ(a.stats.rays, b.stats.rays);
  EXPECT_EQ(a.stats.shadowRays, b.stats.shadowRays);
  EXPECT_EQ(a.stats.cells, b.stats.cells);
}

// 70 x 70 pixels: 25 tiles.
RenderOptions everything(IntegratorKind integrator, FilmKind film = FilmKind::splat) {
  RenderOptions options;
  options.film = film;
  options.integrator = integrator;
  options.spp = 6;
  options.seed = 9;
  options.variance = true;
  options.features = options.guideFeatures = true;
  options.records = integrator == IntegratorKind::odis;
  options.saving.subject = "spp: 6\nseed: 9\n";
  return options;
}

class Saving : public ::testing::Test {
 protected:
  std::string file() const { return m_folder.path("image.odis"); }

  test::TemporaryFolder m_folder;
  std::unique_ptr<Scene> m_scene = test::loadScene(test::filtered(test::indirectRoom(70), "gaussian"));
};

TEST_F(Saving, AnInterruptedRenderingGoesOnToTheSameBits) {
  for (const auto& [integrator, film] : {std::pair(IntegratorKind::path, FilmKind::splat),
                                         {IntegratorKind::odis, FilmKind::splat},
                                         {IntegratorKind::odis, FilmKind::pixels}}) {
    RenderOptions options = everything(integrator, film);
    options.set("samples=adaptive");
    const RenderResult expected = test::renderScene(*m_scene, options);
    options.saving.file = file();
    options.saving.everySeconds = 1e9;
    int runs = 0;
    for (bool complete = false; !complete; ++runs) {
      CancelAfter progress(17);
      options.threads = 1 + runs % 2;
      const RenderResult result = render(*m_scene, options, progress);
      complete = !result.stats.interrupted;
      options.saving.resumeFrom = file();
      if (complete) expectSame(result, expected);
    }
    EXPECT_GT(runs, 1);
  }
}

TEST_F(Saving, MapsAtPixelsGoOnToTheSameBits) {
  for (const std::string maps : {"histogram", "oracle"}) {
    RenderOptions options = everything(IntegratorKind::odis);
    options.set("pixel-share=0.5 oracle-spp=3 pixel-maps=" + maps);
    const RenderResult expected = test::renderScene(*m_scene, options);
    options.saving.file = file();
    options.saving.everySeconds = 1e9;
    for (bool complete = false; !complete;) {
      CancelAfter progress(17);
      const RenderResult result = render(*m_scene, options, progress);
      complete = !result.stats.interrupted;
      options.saving.resumeFrom = file();
      if (complete) expectSame(result, expected);
    }
    options.saving.resumeFrom = "";
  }
}

TEST_F(Saving, SavingAgainAndAgainChangesNothing) {
  RenderOptions options = everything(IntegratorKind::odis);
  const RenderResult expected = test::renderScene(*m_scene, options);
  options.saving.file = file();
  options.saving.everySeconds = 0;
  expectSame(test::renderScene(*m_scene, options), expected);
  EXPECT_TRUE(std::filesystem::is_regular_file(file()));
  // The last file is of the last pass.
  options.saving.resumeFrom = file();
  options.saving.file = "";
  expectSame(test::renderScene(*m_scene, options), expected);
}

TEST_F(Saving, WhatCannotBeSavedIsAWarning) {
  RenderOptions options = everything(IntegratorKind::odis);
  const RenderResult expected = test::renderScene(*m_scene, options);
  options.saving.file = m_folder.path("nowhere/image.odis");
  options.saving.everySeconds = 0;
  NoteWarnings progress;
  expectSame(render(*m_scene, options, progress), expected);
  EXPECT_NE(progress.text.find("nowhere"), std::string::npos) << progress.text;
  EXPECT_TRUE(m_folder.isEmpty());
}

TEST_F(Saving, AnotherRenderingIsRefused) {
  RenderOptions options = everything(IntegratorKind::odis);
  options.saving.file = file();
  options.saving.everySeconds = 1e9;
  CancelAfter progress(3);
  render(*m_scene, options, progress);
  options.saving.resumeFrom = file();
  options.saving.subject = "spp: 6\nseed: 8\n";
  try {
    test::renderScene(*m_scene, options);
    FAIL();
  } catch (const OptionError& error) {
    EXPECT_NE(std::string(error.what()).find("found \"seed: 9\", expected \"seed: 8\""), std::string::npos)
        << error.what();
  }
  // The subject says the same, the size is another one all the same.
  options.saving.subject = everything(IntegratorKind::odis).saving.subject;
  const auto other = test::loadScene(test::indirectRoom(50));
  EXPECT_THROW(test::renderScene(*other, options), Error);
}

TEST_F(Saving, AHostsFrameIsNoRendering) {
  odis::FrameOptions frame;
  frame.width = frame.height = 70;
  for (const std::string& hostData :
       {std::string(), std::string("host"), std::string("\xff\xff\xff\xff\xff\xff\xff\xff{}", 10),
        std::string("\2\0\0\0\0\0\0\0{}", 10), std::string("\2\0\0\0\0\0\0\0{[", 10)}) {
    odis::Frame saved(frame);
    saved.setHostData({reinterpret_cast<const uint8_t*>(hostData.data()), hostData.size()});
    saved.save(file());
    RenderOptions options = everything(IntegratorKind::odis);
    options.saving.resumeFrom = file();
    EXPECT_THROW(test::renderScene(*m_scene, options), Error);
  }
}

}  // namespace
}  // namespace odis::render
