// More cells or maps than numbers of 32 bits can count the texels of.
#include <gtest/gtest.h>

#include "odis/cells/saved_grid.h"
#include "odis/cells/statistics.h"
#include "odis/guide.h"
#include "odis/paper_method.h"
#include "odis/record/vertex_fields.h"
#include "support/edit_archive.h"

namespace odis::core {
namespace {

template <class Load>
std::string loadErrorOf(const ArchiveWriter& saved, const Load& load) {
  try {
    load(Archive::parse("most", test::bytesOf(saved)));
  } catch (const FileError& error) {
    return error.what();
  }
  return "none";
}

TEST(MostCells, TheLastTexelFitsIn32Bits) {
  EXPECT_LE(uint64_t(kMostMaps) * kMapShares, uint64_t(INT32_MAX));
  EXPECT_GT(uint64_t(kMostMaps + 1) * kMapShares, uint64_t(INT32_MAX));
}

TEST(MostCells, AGuideOfMoreIsRefused) {
  for (const uint32_t more : {0u, 1u}) {
    ArchiveWriter file("guide");
    file.addValue("guide.built", uint8_t(1));
    file.add("guide.keys", std::vector<uint64_t>(kMostMaps + more));
    const std::string error = loadErrorOf(file, [](const Archive& saved) { Guide::load(saved); });
    EXPECT_EQ(error.find("guide.keys: are too many") != std::string::npos, more > 0) << error;
  }
}

TEST(MostCells, AStoreOfMoreIsRefused) {
  for (const size_t more : {0, 1}) {
    ArchiveWriter file("builder");
    file.addValue("cells.placed", uint8_t(1));
    saveGrid(file, "cells.grid", CellGrid().flat());
    saveFields(file, "cells.counts", VertexCounts());
    file.add("cells.depthShares", std::vector<float>());
    file.add("cells.keys", std::vector<uint64_t>(kMostCells + more));
    const std::string error =
        loadErrorOf(file, [](const Archive& saved) { CellStore(15).load(saved, "cells"); });
    EXPECT_EQ(error.find("cells.keys: are too many") != std::string::npos, more > 0) << error;
  }
}

std::unique_ptr<PaperMethod> mapsAtPixels(uint32_t width, uint32_t height, uint32_t tile) {
  FrameOptions options;
  options.width = width;
  options.height = height;
  options.guide.pixelMaps = PixelMapKind::histogram;
  options.guide.pixelTile = tile;
  return PaperMethod::of(options, std::make_shared<GuideBuilder>(options.guide), libraryTasks(1));
}

TEST(MostCells, MoreMapsAtPixelsAreRefused) {
  EXPECT_THROW(mapsAtPixels(2048, 2049, 1), std::invalid_argument);
  EXPECT_THROW(mapsAtPixels(4097, 4096, 2), std::invalid_argument);
  EXPECT_NE(mapsAtPixels(2049, 2049, 2), nullptr);
}

}  // namespace
}  // namespace odis::core
