// What any host saved, looked into without its model: what is shown is what was saved.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <set>

#include "learn/inspect/saved_output.h"
#include "odis/api/objects.h"
#include "odis/floor_under_patch.h"
#include "odis/saved_vertices.h"

namespace odis::learn {
namespace {

using core::Archive;

constexpr uint32_t kGroups = 2;

// A floor under a bright patch, lit by two groups of lights of which one is much brighter.
std::vector<PathVertex> litFloor(int count) {
  std::vector<PathVertex> vertices = core::floorUnderPatch(core::kBright, count, 3);
  for (size_t i = 0; i < vertices.size(); ++i) {
    PathVertex& v = vertices[i];
    v.lightGroup = i % kGroups;
    v.lightGroupProbability = 0.5f;
    v.direct = {1, v.lightGroup == 0 ? 1.0f : 0.1f, 1};
    v.pixel = uint32_t(i);
  }
  return vertices;
}

std::string savedGuide(const core::GuideOptions& options, const std::vector<PathVertex>& vertices) {
  core::GuideBuilder builder(options);
  builder.add(vertices);
  core::ArchiveWriter file("guide");
  builder.build(vertices).save(file);
  return file.bytes();
}

std::string savedVertices(const std::vector<PathVertex>& vertices) {
  core::ArchiveWriter file("vertices");
  core::saveVertices(file, "vertices", vertices);
  return file.bytes();
}

// Hands over the samples of the first pixels, each gray of this value and with a vertex of the floor.
void tracePixels(core::Frame& frame, uint32_t pixels, float value) {
  const std::vector<PathVertex> floor = litFloor(997);
  for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
    const SampleRange range = frame.samples(pixel);
    for (uint32_t i = range.first; i < range.first + range.count; ++i) {
      const core::FrameSample sample{pixel, i, {value, value, value}, 2};
      PathVertex vertex = floor[(pixel * 7 + i) % floor.size()];
      vertex.pixel = pixel;
      vertex.sample = i;
      frame.add({&sample, 1}, {&vertex, 1});
    }
  }
}

// A frame after some passes, and within the next one if some of its pixels are traced. The pilot's samples
// are 1, all others 2.
std::string savedFrame(const core::FrameOptions& options, int passes, uint32_t pixelsOfNext = 0) {
  core::Frame frame(options);
  for (int pass = 0; pass <= passes; ++pass) {
    if (pass == passes && pixelsOfNext == 0) break;
    const bool pilot = frame.beginPass()->kind == ODIS_PASS_PILOT;
    tracePixels(frame, pass < passes ? options.width * options.height : pixelsOfNext, pilot ? 1 : 2);
    if (pass < passes) frame.endPass();
  }
  core::ArchiveWriter file("frame");
  frame.save(file);
  return file.bytes();
}

core::FrameOptions frameOptions(uint32_t width, uint32_t height, const core::GuideOptions& guide) {
  core::FrameOptions options;
  options.width = width;
  options.height = height;
  options.guide = &guide;
  return options;
}

core::GuideOptions guideOptions(int cellsPerDiagonal) {
  core::GuideOptions options;
  options.lightGroups = kGroups;
  options.cellsPerDiagonal = cellsPerDiagonal;
  return options;
}

SavedInspection look(const std::string& bytes) {
  return inspectSaved(Archive::parse("saved", bytes));
}

// What the fuzzer begins from (fuzz/saved.cpp), as small as can be. Where what is saved has changed,
// ODIS_WRITE_SEEDS=1 makes the files anew.
TEST(InspectSaved, SeedsOfTheFuzzerAreRead) {
  static OdisModelImpl formulas{core::Model()};
  const core::GuideOptions networks = guideOptions(1);
  core::GuideOptions simple = networks;
  simple.model = &formulas;
  const core::FrameOptions guided = frameOptions(4, 4, networks), formula = frameOptions(4, 4, simple);
  const std::pair<std::string, std::string> seeds[] = {
      {"guide", savedGuide(networks, litFloor(50))},      {"vertices", savedVertices(litFloor(4))},
      {"frame-in-pilot", savedFrame(formula, 0, 16)},     {"frame-guided", savedFrame(guided, 1)},
      {"frame-in-guided-pass", savedFrame(guided, 1, 16)}, {"frame-by-formulas", savedFrame(formula, 2)}};
  for (const auto& [name, bytes] : seeds) {
    const std::string path = ODIS_SAVED_SEEDS "/" + name;
    if (std::getenv("ODIS_WRITE_SEEDS")) std::ofstream(path, std::ios::binary) << bytes;
    EXPECT_EQ(inspectSaved(Archive::load(path)).kind, look(bytes).kind) << name;
  }
}

}  // namespace
}  // namespace odis::learn
