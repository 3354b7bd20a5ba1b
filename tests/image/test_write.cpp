// Round trips of EXR and PNG.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <tbb/global_control.h>

#include <csignal>
#include <fstream>

#include "image/files.h"
#include "render/files/replace_file.h"
#include "render/image/image.h"
#include "render/image/tonemap.h"
#include "render/image/write.h"
#include "support/temporary_folder.h"

namespace odis::render {
namespace {

std::vector<float> ramp(int count, float step, float first = 0) {
  std::vector<float> result(count);
  for (int i = 0; i < count; ++i) result[i] = first + float(i) * step;
  return result;
}

TEST(WriteExr, KeepsLayersMetadataAndCrop) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path("crop.exr");
  const ImageWindow window{40, 30, 7, 5, 6, 4};
  const std::vector<float> r = ramp(24, 0.37f), depth = ramp(24, 1e5f), albedo = ramp(24, 0.01f);
  writeExr(path, window, {{"depth.Z", depth.data()}, {"R", r.data()}, {"albedo.R", albedo.data(), true}},
           {{"odis.command", "render \"a b\""}, {"odis.spp", "16"}, {"empty", ""}});
  const ExrFile file = readExr(path);
  EXPECT_EQ(file.window.fullWidth, 40);
  EXPECT_EQ(file.window.fullHeight, 30);
  EXPECT_EQ(file.window.x, 7);
  EXPECT_EQ(file.window.y, 5);
  EXPECT_EQ(file.window.width, 6);
  EXPECT_EQ(file.window.height, 4);
  ASSERT_EQ(file.channels.size(), 3u);
  EXPECT_EQ(file.channels.at("R"), r);            // 32 bits: exact
  EXPECT_EQ(file.channels.at("depth.Z"), depth);  // beyond what 16 bits hold
  bool rounded = false;
  for (int i = 0; i < 24; ++i) {
    EXPECT_NEAR(file.channels.at("albedo.R")[i], albedo[i], albedo[i] * 0x1p-11f);
    rounded |= file.channels.at("albedo.R")[i] != albedo[i];
  }
  EXPECT_TRUE(rounded) << "asked for 16 bits, got more";
  EXPECT_EQ(file.metadata.at("odis.command"), "render \"a b\"");
  EXPECT_EQ(file.metadata.at("odis.spp"), "16");
  EXPECT_EQ(file.metadata.at("empty"), "");
}

TEST(WriteExr, HalfKeepsFiniteNumbersFinite) {
  const test::TemporaryFolder folder;
  const std::vector<float> data = {1e6f, -1e6f, INFINITY, NAN};
  writeExr(folder.path("half.exr"), {4, 1, 0, 0, 4, 1}, {{"Y", data.data(), true}}, {});
  const std::vector<float> read = readExr(folder.path("half.exr")).channels.at("Y");
  EXPECT_EQ(read[0], 65504.0f);
  EXPECT_EQ(read[1], -65504.0f);
  EXPECT_TRUE(std::isinf(read[2]));
  EXPECT_TRUE(std::isnan(read[3]));
}

TEST(WriteExr, FailsWithPathAndReasonAndLeavesNothing) {
  const test::TemporaryFolder folder;
  const std::vector<float> data = {1};
  const ImageWindow one{1, 1, 0, 0, 1, 1};
  const auto message = [&](const std::string& path, const ImageWindow& window,
                           const std::vector<ImageChannel>& channels,
                           const std::map<std::string, std::string>& metadata) {
    try {
      writeExr(path, window, channels, metadata);
    } catch (const std::runtime_error& e) {
      return std::string(e.what());
    }
    return std::string("written");
  };
  const std::string path = folder.path("a.exr");
  EXPECT_NE(message(folder.path("no/such/a.exr"), one, {{"R", data.data()}}, {}).find("no/such/a.exr"),
            std::string::npos);
  EXPECT_NE(message(path, {1, 1, 0, 0, 0, 1}, {{"R", data.data()}}, {}).find("pixels"), std::string::npos);
  EXPECT_NE(message(path, one, {}, {}).find("without channels"), std::string::npos);
  EXPECT_NE(message(path, one, {{"R", data.data()}, {"R", data.data()}}, {}).find("\"R\""),
            std::string::npos);
  EXPECT_NE(message(path, one, {{"R", data.data()}}, {{"compression", "x"}}), "written");
  EXPECT_TRUE(folder.isEmpty());
}

TEST(WriteExr, ReplacesAnOldFile) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path("a.exr");
  for (float value : {1.0f, 2.0f}) writeExr(path, {1, 1, 0, 0, 1, 1}, {{"R", &value}}, {});
  EXPECT_EQ(readExr(path).channels.at("R")[0], 2.0f);
}

TEST(WriteExr, WritesTheSameBytesByAnyNumberOfThreads) {
  const test::TemporaryFolder folder;
  const std::vector<float> r = ramp(90 * 70, 0.37f), g = ramp(90 * 70, -1.1f, 5);
  std::vector<std::string> files;
  for (const size_t threads : {1, 2, 5}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const std::string path = folder.path("a.exr");
    writeExr(path, {90, 70, 0, 0, 90, 70}, {{"R", r.data()}, {"G", g.data(), true}}, {{"note", "a"}});
    files.push_back(bytesOf(path));
    EXPECT_EQ(readExr(path).channels.at("R"), r);
  }
  EXPECT_TRUE(files[0] == files[1] && files[0] == files[2]);
}

// A program that is killed while it writes leaves the old file, and beside it the part that it wrote.
TEST(ReplaceFile, KeepsTheOldFileIfKilled) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path("a.txt");
  std::ofstream(path) << "old";
  const pid_t child = fork();
  if (child == 0) {
    replaceFile(path, [](CheckedStream& stream) {
      stream.write("ne", 2);
      raise(SIGKILL);
    });
    _exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status));
  std::ifstream stream(path);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), "old");
}

TEST(WritePng, StoresTheToneMappedImage) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path("a.png");
  const std::vector<Rgb> pixels = {{0.1f, 0.2f, 0.3f}, {3, 0, -1}, {NAN, 1, 0.5f}, {0, 0, 0}};
  for (ToneMap toneMap : {ToneMap::clamp, ToneMap::filmic})
    for (float exposure : {0.0f, 1.0f}) {
      writePng(path, 2, 2, pixels.data(), exposure, toneMap);
      const auto image = Image::read(path, false, {});
      ASSERT_EQ(image->width(), 2);
      ASSERT_EQ(image->channels(), 3);
      for (int i = 0; i < 4; ++i)
        for (int c = 0; c < 3; ++c) {
          const float linear = pixels[i][c] * std::exp2(exposure);
          const uint8_t expected = toByte(toneMap == ToneMap::filmic ? filmicCurve(linear) : linear);
          EXPECT_NEAR(image->rgb(i % 2, i / 2)[c], float(expected) / 255.0f, 1e-6f) << i << ", " << c;
        }
    }
}

TEST(WritePng, FailsWithPathAndReasonAndLeavesNothing) {
  const test::TemporaryFolder folder;
  const Rgb pixel(0.5f);
  EXPECT_THROW(writePng(folder.path("no/a.png"), 1, 1, &pixel), std::runtime_error);
  EXPECT_THROW(writePng(folder.path("a.png"), 0, 1, &pixel), std::runtime_error);
  EXPECT_TRUE(folder.isEmpty());
}

TEST(ReadExr, NamesTheFileThatItCannotRead) {
  try {
    readExr("/no/such/file.exr");
    FAIL() << "read";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("/no/such/file.exr"), std::string::npos);
  }
}

}  // namespace
}  // namespace odis::render
