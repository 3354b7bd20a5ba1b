// Images guided by maps at pixels have the expectation of path-traced ones, whatever the maps say.
#include <gtest/gtest.h>

#include "integrator/same_expectation.h"
#include "integrator/test_scenes.h"
#include "support/models.h"

namespace odis::render {
namespace {

// Maps that a broken model might make.
class AdversarialPixels : public core::PixelModel {
 public:
  core::IncidentRadiance radiance() const override { return core::IncidentRadiance::withoutDirect; }
  void predict(size_t count, const core::Neighbourhood*, const core::PixelPlace* places,
               core::Histogram* result) const override {
    for (size_t i = 0; i < count; ++i) {
      const auto kind = uint32_t(places[i].x + 3 * places[i].y);
      core::Histogram& map = result[i];
      map.fill(0);  // a quarter of the maps stays like this
      if (kind % 4 == 1) map[(kind * 31) % kMapTexels] = 1;
      for (size_t t = 0; t < kMapTexels; ++t) {
        if (kind % 4 == 2) map[t] = float((t * 7919 + kind * 104729) % 1000);
        if (kind % 4 == 3) map[t] = 1e-30f;
      }
    }
  }
};

struct PixelRoom {
  static std::string text() { return test::indirectRoom(16); }
  static constexpr int kMaxDepth = 6;
};
class PixelMapsTest : public test::AgainstPath<PixelRoom> {
 protected:
  // What --preset paper sets up, with a histogram.
  static RenderOptions pixelOptions() {
    RenderOptions options = guidedOptions();
    options.set("pixel-maps=histogram");
    options.set("map-cosine=off");
    options.set("bsdf-fraction=0.5");
    options.set("cells=0");
    options.set("guide-bounces=1");
    options.set("roulette=throughput");
    options.set("lights=hierarchy");
    options.set("shadow-rays=all");
    options.set("samples=even");
    options.set("refine=0");
    options.set("pilot-spp=1");
    options.set("pilot-weight=1");
    options.set("guided-cost=0");
    return options;
  }
};

constexpr int kPixelTests = 6;

TEST_F(PixelMapsTest, Histogram) {
  expectUnbiased(pixelOptions(), 96, kPixelTests);
}

TEST_F(PixelMapsTest, TilesTimesCosine) {
  RenderOptions options = pixelOptions();
  options.set("pixel-tile=4");
  options.set("map-cosine=on");
  options.set("pixel-light=without-direct");
  options.sampler = SamplerKind::independent;
  expectUnbiased(options, 96, kPixelTests);
}

TEST_F(PixelMapsTest, Oracle) {
  RenderOptions options = pixelOptions();
  options.set("pixel-maps=oracle");
  options.set("oracle-spp=8");
  expectUnbiased(options, 96, kPixelTests);
}

TEST_F(PixelMapsTest, BesideCellsAndAllOtherDecisions) {
  RenderOptions options = guidedOptions();
  options.set("pixel-maps=histogram");
  options.set("pixel-share=0.5");
  expectUnbiased(options, 96, kPixelTests);
}

TEST_F(PixelMapsTest, AdversarialMaps) {
  RenderOptions options = pixelOptions();
  options.set("pixel-maps=network");
  options.model = test::makeModel(nullptr, nullptr, std::make_shared<AdversarialPixels>());
  expectUnbiased(options, 192, kPixelTests);
}

TEST_F(PixelMapsTest, AdversarialMapsBesideCells) {
  RenderOptions options = guidedOptions();
  options.set("pixel-maps=network");
  options.set("pixel-tile=2");
  options.model = test::makeModel(core::Model::builtIn().directions, core::Model::builtIn().lights,
                                  std::make_shared<AdversarialPixels>());
  expectUnbiased(options, 192, kPixelTests);
}

}  // namespace
}  // namespace odis::render
