// What any host saved, looked into without its model: what is shown is what was saved.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <set>
#include <sstream>

#include "learn/inspect/saved_output.h"
#include "odis/api/objects.h"
#include "odis/files/crc32.h"
#include "odis/floor_under_patch.h"
#include "odis/saved_frame.h"
#include "odis/saved_vertices.h"

namespace odis::learn {
namespace {

std::string bytesOf(const core::ArchiveWriter& file) {
  std::ostringstream stream;
  file.write(stream);
  return stream.str();
}

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
  builder.build().save(file);
  return bytesOf(file);
}

// A builder that another one was merged into.
std::string savedBuilder(const core::GuideOptions& options) {
  core::GuideBuilder builder(options), other(options);
  for (core::GuideBuilder* each : {&builder, &other}) {
    each->setBounds({0, 0, 0}, {1, 1, 1});
    each->add(litFloor(20));
  }
  other.setPartId(7);
  const core::GuideBuilder* others[] = {&other};
  builder.merge({others, 1});
  core::ArchiveWriter file("builder");
  builder.save(file);
  return bytesOf(file);
}

std::string savedVertices(const std::vector<PathVertex>& vertices) {
  core::ArchiveWriter file("vertices");
  core::saveVertices(file, "vertices", vertices);
  return bytesOf(file);
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
// are 1, all others 2. A frame that may go on is extended as soon as it is complete.
std::string savedFrame(const core::FrameOptions& options, int passes, uint32_t pixelsOfNext = 0) {
  core::Frame frame(options);
  for (int pass = 0; pass <= passes; ++pass) {
    if (frame.isComplete() && options.mostSamplesPerPixel > 0) frame.extend(20);
    if (pass == passes && pixelsOfNext == 0) break;
    const bool pilot = frame.beginPass()->kind == ODIS_PASS_PILOT;
    tracePixels(frame, pass < passes ? options.width * options.height : pixelsOfNext, pilot ? 1 : 2);
    if (pass < passes) frame.endPass();
  }
  core::ArchiveWriter file("frame");
  frame.save(file);
  return bytesOf(file);
}

core::FrameOptions frameOptions(uint32_t width, uint32_t height, const core::GuideOptions& guide) {
  core::FrameOptions options;
  options.width = width;
  options.height = height;
  options.guide = guide;
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

TEST(InspectSaved, AGuideIsWhatItsViewHas) {
  const SavedInspection seen = look(savedGuide(guideOptions(8), litFloor(4000)));
  EXPECT_EQ(seen.kind, "guide");
  ASSERT_TRUE(seen.guide);
  const GuideSummary& guide = *seen.guide;
  const GuideView view = guide.guide.view();
  EXPECT_EQ(guide.cells[0] + guide.cells[1] + guide.cells[2] + guide.cells[3], view.cellCount);
  EXPECT_GT(guide.cells[0], guide.cells[1]);
  // The diagonal of the floor [0, 1]^2 over 8.
  EXPECT_NEAR(guide.finestEdge, std::sqrt(2.0f) / 8, 5e-3f);
  EXPECT_LE(guide.bounds.low.x, 0);
  EXPECT_GE(guide.bounds.high.y, 1);
  for (const Quantiles& q : {guide.bsdfFraction[0], guide.entropy, guide.learnedLightFraction}) {
    EXPECT_LE(q.low, q.middle);
    EXPECT_LE(q.middle, q.high);
  }
  EXPECT_GT(guide.entropy.low, 0);
  EXPECT_LT(guide.entropy.high, 8);
  EXPECT_LT(guide.bsdfFraction[0].middle, 1);
  const std::string text = savedText(seen, "a.guide");
  for (const char* words : {"a.guide: a guide", "groups of lights         2", "BSDF fraction, glossy"})
    EXPECT_NE(text.find(words), std::string::npos) << text;
}

TEST(InspectSaved, ACellIsTheOneThatHostsFind) {
  SavedInspection seen = look(savedGuide(guideOptions(8), litFloor(4000)));
  const GuideView view = seen.guide->guide.view();
  const Float3 point{0.4f, 0.6f, 0}, up{0, 0, 1};
  for (const auto& normal : {std::optional<Float3>(), std::optional<Float3>(up)}) {
    seen.cell = inspectCell(seen, point, normal);
    EXPECT_EQ(seen.cell->cell, findCell(view, {point, up, 0, 0}));
    EXPECT_EQ(seen.cell->normal.z, 1);
  }
  const CellSummary& cell = *seen.cell;
  EXPECT_LE(std::abs(cell.middle.x - point.x), cell.edge / 2);
  ASSERT_EQ(cell.lights.size(), kGroups);
  EXPECT_GT(cell.lights[0], cell.lights[1]);
  EXPECT_NEAR(cell.lights[0] + cell.lights[1], 1, 1e-6);
  // The bright patch is in the map.
  const SquareMap& map = cell.map;
  ASSERT_EQ(map.side, kMapSize);
  const Float2 at = directionToSquare(core::kBright);
  EXPECT_GT(map.values[size_t(at.y * kMapSize) * kMapSize + size_t(at.x * kMapSize)], 4);
  const nlohmann::ordered_json json = toJson(seen);
  EXPECT_EQ(json["cell"]["map"]["values"].size(), size_t(kMapTexels));
  EXPECT_EQ(json["kind"], "guide");
  EXPECT_EQ(json["guide"]["cells"].size(), size_t(kCellLevels));
  EXPECT_NE(savedText(seen, "a.guide").find("learned, by group:"), std::string::npos);
  // Nothing faces downwards.
  EXPECT_THROW(inspectCell(seen, point, Float3{0, 0, -1}), render::OptionError);
  EXPECT_THROW(inspectCell(seen, {50, 0, 0}, std::nullopt), render::OptionError);
  EXPECT_THROW(inspectCell(look(savedVertices(litFloor(4))), point, up), render::OptionError);
}

TEST(InspectSaved, VerticesAreCounted) {
  std::vector<PathVertex> vertices = litFloor(100);
  vertices[0].discrete = true;
  vertices[1].radiance.y = NAN;
  vertices[2].pdf = 0;
  vertices[3].normal = {0, 0, 2};
  vertices[4].depth = 0;
  vertices[5].depth = 3;
  vertices[6].depth = 40;
  vertices[7].scattersBothSides = true;
  vertices[8].distance = 2;
  const SavedInspection seen = look(savedVertices(vertices));
  ASSERT_TRUE(seen.vertices);
  const VertexSummary& v = *seen.vertices;
  EXPECT_EQ(v.count, 100u);
  EXPECT_EQ(v.counts.accepted, 95u);
  for (const uint64_t refused : {v.counts.discrete, v.counts.notFinite, v.counts.noDensity, v.counts.notUnit,
                                 v.counts.noDepth, v.discrete, v.scattersBothSides})
    EXPECT_EQ(refused, 1u);
  EXPECT_EQ(v.depth, (std::array<uint64_t, 9>{97, 0, 1, 0, 0, 0, 0, 0, 1}));
  EXPECT_EQ(v.firstPixel, 5u);
  EXPECT_EQ(v.lastPixel, 99u);
  EXPECT_EQ(v.bounds.low.z, 0);
  EXPECT_LE(v.bounds.high.x, 1);
  EXPECT_EQ(v.distance.middle, INFINITY);
  EXPECT_NEAR(v.radiance.middle, 0.1f, 1e-6f);
  EXPECT_LT(v.pdf.high, 1 / core::kPi + 1e-6f);
  EXPECT_NE(savedText(seen, "a").find("95 taken, 1 discrete, 1 not finite"), std::string::npos);
  EXPECT_TRUE(toJson(seen)["vertices"]["quantiles"]["distance"][1].is_null());
}

TEST(InspectSaved, ABuilderTellsOfItsParts) {
  core::GuideOptions options = guideOptions(4);
  options.clamp = 5;
  const SavedInspection seen = look(savedBuilder(options));
  ASSERT_TRUE(seen.builder);
  ASSERT_EQ(seen.builder->parts.size(), 2u);
  EXPECT_EQ(seen.builder->own, 0u);
  EXPECT_EQ(seen.builder->parts[1].id, 7u);
  EXPECT_EQ(seen.builder->parts[1].counts.accepted, 20u);
  EXPECT_EQ(seen.builder->parts[1].unguided, 20u);
  EXPECT_GT(seen.builder->parts[1].cells[0], 0u);
  const std::string text = savedText(seen, "b");
  for (const char* words : {"b: a builder", "option map-clamp         5", "part                     7",
                            "directions by a network", "20 taken"})
    EXPECT_NE(text.find(words), std::string::npos) << text;
  const nlohmann::ordered_json json = toJson(seen);
  EXPECT_EQ(json["builder"]["parts"][1]["counts"]["accepted"], 20);
  EXPECT_EQ(json["builder"]["options"]["cells"], "4");
  EXPECT_THROW(inspectCell(seen, {0, 0, 0}, std::nullopt), render::OptionError);
}

TEST(InspectSaved, AFrameTellsWhereItIs) {
  const core::GuideOptions guide = guideOptions(8);
  core::FrameOptions options = frameOptions(40, 20, guide);
  options.samplesPerPixel = 8;
  options.pilotWeight = 0.5f;
  options.guidedCost = 0;  // refined in any case, so that there is a builder after the pilot
  const uint32_t pixels = options.width * options.height;
  const auto stateOf = [&](int passes, uint32_t pixelsOfNext) {
    return look(savedFrame(options, passes, pixelsOfNext)).frame->state;
  };
  EXPECT_EQ(stateOf(0, 0), "before the pilot");
  EXPECT_EQ(stateOf(0, pixels), "within the pilot");
  EXPECT_EQ(stateOf(1, 0), "before a guided pass: samples 1 to 1 of at most 7 after the pilot");

  const SavedInspection before = look(savedFrame(options, 0));
  EXPECT_EQ(before.guide->guide.view().cellCount, 0u);
  EXPECT_NE(savedText(before, "f").find("none is built yet"), std::string::npos);
  EXPECT_EQ(before.frame->most, 0u);

  const SavedInspection between = look(savedFrame(options, 1));
  const FrameSummary& f = *between.frame;
  EXPECT_EQ(f.width, 40u);
  EXPECT_EQ(f.tiles, 0u);
  EXPECT_EQ(f.fewest, 1u);
  EXPECT_EQ(f.samples, pixels);
  EXPECT_NEAR(f.luminance, 1, 1e-5);
  EXPECT_EQ(f.guides, 1u);
  ASSERT_TRUE(f.builder);
  ASSERT_EQ(f.builder->parts.size(), 1u);
  EXPECT_EQ(f.builder->parts[0].cells, between.guide->cells);
  EXPECT_EQ(f.builder->parts[0].counts.accepted, pixels);
  EXPECT_FALSE(f.pilotVertices);
  EXPECT_EQ(f.hostBytes, 0u);
  const std::string text = savedText(between, "f");
  for (const char* words : {"option samplesPerPixel   8", "option cells             8",
                            "directions by a network", "finest cells"})
    EXPECT_NE(text.find(words), std::string::npos) << text;
  EXPECT_EQ(text.find("option samples "), std::string::npos);
}

// Rows of 16 pixels are a row of tiles: here, all but the last one are in.
TEST(InspectSaved, AFrameWithinAPassHasItsWholeTiles) {
  const core::GuideOptions guide = guideOptions(8);
  core::FrameOptions options = frameOptions(32, 20, guide);
  options.pilotWeight = 0.5f;
  options.guidedCost = 0;  // or nothing would be guided
  const SavedInspection pilot = look(savedFrame(options, 0, 32 * 17));
  EXPECT_EQ(pilot.frame->tilesDone, 2u);
  EXPECT_EQ(pilot.frame->tiles, 4u);
  ASSERT_TRUE(pilot.frame->passVertices);
  EXPECT_EQ(pilot.frame->passVertices->accepted, 32u * 16);
  EXPECT_EQ(pilot.frame->image[0].x, 1);
  EXPECT_EQ(pilot.frame->image[32 * 16].x, 0);

  const SavedInspection guided = look(savedFrame(options, 1, 32 * 17));
  EXPECT_NE(guided.frame->state.find("within a guided pass"), std::string::npos);
  EXPECT_EQ(guided.frame->samples, 32u * 20 + 32u * 16);
  // A pilot's sample of 1 weighs half as much as a guided one of 2, as it will when all samples are in.
  EXPECT_NEAR(guided.frame->image[0].x, (0.5f * 1 + 2) / 1.5f, 1e-6f);
  EXPECT_EQ(guided.frame->image[32 * 16].x, 1);
  const nlohmann::ordered_json json = toJson(guided);
  EXPECT_EQ(json["frame"]["tilesDone"], 2);
  EXPECT_EQ(json["frame"]["options"]["pilot-weight"], "0.5");
}

TEST(InspectSaved, AFrameNeedsNoModel) {
  core::GuideOptions guide = guideOptions(8);
  guide.model = core::Model();
  const SavedInspection seen = look(savedFrame(frameOptions(20, 20, guide), 2));
  EXPECT_EQ(seen.frame->model, "formulas");
  EXPECT_GT(seen.guide->cells[0], 0u);
}

TEST(InspectSaved, DataOfTheHostIsMeasured) {
  const core::GuideOptions guide;
  core::ArchiveWriter file("frame");
  core::Frame frame(frameOptions(4, 4, guide));
  frame.setHostData(std::vector<uint8_t>(5));
  frame.save(file);
  const SavedInspection seen = look(bytesOf(file));
  EXPECT_EQ(seen.frame->hostBytes, 5u);
  EXPECT_NE(savedText(seen, "f").find("data of the host         5 bytes"), std::string::npos);
}

TEST(InspectSaved, PicturesShowTheMaps) {
  SavedInspection seen = look(savedGuide(guideOptions(16), litFloor(4000)));
  seen.cell = inspectCell(seen, {0.5f, 0.5f, 0}, std::nullopt);
  for (const MapColors colors : {MapColors::stops, MapColors::values})
    for (const Canvas& canvas :
         {drawCell(*seen.cell, "a.guide", colors), drawGuide(*seen.guide, "a.guide", colors)}) {
      std::set<float> different;
      for (const render::Rgb& c : canvas.pixels) different.insert(c.x);
      EXPECT_GT(different.size(), 50u);
    }
  // 64 maps in 8 rows.
  EXPECT_EQ(drawGuide(*seen.guide, "a.guide", MapColors::stops).height, 27 + 8 * (11 + 96 + 8) + 19);
}

TEST(InspectSaved, DamageIsRefused) {
  std::string bytes = savedGuide(guideOptions(1), litFloor(50));
  bytes[bytes.size() / 2] ^= 1;
  EXPECT_THROW(look(bytes), core::FileError);
  core::ArchiveWriter other("something else");
  EXPECT_THROW(look(bytesOf(other)), core::FileError);
  const core::GuideOptions guide = guideOptions(1);
  core::Frame frame(frameOptions(4, 4, guide));
  core::ArchiveWriter twice("frame");
  frame.save(twice);
  twice.addValue("frame.position", uint64_t(0));  // the last of a name counts
  EXPECT_THROW(look(bytesOf(twice)), core::FileError);
}

// A version of ODIS that takes samples in another order leaves such frames: this one would take some samples
// twice and others never.
TEST(InspectSaved, AFrameOfAnotherOrderOfSamplesIsRefused) {
  const core::GuideOptions guide = guideOptions(1);
  const std::string bytes = savedFrame(frameOptions(4, 4, guide), 1);
  auto position = Archive::parse("f", bytes).value<core::FramePosition>("frame.position");
  EXPECT_EQ(position.pilotSamples, 16u);
  for (const auto change :
       {+[](core::FramePosition& p) { --p.pilotSamples; }, +[](core::FramePosition& p) { ++p.passEnd; },
        +[](core::FramePosition& p) { ++p.spreadAfter; }}) {
    core::FramePosition changed = position;
    change(changed);
    std::string other = bytes;
    const std::string_view before(reinterpret_cast<const char*>(&position), sizeof(position));
    other.replace(other.find(before), sizeof(changed), reinterpret_cast<const char*>(&changed),
                  sizeof(changed));
    const uint32_t crc = core::crc32(std::string_view(other).substr(0, other.size() - 4));
    std::memcpy(other.data() + other.size() - 4, &crc, 4);
    try {
      look(other);
      ADD_FAILURE();
    } catch (const core::FileError& error) {
      EXPECT_NE(std::string(error.what()).find("takes samples in another order"), std::string::npos)
          << error.what();
    }
  }
}

// What the fuzzer begins from (fuzz/saved.cpp), as small as can be. Where what is saved has changed,
// ODIS_WRITE_SEEDS=1 makes the files anew.
TEST(InspectSaved, SeedsOfTheFuzzerAreRead) {
  const core::GuideOptions networks = guideOptions(1);
  core::GuideOptions simple = networks;
  simple.model = core::Model();
  const core::FrameOptions guided = frameOptions(4, 4, networks), formula = frameOptions(4, 4, simple);
  core::FrameOptions withoutGuide = formula, withoutMeans = guided, goesOn = formula;
  withoutGuide.guided = false;
  withoutMeans.keepPixelMeans = goesOn.keepPixelMeans = false;
  goesOn.samplesPerPixel = 1;
  goesOn.mostSamplesPerPixel = ODIS_UNLIMITED;
  const std::pair<std::string, std::string> seeds[] = {
      {"guide", savedGuide(networks, litFloor(50))},
      {"vertices", savedVertices(litFloor(4))},
      {"builder", savedBuilder(simple)},
      {"frame-without-guide", savedFrame(withoutGuide, 0, 16)},
      {"frame-without-means", savedFrame(withoutMeans, 1)},
      {"frame-extended", savedFrame(goesOn, 2)},
      {"frame-in-pilot", savedFrame(formula, 0, 16)},
      {"frame-guided", savedFrame(guided, 1)},
      {"frame-in-guided-pass", savedFrame(guided, 1, 16)},
      {"frame-by-formulas", savedFrame(formula, 2)}};
  for (const auto& [name, bytes] : seeds) {
    const std::string path = ODIS_SAVED_SEEDS "/" + name;
    if (std::getenv("ODIS_WRITE_SEEDS")) std::ofstream(path, std::ios::binary) << bytes;
    EXPECT_EQ(inspectSaved(Archive::load(path)).kind, look(bytes).kind) << name;
  }
}

}  // namespace
}  // namespace odis::learn
