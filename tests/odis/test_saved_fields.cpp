// Saved files are made of fields: those of older versions lack some, those of newer ones have more.
#include <gtest/gtest.h>

#include <random>

#include "odis/floor_under_patch.h"
#include "odis/same_guide.h"
#include "odis/saved_vertices.h"
#include "support/edit_archive.h"
#include "support/models.h"

namespace odis::core {
namespace {

using test::withOtherArrays;

Archive olderFile(const std::string& saved, const std::vector<std::string>& lacking) {
  size_t dropped = 0;
  const std::string bytes = withOtherArrays(saved, [&](const std::string& name) {
    const bool lacks = std::find(lacking.begin(), lacking.end(), name) != lacking.end();
    dropped += lacks;
    return lacks;
  });
  EXPECT_EQ(dropped, lacking.size());
  return Archive::parse("older", bytes);
}

// Vertices whose bytes are all different, but for truth values.
std::vector<PathVertex> randomVertices(size_t count) {
  std::mt19937 engine(4);
  std::vector<PathVertex> vertices(count);
  for (PathVertex& v : vertices) {
    unsigned char bytes[sizeof v];
    for (unsigned char& byte : bytes) byte = static_cast<unsigned char>(engine());
    bytes[offsetof(PathVertex, discrete)] &= 1;
    bytes[offsetof(PathVertex, scattersBothSides)] &= 1;
    std::memcpy(static_cast<void*>(&v), bytes, sizeof v);
  }
  return vertices;
}

std::string savedVertexFile(const std::vector<PathVertex>& vertices) {
  ArchiveWriter file("vertices");
  saveVertices(file, "vertices", vertices);
  return test::bytesOf(file);
}

TEST(SavedFields, AllOfAVertexIsSaved) {
  const std::vector<PathVertex> vertices = randomVertices(50);
  const auto read = loadVertices(Archive::parse("v", savedVertexFile(vertices)), "vertices");
  ASSERT_EQ(read.size(), vertices.size());
  EXPECT_TRUE(sameBits(read.data(), vertices.data(), vertices.size()));
}

TEST(SavedFields, VerticesOfAnOlderVersionHaveDefaults) {
  std::vector<PathVertex> vertices = randomVertices(50);
  const Archive file =
      olderFile(savedVertexFile(vertices), {"vertices.roughness", "vertices.wi", "vertices.discrete"});
  const std::vector<PathVertex> read = loadVertices(file, "vertices");
  for (PathVertex& v : vertices) {
    v.roughness = 1;
    v.wi = {};
    v.discrete = false;
  }
  ASSERT_EQ(read.size(), vertices.size());
  EXPECT_TRUE(sameBits(read.data(), vertices.data(), vertices.size()));
}

GuideOptions fieldOptions() {
  GuideOptions options;
  options.lightGroups = 2;
  options.cached = true;
  options.cachedError = 0.5f;
  options.clamp = 15;
  options.priorSamples[1] = 100;
  return options;
}

std::vector<PathVertex> fieldVertices() {
  std::vector<PathVertex> vertices = floorUnderPatch(kBright, 5000, 3);
  for (size_t i = 0; i < vertices.size(); ++i) {
    vertices[i].pixel = uint32_t(i);
    vertices[i].lightGroup = i % 2;
    vertices[i].lightGroupProbability = 0.5f;
    vertices[i].direct = {i % 2 ? 1.0f : 0.1f, 1, 1};
  }
  return vertices;
}

TEST(SavedFields, AGuideOfAnOlderVersionHasDefaults) {
  GuideBuilder builder(fieldOptions());
  builder.add(fieldVertices());
  const Guide guide = builder.build();
  ArchiveWriter writer("guide");
  guide.save(writer);
  const std::string saved = test::bytesOf(writer);
  EXPECT_TRUE(sameGuide(Guide::load(olderFile(saved, {})), guide));
  const Guide older =
      Guide::load(olderFile(saved, {"guide.decisions.survivalFactor", "guide.grid.inverseReach",
                                    "guide.cached.error", "guide.varianceRatio"}));
  const GuideView view = older.view();
  ASSERT_EQ(view.cellCount, guide.view().cellCount);
  EXPECT_EQ(view.grid.inverseReach, 0);
  EXPECT_EQ(older.predictedVarianceRatio(), 1);
  for (uint32_t c = 0; c < view.cellCount; ++c) {
    const CellDecisions &read = view.decisions[c], &had = guide.view().decisions[c];
    ASSERT_EQ(read.survivalFactor, INFINITY);
    ASSERT_TRUE(sameBits(read.bsdfFraction, had.bsdfFraction, kRoughnessClasses));
    ASSERT_EQ(read.learnedLightFraction, had.learnedLightFraction);
    ASSERT_EQ(view.cached[2 * c].error, INFINITY);
    ASSERT_EQ(view.cached[2 * c].radiance.x, guide.view().cached[2 * c].radiance.x);
  }
}

std::string savedBuilderFile() {
  GuideBuilder builder(fieldOptions());
  builder.add(fieldVertices());
  ArchiveWriter writer("builder");
  builder.save(writer);
  return test::bytesOf(writer);
}

// A saved file with another text of the same length in it.
Archive otherText(std::string bytes, const std::string& from, const std::string& to) {
  bytes.replace(bytes.find(from), from.size(), to);
  const uint32_t crc = crc32(std::string_view(bytes).substr(0, bytes.size() - 4));
  std::memcpy(&bytes[bytes.size() - 4], &crc, 4);
  return Archive::parse("other text", bytes);
}

TEST(SavedFields, ABuilderOfAnOlderVersionHasDefaults) {
  const std::string saved = savedBuilderFile();
  GuideBuilder same(fieldOptions());
  same.add(fieldVertices());
  const auto load = [&](const std::vector<std::string>& lacking) {
    return GuideBuilder::load(olderFile(saved, lacking), std::nullopt, libraryTasks());
  };
  EXPECT_EQ(load({}).options().clamp, 15);
  EXPECT_EQ(load({}).options().priorSamples[1], 100);
  EXPECT_TRUE(sameGuide(load({}).build(), same.build()));
  const Archive withoutClamp = otherText(saved, "map-clamp=15", "            ");
  EXPECT_EQ(GuideBuilder::load(withoutClamp, std::nullopt, libraryTasks()).options().clamp,
            GuideOptions().clamp);
  // Without what lights have brought, all groups are alike; maps are what they were.
  const Guide older = load({"part0.cells.finest.groupSquares", "part0.fractions.roughness",
                            "part0.cells.leftOut", "part0.cells.counts.twice"})
                          .build();
  const GuideView view = older.view();
  ASSERT_EQ(view.cellCount, same.build().view().cellCount);
  EXPECT_TRUE(sameBits(view.maps, same.build().view().maps, view.cellCount * kMapShares));
  EXPECT_FALSE(sameBits(view.lightTables, same.build().view().lightTables, 3 * view.cellCount));
}

void expectFileError(const Archive& file, const std::string& part) {
  try {
    GuideBuilder::load(file, std::nullopt, libraryTasks());
    ADD_FAILURE() << part;
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(SavedFields, WhatCannotBeIsRefused) {
  const std::string saved = savedBuilderFile();
  expectFileError(olderFile(saved, {"part0.cells.keys"}), "part0.cells.keys");
  expectFileError(Archive::parse("v", savedVertexFile(randomVertices(3))), "expected a \"builder\"");
  const auto replaced = [&](const std::string& name, const auto& value) {
    std::string bytes = saved;
    const size_t at = bytes.find(name) + name.size() + sizeof(uint32_t) + sizeof(uint64_t);
    std::memcpy(&bytes[at], &value, sizeof value);
    const uint32_t crc = crc32(std::string_view(bytes).substr(0, bytes.size() - 4));
    std::memcpy(&bytes[bytes.size() - 4], &crc, 4);
    return Archive::parse("replaced", bytes);
  };
  expectFileError(otherText(saved, "map-clamp=15", "map-clamp=-1"), "map-clamp: found \"-1\"");
  expectFileError(otherText(saved, "map-clamp=15", "map-clamq=15"), "there is no setting");
  expectFileError(replaced("part0.fractions.discrete", uint8_t(2)), "discrete: is damaged");
  expectFileError(replaced("builder.model", uint64_t(1)), "another model");
  expectFileError(replaced("builder.own", uint64_t(1)), "builder.own");
}

// Bytes that were changed, with a checksum that fits them: what is read either works or is refused.
TEST(SavedFields, DamagedBuildersAreHarmless) {
  const std::string saved = savedBuilderFile();
  std::mt19937 engine(5);
  int refused = 0;
  for (int i = 0; i < 60; ++i) {
    std::string bytes = saved;
    const size_t range = i % 2 ? bytes.size() - 4 : 3000;  // names and options are near the begin
    for (int k = 0; k < 3; ++k) bytes[engine() % range] = char(engine());
    const uint32_t crc = crc32(std::string_view(bytes).substr(0, bytes.size() - 4));
    std::memcpy(&bytes[bytes.size() - 4], &crc, 4);
    try {
      GuideBuilder builder =
          GuideBuilder::load(Archive::parse("damaged", bytes), std::nullopt, libraryTasks());
      builder.build();
      builder.add(fieldVertices());
      builder.build();
    } catch (const FileError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 10);
  EXPECT_LT(refused, 60);
}

}  // namespace
}  // namespace odis::core
