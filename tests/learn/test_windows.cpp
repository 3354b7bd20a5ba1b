// Data sets of incident radiance: windows, their targets and their pilots.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "learn/data/dataset.h"
#include "learn/train/examples.h"
#include "learn/train/pixel_examples.h"
#include "render/files/replace_file.h"
#include "support/temporary_folder.h"

namespace odis::learn {
namespace {

// A matt wall under an even sky of radiance 1.
constexpr const char* kSky = R"(<scene version="3.0.0">
  <sensor type="perspective"><film type="hdrfilm"/></sensor>
  <shape type="rectangle"><transform name="to_world"><scale value="40"/><rotate y="1" angle="180"/>
    <translate z="9"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value="0.5"/></bsdf></shape>
  <emitter type="constant"><rgb name="radiance" value="1"/></emitter>
</scene>)";

DataSettings fewWindows() {
  DataSettings settings = DataSettings::quick().incidentRadiance();
  settings.windows.count = 3;
  settings.windows.leastPixels = 8000;
  settings.windows.mostPixels = 16000;
  settings.pilots = 2;
  settings.targets.pixels = 6;
  settings.targets.perTexel = 2;
  return settings;
}

class Windows : public ::testing::Test {
 protected:
  Windows() {
    std::filesystem::create_directories(m_folder.path("scene"));
    std::filesystem::create_directories(m_folder.path("data"));
    render::writeFile(m_folder.path("scene/scene.xml"), kSky);
    makeShard({"a", 3, nullptr, m_folder.path("scene")}, fewWindows(), Assets{}, m_folder.path("data"));
  }
  std::string file() const { return shardFile(m_folder.path("data"), "a"); }

  test::TemporaryFolder m_folder;
};

TEST(PlaceWindows, LieInTheImageAndRarelyOverEachOther) {
  WindowSettings settings;
  settings.count = 16;
  const std::vector<Window> windows = placeWindows(640, 360, settings, 5);
  ASSERT_EQ(windows.size(), 16u);
  int overlaps = 0;
  for (size_t i = 0; i < windows.size(); ++i) {
    EXPECT_GE(windows[i].x, 0);
    EXPECT_LE(windows[i].x, 640 - 32);
    EXPECT_GE(windows[i].y, 0);
    EXPECT_LE(windows[i].y, 360 - 32);
    for (size_t j = 0; j < i; ++j)
      overlaps += std::abs(windows[i].x - windows[j].x) < 32 && std::abs(windows[i].y - windows[j].y) < 32;
  }
  EXPECT_EQ(overlaps, 0);
  EXPECT_TRUE(placeWindows(31, 100, settings, 5).empty());
}

TEST(FoldMaps, AreMeansOverAllSamplesOfTheTexels) {
  Target target;
  target.samples.assign(kTargetTexels, 0);
  for (std::vector<float>* map : {&target.indirect, &target.indirectRms, &target.emission,
                                  &target.emissionRms, &target.lightPdf, &target.rays})
    map->assign(kTargetTexels, 0);
  // The four texels of the second column and third row, of 1, 3, 0 and 2 samples.
  const int texels[] = {4 * 32 + 2, 4 * 32 + 3, 5 * 32 + 2, 5 * 32 + 3};
  const uint8_t samples[] = {1, 3, 0, 2};
  for (int i = 0; i < 4; ++i) {
    target.samples[size_t(texels[i])] = samples[i];
    target.indirect[size_t(texels[i])] = target.indirectRms[size_t(texels[i])] = float(i + 1);
  }
  foldMaps(target);
  const size_t folded = 2 * 16 + 1;
  ASSERT_EQ(target.indirect.size(), size_t(kWindowMapTexels));
  EXPECT_EQ(target.samples[folded], 6);
  EXPECT_FLOAT_EQ(target.indirect[folded], (1 * 1 + 3 * 2 + 2 * 4) / 6.0f);
  EXPECT_FLOAT_EQ(target.indirectRms[folded], std::sqrt((1 * 1 + 3 * 4 + 2 * 16) / 6.0f));
  EXPECT_EQ(target.samples[folded + 1], 0);
}

TEST_F(Windows, HoldWhatTheDocumentsSay) {
  const ShardReader shard(file());
  EXPECT_EQ(shard.header().at("settings").at("kind"), "incident-radiance");
  EXPECT_EQ(shard.shape("view0/target/indirect"), (Shape{6, 16, 16}));
  EXPECT_EQ(shard.shape("view0/window/albedo"), (Shape{3, 3, 32, 32}));
  EXPECT_EQ(shard.shape("view0/window/depth"), (Shape{3, 32, 32}));
  const ViewFrame frame = viewFrame(shard, 0);
  const int width = shard.header().at("views").at(0).at("width");
  const auto x = shard.read<uint16_t>("view0/window/x"), y = shard.read<uint16_t>("view0/window/y"),
             windowOf = shard.read<uint16_t>("view0/target/window");
  std::vector<Pilot> pilots;
  for (size_t i = 0; i < 2; ++i) pilots.push_back(readColumns(shard, pilotPrefix(0, i), frame));
  const auto inWindow = [&](uint32_t pixel, size_t window, int margin) {
    const int dx = int(pixel) % width - x[window], dy = int(pixel) / width - y[window];
    return dx >= margin && dx < 32 - margin && dy >= margin && dy < 32 - margin;
  };
  // Pilots have paths in windows alone, and end with the first vertex that can be learned from.
  for (const Pilot& pilot : pilots) {
    EXPECT_FALSE(pilot.vertices.empty());
    size_t next = 0;
    for (size_t pixel = 0; pixel < pilot.lengths.size(); ++pixel) {
      if (pilot.lengths[pixel] == 0) continue;
      EXPECT_TRUE(inWindow(uint32_t(pixel), 0, 0) || inWindow(uint32_t(pixel), 1, 0) ||
                  inWindow(uint32_t(pixel), 2, 0));
      for (int i = 0; i + 1 < pilot.lengths[pixel]; ++i)
        EXPECT_FALSE(isUsable(pilot.vertices[next + size_t(i)]));
      next += pilot.lengths[pixel];
    }
  }
  // Under an even sky its radiance arrives from everywhere above the horizon.
  const std::vector<Target> targets = readTargets(shard, targetPrefix(0), frame);
  ASSERT_EQ(targets.size(), 6u);
  for (size_t i = 0; i < targets.size(); ++i) {
    const Target& target = targets[i];
    size_t at = target.vertex, pilot = 0;
    while (at >= pilots[pilot].vertices.size()) at -= pilots[pilot++].vertices.size();
    EXPECT_TRUE(inWindow(pilots[pilot].vertices[at].pixel, windowOf[i], 12));
    int above = 0, even = 0;
    for (size_t t = 0; t < size_t(kWindowMapTexels); ++t) {
      if (target.samples[t] == 0) continue;
      ++above;
      even += std::abs(target.indirect[t] + target.emission[t] - 1) < 0.01f;
    }
    EXPECT_GE(above, 128);
    EXPECT_EQ(even, above);
  }
}

TEST_F(Windows, AreTheSameBytesAgain) {
  const auto bytes = [](const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream all;
    all << stream.rdbuf();
    return all.str();
  };
  std::filesystem::create_directories(m_folder.path("again"));
  makeShard({"a", 3, nullptr, m_folder.path("scene")}, fewWindows(), Assets{}, m_folder.path("again"));
  EXPECT_EQ(bytes(shardFile(m_folder.path("again"), "a")), bytes(file()));
}

TEST_F(Windows, DontMixWithDataOfCells) {
  EXPECT_THROW(makeShard({"a", 3, nullptr, m_folder.path("scene")}, DataSettings::quick(), Assets{},
                         m_folder.path("data")),
               GenerateError);
}

TEST_F(Windows, AreNothingForTheNetworksOfCells) {
  EXPECT_THROW(makeExamples(ShardReader(file())), ShardError);
}

TEST_F(Windows, AreWhatTheNetworkAtPixelsLearnsFrom) {
  TrainConfig config;
  config.network = Network::pixels;
  config.tile = 4;
  PixelExamples examples(config, true);
  examples.add({file()});
  ASSERT_EQ(examples.size(), 6u);
  PixelBatch batch;
  examples.take(0, 6, batch);
  for (size_t row = 0; row < 6; ++row) {
    double mass = 0, square = 0, histogram = 0;
    const float* cosine = &batch.maps[row * kPixelMapNumbers + 6 * size_t(kMapTexels)];
    for (size_t t = 0; t < size_t(kMapTexels); ++t) {
      mass += batch.mass[row * kMapTexels + t];
      square += batch.square[row * kMapTexels + t];
      histogram += examples.histogram(row)[t];
      // Light comes from above.
      if (cosine[t] < -0.4f) EXPECT_EQ(batch.mass[row * kMapTexels + t], 0) << t;
    }
    EXPECT_NEAR(mass, 1, 0.01);
    EXPECT_NEAR(square, 1, 0.01);
    EXPECT_NEAR(histogram, 1, 0.01);
  }
  PixelBatch drawn, again;
  examples.draw(1, 5, 16, drawn);
  examples.draw(1, 5, 16, again);
  EXPECT_EQ(drawn.maps, again.maps);
  EXPECT_EQ(drawn.mass, again.mass);
}

TEST(MapSymmetries, TakeTexelsToTexels) {
  for (const auto& symmetry : mapSymmetries()) {
    std::vector<int> times(kMapTexels, 0);
    for (const uint8_t texel : symmetry) ++times[texel];
    for (const int count : times) EXPECT_EQ(count, 1);
  }
  for (size_t t = 0; t < size_t(kMapTexels); ++t) EXPECT_EQ(mapSymmetries()[0][t], t);
}

}  // namespace
}  // namespace odis::learn
