// What a rendering tells of its progress, and whether it was stopped.
#include <gtest/gtest.h>

#include <atomic>

#include "integrator/test_scenes.h"

namespace odis::render {
namespace {

// Counts the samples of each stage.
class Stages : public Progress {
 public:
  struct Stage {
    std::string name;
    uint64_t total, done;
  };
  void begin(const std::string& stage, uint64_t total, uint64_t done, const char*) override {
    m_done = done;
    stages.push_back({stage, total, done});
  }
  void changeTotal(uint64_t total) override { stages.back().total = total; }
  void advance(uint64_t more) override { m_done += more; }
  void end() override { stages.back().done = m_done; }
  std::vector<Stage> stages;

 private:
  std::atomic<uint64_t> m_done{0};
};

std::unique_ptr<Scene> unevenRoom() {
  return test::loadScene(R"(
    <sensor type="perspective">
      <film type="hdrfilm"><integer name="width" value="40"/><integer name="height" value="24"/></film>
    </sensor>
    <shape type="sphere"><point name="center" x="0" y="0" z="4"/>
      <bsdf type="diffuse"/></shape>
    <shape type="sphere"><point name="center" x="2" y="1" z="3"/><float name="radius" value="0.2"/>
      <emitter type="area"><rgb name="radiance" value="9"/></emitter></shape>)");
}

TEST(Stages, EndWithAllTheirSamples) {
  const auto scene = unevenRoom();
  for (const std::string spread : {"even", "adaptive"})
    for (const IntegratorKind integrator : {IntegratorKind::path, IntegratorKind::odis})
      for (const double pilot : {0.25, 2.0}) {
        RenderOptions options;
        options.integrator = integrator;
        options.set("samples=" + spread + " pilot-spp=" + std::to_string(pilot));
        options.spp = 24;
        Stages progress;
        const RenderResult result = render(*scene, options, progress);
        uint64_t samples = 0;
        for (const Stages::Stage& stage : progress.stages) {
          EXPECT_EQ(stage.done, stage.total) << stage.name;
          samples += stage.total;
        }
        EXPECT_EQ(samples, result.stats.samples);
      }
}

// Is cancelled once so many samples are taken.
class CancelAt : public Progress {
 public:
  explicit CancelAt(uint64_t samples) : m_left(int64_t(samples)) {}
  void advance(uint64_t more) override { m_left -= int64_t(more); }
  bool cancelled() const override { return m_left <= 0; }

 private:
  std::atomic<int64_t> m_left;
};

// Whoever stops a rendering after its last sample has all of it.
TEST(Interrupted, IsWhatLacksSamples) {
  const auto scene = unevenRoom();
  for (const IntegratorKind integrator : {IntegratorKind::path, IntegratorKind::odis, IntegratorKind::ppg}) {
    RenderOptions options;
    options.integrator = integrator;
    options.set("samples=even");
    options.threads = 1;
    options.spp = 6;
    const uint64_t samples = 40 * 24 * 6;
    CancelAt early(samples - 400), late(samples);  // before the last tile, of 8 x 8 pixels, and after it
    const RenderStats all = render(*scene, options, late).stats;
    EXPECT_FALSE(all.interrupted) << int(integrator);
    EXPECT_EQ(all.samples, samples) << int(integrator);
    EXPECT_TRUE(render(*scene, options, early).stats.interrupted) << int(integrator);
  }
}

TEST(Interrupted, TellsTheFewestSamplesOfAPixel) {
  const auto scene = unevenRoom();
  for (const IntegratorKind integrator :
       {IntegratorKind::path, IntegratorKind::odis, IntegratorKind::ppg, IntegratorKind::restir}) {
    RenderOptions options;
    options.integrator = integrator;
    options.set("samples=even");
    options.threads = 1;
    options.spp = 2;
    CancelAt never(uint64_t(1) << 40), first(16);
    EXPECT_EQ(render(*scene, options, first).stats.fewestSamples, 0u) << int(integrator);
    const uint32_t fewest = render(*scene, options, never).stats.fewestSamples;
    // The image of ppg is that of its last iteration.
    EXPECT_TRUE(integrator == IntegratorKind::ppg ? fewest >= 1 : fewest == 2) << int(integrator) << fewest;
  }
  // A pilot sample that weighs nothing says nothing of the noise.
  RenderOptions options;
  options.spp = 2;
  options.set("pilot-spp=1");
  options.set("pilot-weight=0");
  EXPECT_EQ(test::renderScene(*scene, options).stats.fewestSamples, 1u);
}

}  // namespace
}  // namespace odis::render
