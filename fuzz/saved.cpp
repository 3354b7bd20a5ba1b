// Saved guides, builders, vertices and frames: as they are, and with a checksum that is made right, so that
// damage gets behind it. What loads is looked into, and used as a host does.
#include "learn/inspect/saved_output.h"
#include "odis/api/objects.h"
#include "odis/files/crc32.h"
#include "odis/frame.h"
#include "odis/saved_frame.h"
#include "odis/saved_vertices.h"

namespace {

using namespace odis;
using core::Archive;

// No file has cells everywhere: these places lie where those of the corpus have some.
void lookUp(const GuideView& view, const Float3& position, const Float3& normal) {
  const uint32_t cell = findCell(view, {position, normal, 0, 0});
  if (cell == kNoCell) return;
  const CellDecisions& decisions = view.decisions[cell];
  const float fraction = bsdfFraction<float>(view, int(cell), 0.3f);
  const float survival = survivalProbability(view.rules, decisions.survivalFactor, 0.5f);
  if (!(fraction > 0 && fraction <= 1 && survival > 0 && survival <= 1)) std::abort();
  const SamplingMap<float> map(view.maps, int(cell));
  const auto sample = map.sample(0.3f, 0.7f);
  if (!(sample.pdf > 0 && map.pdf(sample.wi) > 0)) std::abort();
  const LearnedLights lights = learnedLights(view, cell);
  for (uint32_t group = 0; lights.cdf && group < view.lightGroups; ++group)
    if (!(lights.cdf[group] <= lights.cdf[group + 1])) std::abort();
}

void lookUp(const GuideView& view) {
  for (const float x : {0.1f, 0.5f, 0.9f})
    for (const float z : {-1.0f, 1.0f}) lookUp(view, {x, 1 - x, 0}, {0, 0, z});
}

// A few passes, of each of which little is traced.
void goOn(core::Frame& frame, uint32_t pixels, bool interrupted) {
  constexpr int kMostPasses = 4;
  constexpr uint32_t kMostPixels = 8;
  for (int i = 0; i < kMostPasses; ++i) {
    const core::FramePass* pass = frame.beginPass();
    if (!pass) return;
    lookUp(*pass->guide);
    for (uint32_t pixel = 0; pixel < std::min(pixels, kMostPixels); ++pixel) {
      const SampleRange range = frame.samples(pixel);
      if (range.count == 0) continue;
      const core::FrameSample sample{pixel, range.first, {1, 2, 3}, 2};
      PathVertex vertex;
      vertex.position = {0.5f, 0.5f, 0};
      vertex.normal = vertex.wi = {0, 0, 1};
      vertex.radiance = {1, 1, 1};
      vertex.pdf = 1;
      vertex.pixel = pixel;
      vertex.sample = range.first;
      vertex.depth = 1;
      frame.add({&sample, 1}, {&vertex, 1});
    }
    frame.endPass(interrupted);
  }
}

void readFrame(const Archive& file) {
  const bool hasMeans = core::loadOptions(file).keepPixelMeans;
  const bool networks = file.value<uint64_t>("frame.model") != 0;
  for (const bool interrupted : {true, false}) {
    core::Frame frame =
        core::Frame::load(file, networks ? std::nullopt : std::optional(core::Model()), core::threadTasks(1));
    const core::FrameStatistics size = frame.summary();
    const uint32_t pixels = size.width * size.height;
    goOn(frame, pixels, interrupted);
    for (uint32_t pixel = 0; hasMeans && pixel < pixels; ++pixel) frame.mean(pixel);
    core::ArchiveWriter again("frame");
    frame.save(again);
  }
}

void readBuilder(const Archive& file) {
  const bool networks = file.value<uint64_t>("builder.model") != 0;
  core::GuideBuilder builder = core::GuideBuilder::load(
      file, networks ? std::nullopt : std::optional(core::Model()), core::threadTasks(1));
  const core::Guide guide = builder.build();
  lookUp(guide.view());
  core::ArchiveWriter again("builder");
  builder.save(again);
}

void readAll(const std::string& bytes) {
  try {
    const Archive file = Archive::parse("fuzz.saved", bytes);
    learn::SavedInspection seen = learn::inspectSaved(file);
    if (seen.guide && seen.guide->guide.view().cellCount > 0) {
      lookUp(seen.guide->guide.view());
      try {
        seen.cell = learn::inspectCell(seen, {0.5f, 0.5f, 0}, {});
      } catch (const render::OptionError&) {
      }
    }
    learn::savedText(seen, "fuzz");
    learn::toJson(seen).dump();
    if (file.kind() == "frame") readFrame(file);
    if (file.kind() == "builder") readBuilder(file);
  } catch (const core::FileError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  if (size < 4) return 0;
  readAll(bytes);
  const uint32_t crc = core::crc32(std::string_view(bytes).substr(0, size - 4));
  for (size_t byte = 0; byte < 4; ++byte) bytes[size - 4 + byte] = char(uint8_t(crc >> (8 * byte)));
  readAll(bytes);
  return 0;
}
