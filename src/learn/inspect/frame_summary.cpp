#include <fmt/format.h>

#include <algorithm>

#include "learn/inspect/summaries.h"
#include "odis/models/model.h"
#include "odis/options/settings.h"

namespace odis::learn {

namespace {

// What differs from the defaults.
std::vector<ChosenOption> chosenOptions(const core::FrameOptions& saved) {
  const core::FrameOptions usual;
  std::vector<ChosenOption> chosen;
  noteOption(chosen, "samplesPerPixel", saved.samplesPerPixel, usual.samplesPerPixel);
  noteOption(chosen, "mostSamplesPerPixel", saved.mostSamplesPerPixel, usual.mostSamplesPerPixel);
  noteOption(chosen, "seed", saved.seed, usual.seed);
  noteOption(chosen, "keepPixelMeans", saved.keepPixelMeans, usual.keepPixelMeans);
  noteOption(chosen, "tileOffsetX", saved.tileOffsetX, usual.tileOffsetX);
  noteOption(chosen, "tileOffsetY", saved.tileOffsetY, usual.tileOffsetY);
  noteGuideOptions(chosen, saved.guide);
  noteSettings(chosen, core::settingsText(saved));
  return chosen;
}

// Where a frame is between its first sample and its last.
std::string stateText(const core::SavedFrame& saved) {
  const core::FramePosition& at = saved.position;
  const uint32_t all = saved.schedule.end();
  if (at.finished) return "ended before it was complete";
  if (at.next == ODIS_PASS_GUIDED && at.done >= all) return "complete";
  const std::string where = saved.pass ? "within " : "before ";
  if (at.next == ODIS_PASS_PILOT) return where + "the pilot";
  if (at.next == ODIS_PASS_ORACLE)
    return where + fmt::format("one of {} passes of the oracle", saved.options.oracleSamples());
  return where + fmt::format("a guided pass: samples {} to {} of at most {} after the pilot", at.done + 1,
                             saved.schedule.passEnd(at.done), all);
}

std::optional<VertexSummary> keptVertices(const core::VertexTiles& tiles) {
  const std::vector<ArrayView<const PathVertex>> parts(tiles.begin(), tiles.end());
  VertexSummary summary = summarizeVertices(parts);
  if (summary.count == 0) return std::nullopt;
  return summary;
}

std::optional<VertexCounts> countsTaken(const std::vector<core::VertexSamples>& tiles) {
  if (core::vertexCount(tiles) == 0) return std::nullopt;
  return core::countsOf(tiles);
}

void addImage(FrameSummary& result, const core::SavedFrame& saved) {
  const auto pixels = uint32_t(saved.pixelCount);
  result.samples = saved.position.pilotSamplesTaken + saved.position.laterSamplesTaken;
  result.hasMeans = saved.options.keepPixelMeans;
  if (!result.hasMeans) {
    result.image.resize(pixels, render::Rgb(0, 0, 0));
    return;
  }
  result.fewest = UINT64_MAX;
  for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
    const PixelSums &pilot = saved.pilot.sums()[pixel], &later = saved.later.sums()[pixel];
    const WeightedSums parts[] = {
        {&pilot, core::pilotWeight(saved.options, saved.schedule, pixel, later.count)}, {&later, 1}};
    const Float3 color = weightedMean({parts, 2}).color;
    result.image.emplace_back(color.x, color.y, color.z);
    result.luminance += luminance(color) / double(pixels);
    const uint64_t samples = uint64_t(pilot.count) + later.count;
    result.rays += uint64_t(pilot.rays) + later.rays;
    result.fewest = std::min(result.fewest, samples);
    result.most = std::max(result.most, samples);
  }
}

}  // namespace

FrameSummary summarizeFrame(const core::SavedFrame& saved, const core::Archive& file) {
  FrameSummary result;
  result.width = saved.options.width;
  result.height = saved.options.height;
  result.options = chosenOptions(saved.options);
  result.model = saved.options.guided ? modelText(saved.modelId) : "none";
  result.state = stateText(saved);
  if (saved.pass) {
    result.tiles = saved.pass->tilesDone.size();
    for (const uint8_t done : saved.pass->tilesDone) result.tilesDone += done != 0;
    result.passVertices = countsTaken(saved.pass->samples);
  }
  addImage(result, saved);
  result.notFinite = saved.position.notFinite;
  result.guides = saved.position.guidesBuilt;
  result.vertexCounts = saved.vertexCounts;
  result.vertexCounts.outsideFrame += saved.position.outsideFrame;
  result.pilotVertices = keptVertices(saved.pilotVertices);
  if (saved.position.builder) result.builder = summarizeBuilder(file);
  result.hostBytes = saved.hostData.size();
  return result;
}

}  // namespace odis::learn
