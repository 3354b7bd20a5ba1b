// Tiles as hosts see them, and which pixels' vertices a pass wants.
#include <odis/tiles.h>

#include "frame/run_frame.h"
#include "odis/floor_under_patch.h"
#include "odis/same_guide.h"
#include "support/models.h"

namespace odis::test {

namespace {

FrameOptions sizedOptions(uint32_t width, uint32_t height, uint32_t offsetX, uint32_t offsetY) {
  FrameOptions options = toyOptions(width, height, 2);
  options.tileOffsetX = offsetX;
  options.tileOffsetY = offsetY;
  return options;
}

TEST(TileGrid, HoldsEveryPixelOnceInTheOrderOfItsPlaces) {
  for (const auto& [width, height] : {std::pair{1u, 1u}, {16u, 16u}, {40u, 20u}, {3u, 70u}})
    for (const auto& [x, y] : {std::pair{0u, 0u}, {5u, 15u}, {15u, 0u}}) {
      const TileGrid grid(width, height, x, y);
      EXPECT_EQ(grid.columns(), (x + width + 15) / 16);
      EXPECT_EQ(grid.rows(), (y + height + 15) / 16);
      std::vector<uint32_t> found(width * height, 0);
      for (uint32_t tile = 0; tile < grid.tileCount(); ++tile) {
        int before = -1;
        grid.forEachPixel(tile, [&](uint32_t pixel) {
          ++found[pixel];
          EXPECT_EQ(grid.tileOf(pixel), tile);
          EXPECT_GT(int(grid.placeInTile(pixel)), before);
          before = int(grid.placeInTile(pixel));
        });
        EXPECT_LT(before, 256);
      }
      EXPECT_EQ(std::count(found.begin(), found.end(), 1u), std::ptrdiff_t(width * height));
    }
}

// A block of 4 x 4 pixels after another, and rows of blocks.
TEST(TileGrid, OrdersNeighboursTogether) {
  const TileGrid grid(32, 32);
  EXPECT_EQ(grid.placeInTile(0), 0u);
  EXPECT_EQ(grid.placeInTile(3), 3u);
  EXPECT_EQ(grid.placeInTile(32), 4u);
  EXPECT_EQ(grid.placeInTile(4), 16u);
  EXPECT_EQ(grid.placeInTile(4 * 32), 64u);
  EXPECT_EQ(grid.tileOf(16), 1u);
}

TEST(TileGrid, IsTheFrames) {
  const FrameOptions options = sizedOptions(40, 20, 5, 15);
  const TileGrid grid(options.width, options.height, options.tileOffsetX, options.tileOffsetY);
  for (uint32_t tile = 0; tile < grid.tileCount(); ++tile) {
    Frame frame(options);
    frame.beginPass();
    std::vector<FrameSample> samples;
    grid.forEachPixel(tile, [&](uint32_t pixel) { samples.push_back({pixel, 0, {1, 1, 1}, 1}); });
    frame.add(samples);
    for (uint32_t pixel = 0; pixel < 40 * 20; ++pixel)
      EXPECT_EQ(frame.samples(pixel).count == 0, grid.tileOf(pixel) == tile);
  }
}

// Delivers made-up samples, each with a vertex: all of them, or those that are wanted. Returns how many were.
size_t runRecorded(Frame& frame, uint32_t pixels, bool all) {
  const std::vector<PathVertex> floor = core::floorUnderPatch(core::kBright, 2500, 3);
  size_t recorded = 0;
  while (frame.beginPass()) {
    for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
      const SampleRange range = frame.samples(pixel);
      std::vector<FrameSample> samples;
      std::vector<PathVertex> vertices;
      for (uint32_t i = range.first; i < range.first + range.count; ++i) {
        samples.push_back({pixel, i, gray(float(1 + i % 2)), 2});
        if (!all && !frame.wantsVertices(pixel)) continue;
        vertices.push_back(floor[(pixel * 7 + i) % floor.size()]);
        vertices.back().pixel = pixel;
        vertices.back().sample = i;
      }
      recorded += vertices.size();
      frame.add(samples, vertices);
    }
    frame.endPass();
  }
  return recorded;
}

// More samples than a guide learns from: a pilot of 1.4 million.
TEST(WantsVertices, LeavesOutThoseThatAreNotLearnedFrom) {
  FrameOptions options = toyOptions(150, 150, 66);
  options.set("pilot-spp=64");
  options.guide.model = makeModel(nullptr, nullptr);
  Frame everything(options), wanted(options);
  const size_t all = runRecorded(everything, 150 * 150, true), some = runRecorded(wanted, 150 * 150, false);
  EXPECT_NEAR(double(some), double(all) / 2, 0.03 * double(all));
  EXPECT_TRUE(core::sameView(everything.guide().view(), wanted.guide().view()));
  EXPECT_EQ(everything.vertexCounts().accepted, wanted.vertexCounts().accepted);
  EXPECT_EQ(wanted.statistics().passesWithoutVertices, 0u);
  EXPECT_GT(wanted.statistics().cells, 0u);
}

TEST(WantsVertices, IsTrueNowhereWhereNothingIsLearned) {
  FrameOptions options = toyOptions(20, 20, 3);
  options.set("guided=off samples=adaptive");
  Frame frame(options);
  frame.beginPass();
  EXPECT_FALSE(frame.wantsVertices(0));
}

}  // namespace

}  // namespace odis::test
