// Guides, vertices and frames in files: what is read is what was written, and a frame goes on where it was.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

#include "api/api_scene.h"
#include "frame/run_frame.h"
#include "odis/files/crc32.h"
#include "support/models.h"
#include "support/temporary_folder.h"

namespace odis::test {
namespace {

std::string readAll(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void writeAll(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
}

// `bytes` without their last four, which are made the checksum of the others.
void writeWithChecksum(const std::string& path, std::string bytes) {
  bytes.resize(bytes.size() - 4);
  const uint32_t crc = core::crc32(bytes);
  for (int byte = 0; byte < 4; ++byte) bytes.push_back(char(uint8_t(crc >> (8 * byte))));
  writeAll(path, bytes);
}

TEST(ApiFiles, AGuideIsReadAsItWasWritten) {
  const TemporaryFolder folder;
  const std::string path = folder.path("a.guide");
  GuideOptions options;
  options.lightGroups = 2;
  options.set("cached=on cached-error=0.5");
  options.set("cells=2");  // so that each cell has vertices enough to be trusted
  GuideBuilder builder(options);
  std::vector<OdisPathVertex> vertices = apiVertices();
  for (size_t i = 0; i < vertices.size(); ++i) {
    vertices[i].pixel = uint32_t(i);
    vertices[i].lightGroup = i % 2;
    vertices[i].lightGroupProbability = 0.5f;
    vertices[i].direct = {i % 2 ? 1.0f : 0.1f, 1, 1};
  }
  builder.add(vertices);
  const Guide guide = builder.build();
  guide.save(path);
  const Guide read = Guide::load(path);
  const GuideView a = guide.view(), b = read.view();
  EXPECT_TRUE(sameBits(a, b));
  EXPECT_EQ(std::memcmp(a.lightTables, b.lightTables, a.cellCount * 3 * sizeof(float)), 0);
  EXPECT_EQ(guide.predictedVarianceRatio(), read.predictedVarianceRatio());
  EXPECT_EQ(std::memcmp(a.cached, b.cached, 2 * a.cellCount * sizeof(CachedRadiance)), 0);
  EXPECT_EQ(b.rules.cachedError, 0.5f);
  for (const OdisPathVertex& v : vertices) {
    const OdisPlace place{v.position, v.normal, v.pixel, v.sample};
    const GuidedVertex vertex(b, place, 1);
    EXPECT_EQ(findCell(a, place), vertex.cell());
    OdisFloat3 radiance;
    EXPECT_FALSE(vertex.cachedRadiance(1e-6f, 0, radiance));
    ASSERT_TRUE(vertex.cachedRadiance(1e-6f, 1e6f, radiance));
    EXPECT_GT(luminance(radiance), 0);
  }
}

TEST(ApiFiles, VerticesAreReadAsTheyWereWritten) {
  const TemporaryFolder folder;
  const std::string path = folder.path("a.vertices");
  const OdisPathVertices described = describe(apiVertices());
  ASSERT_TRUE(odisSaveVertices(&described, path.c_str()));
  std::vector<OdisPathVertex> read(odisLoadVertices(path.c_str(), nullptr, 0));
  ASSERT_EQ(read.size(), apiVertices().size());
  EXPECT_EQ(odisLoadVertices(path.c_str(), read.data(), read.size()), read.size());
  EXPECT_EQ(std::memcmp(read.data(), apiVertices().data(), read.size() * sizeof read[0]), 0);
}

// Traces a pass, but no more pixels than these; pixels whose samples are in are passed over.
void tracePartOfPass(Frame& frame, const FramePass& pass, const ToyHost& host, uint32_t pixels) {
  PathRecorder recorder;
  for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
    std::vector<FrameSample> samples;
    const SampleRange range = frame.samples(pixel);
    for (uint32_t i = 0; i < range.count; ++i)
      samples.push_back(host.trace(pass, pixel, range.first + i, recorder));
    frame.add(samples, recorder.finish());
  }
}

// A frame that is saved and loaded in every pass, within it or before it, has the image of one that is not.
TEST(ApiFiles, ASavedFrameGoesOnWithTheSameBits) {
  const TemporaryFolder folder;
  const std::string path = folder.path("a.frame");
  const ToyRoom room;
  for (const bool network : {true, false}) {
    FrameOptions options = toyOptions(40, 24, 8);
    options.seed = 5;
    options.set("pilot-vertices=kept");
    if (!network) options.guide.model = makeModel(nullptr, nullptr);
    const uint32_t pixels = options.width * options.height;
    Frame expected(options);
    runFrame(expected, options, room);
    const ToyHost host(room, options.width, options.height);
    Frame frame(options);
    for (int passes = 0;; ++passes) {
      frame.save(path);
      frame = Frame::load(path, options.guide.model);
      const FramePass* pass = frame.beginPass();
      if (!pass) break;
      tracePartOfPass(frame, *pass, host, pixels * 2 / 3);
      frame.save(path);
      frame = Frame::load(path, options.guide.model);
      frame.save(path);  // once more, before the rest of the pass begins
      frame = Frame::load(path, options.guide.model);
      pass = frame.beginPass();
      ASSERT_NE(pass, nullptr);
      uint32_t done = 0;
      for (uint32_t pixel = 0; pixel < pixels; ++pixel) done += frame.samples(pixel).count == 0;
      EXPECT_GE(done, 1u) << "pass " << passes;
      runPass(frame, *pass, host, pixels);
      frame.endPass();
    }
    EXPECT_EQ(luminances(frame, options), luminances(expected, options));
    EXPECT_TRUE(sameBits(frame.guide().view(), expected.guide().view()));
    EXPECT_EQ(frame.vertexCounts().accepted, expected.vertexCounts().accepted);
    EXPECT_EQ(frame.pilotVertices().size(), expected.pilotVertices().size());
    EXPECT_EQ(frame.statistics().samples, expected.statistics().samples);
  }
}

TEST(ApiFiles, AFrameWithoutAGuideIsSavedToo) {
  const TemporaryFolder folder;
  const std::string path = folder.path("a.frame");
  FrameOptions options = toyOptions(20, 20, 8);
  options.set("guided=off");
  Frame expected(options), frame(options);
  const ToyRoom room;
  runFrame(expected, options, room);
  frame.save(path);
  frame = Frame::load(path, Model());
  runFrame(frame, options, room);
  EXPECT_EQ(luminances(frame, options), luminances(expected, options));
}

TEST(ApiFiles, OtherFilesAreRefused) {
  const TemporaryFolder folder;
  const std::string guide = folder.path("a.guide"), frame = folder.path("a.frame"),
                    broken = folder.path("broken");
  GuideBuilder builder;
  builder.add(apiVertices());
  builder.build().save(guide);
  FrameOptions options = toyOptions(8, 8, 2);
  Frame(options).save(frame);
  const OdisContext context = Context::shared().get();
  const auto expectRefused = [&](const std::string& path, const std::string& part) {
    std::string message;
    EXPECT_EQ(odisLoadGuide(context, path.c_str()), nullptr);
    EXPECT_EQ(takeError(&message), ODIS_ERROR_FILE);
    EXPECT_NE(message.find(path), std::string::npos) << message;
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  expectRefused(folder.path("absent"), "there is no such file");
  expectRefused(folder.path(""), "regular file");
  expectRefused(frame, "found a saved \"frame\", expected a \"guide\"");
  writeAll(broken, "no archive at all");
  expectRefused(broken, "ODISSAVE");
  std::string bytes = readAll(guide);
  bytes[bytes.size() / 2] ^= 1;
  writeAll(broken, bytes);
  expectRefused(broken, "damaged");
  writeAll(broken, readAll(guide).substr(0, 100));
  expectRefused(broken, "damaged");
  EXPECT_FALSE(odisSaveGuide(builder.build().get(), folder.path("no/such/folder").c_str()));
  EXPECT_EQ(takeError(), ODIS_ERROR_FILE);
  EXPECT_EQ(odisLoadFrame(context, frame.c_str(), formulas()), nullptr);
  std::string message;
  EXPECT_EQ(takeError(&message), ODIS_ERROR_FILE);
  EXPECT_NE(message.find("another model"), std::string::npos) << message;
  EXPECT_FALSE(std::filesystem::exists(guide + ".part"));
}

// A map whose shares are not what they should be would draw directions with another density than it tells.
TEST(ApiFiles, MapsThatAreNoDensitiesAreRefused) {
  const TemporaryFolder folder;
  const std::string path = folder.path("a.guide");
  GuideBuilder builder;
  builder.add(apiVertices());
  builder.build().save(path);
  const std::string sound = readAll(path), name = "guide.maps";
  // Behind the name are the bytes of an element and the number of elements.
  const size_t maps = sound.find(name) + name.size() + sizeof(uint32_t) + sizeof(uint64_t);
  const auto isRead = [&](size_t share, uint16_t added) {
    std::string bytes = sound;
    uint16_t value;
    std::memcpy(&value, &bytes[maps + share * sizeof value], sizeof value);
    value = uint16_t(value + added);
    std::memcpy(&bytes[maps + share * sizeof value], &value, sizeof value);
    writeWithChecksum(path, bytes);
    const OdisGuide guide = odisLoadGuide(Context::shared().get(), path.c_str());
    std::string message;
    takeError(&message);
    EXPECT_EQ(message.find("guide.maps: are damaged") == std::string::npos, guide != nullptr) << message;
    odisReleaseGuide(guide);
    return guide != nullptr;
  };
  EXPECT_TRUE(isRead(0, 0));
  for (const size_t share : {0, 15, 16, 5 * kMapShares + 40}) {
    EXPECT_FALSE(isRead(share, 1)) << share;
    EXPECT_FALSE(isRead(share, 0xffff)) << share;
  }
}

// A host would look for the table that a cell promises.
TEST(ApiFiles, ACellThatPromisesATableOfLightsWhereThereIsNoneIsRefused) {
  const TemporaryFolder folder;
  const std::string path = folder.path("a.guide");
  GuideBuilder builder;
  builder.add(apiVertices());
  builder.build().save(path);
  std::string bytes = readAll(path);
  const std::string name = "guide.decisions.learnedLightFraction";
  const float promised = 0.5f;
  const size_t first = bytes.find(name) + name.size() + sizeof(uint32_t) + sizeof(uint64_t);
  std::memcpy(&bytes[first], &promised, sizeof promised);
  writeWithChecksum(path, bytes);
  EXPECT_EQ(odisLoadGuide(Context::shared().get(), path.c_str()), nullptr);
  std::string message;
  EXPECT_EQ(takeError(&message), ODIS_ERROR_FILE);
  EXPECT_NE(message.find("guide.decisions: are damaged"), std::string::npos) << message;
}

// Bytes that were changed, with a checksum that fits them: what is read either works or is refused.
void expectHarmlessDamage(const FrameOptions& options) {
  const TemporaryFolder folder;
  const std::string path = folder.path("a.frame");
  const ToyRoom room;
  const ToyHost host(room, options.width, options.height);
  Frame frame(options);
  const FramePass* pass = frame.beginPass();
  runPass(frame, *pass, host, 400);
  frame.endPass();
  pass = frame.beginPass();
  tracePartOfPass(frame, *pass, host, 350);
  frame.save(path);
  const std::string sound = readAll(path);
  std::mt19937 engine(3);
  int refused = 0;
  for (int i = 0; i < 120; ++i) {
    std::string bytes = sound;
    // Most of the file is numbers of any value; the others are near its begin.
    const size_t range = i % 2 ? bytes.size() - 4 : 1500;
    for (int k = 0; k < 3; ++k) bytes[engine() % range] = char(engine());
    writeWithChecksum(path, bytes);
    const OdisFrame read = odisLoadFrame(Context::shared().get(), path.c_str(), nullptr);
    refused += read == nullptr;
    if (read) {
      OdisFramePass next;
      if (odisBeginPass(read, &next)) odisEndPass(read, false);
    }
    takeError();
    odisReleaseFrame(read);
  }
  EXPECT_GT(refused, 15);
  EXPECT_LT(refused, 120);
}

TEST(ApiFiles, DamageThatTheChecksumDoesNotShowIsHarmless) {
  FrameOptions options = toyOptions(20, 20, 8);
  expectHarmlessDamage(options);
  options.keepPixelMeans = false;
  expectHarmlessDamage(options);
}

}  // namespace
}  // namespace odis::test
