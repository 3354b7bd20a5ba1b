// What there is to see of a frame: the image, and numbers.
#include <algorithm>
#include <stdexcept>
#include <string>

#include "odis/frame_data.h"

namespace odis::core {

// All that comes after the pilot depends on it, how many samples a pixel has included. The pilot's share in
// its pixel must not: it stays what it would be if all pixels had as many samples.
float pilotWeight(const FrameOptions& options, const Schedule& schedule, uint32_t pixel, uint32_t later) {
  return later > 0 ? options.pilotWeight * schedule.remainingRatio(pixel) : 1;
}

PixelSamples keptOfPilot(const FrameOptions& options, const Schedule& schedule) {
  const size_t pixels = size_t(options.width) * options.height;
  return options.keepPixelMeans ? PixelSamples::sums(pixels)
                                : PixelSamples::few(pixels, schedule.mostPilotSamples());
}
// Counts are settled by the samples of the first pass, and guided ones compared with the pilot's.
PixelSamples keptOfLater(const FrameOptions& options, const Schedule& schedule) {
  const size_t pixels = size_t(options.width) * options.height;
  const uint32_t first = options.guided ? schedule.comparedAfter() : schedule.spreadAfter();
  return options.keepPixelMeans ? PixelSamples::sums(pixels)
                                : PixelSamples::few(pixels, std::min(first, schedule.mostRemaining()));
}

void Frame::Data::requireMeans(const char* function) const {
  if (!options.keepPixelMeans)
    throw std::logic_error(std::string(function) + ": expected a frame with OdisFrameOptions.keepPixelMeans");
}

uint32_t Frame::Data::pilotTaken(uint32_t pixel) const {
  if (options.keepPixelMeans) return pilot.sums()[pixel].count;
  return next == ODIS_PASS_PILOT ? 0 : schedule.pilotCount(pixel);
}
uint32_t Frame::Data::laterTaken(uint32_t pixel) const {
  return options.keepPixelMeans ? later.sums()[pixel].count : schedule.doneIn(pixel, done);
}

float Frame::sampleWeight(uint32_t pixel, uint32_t sample) const {
  const Data& d = *m_data;
  d.requirePixel(pixel, "odisGetSampleWeight");
  const uint32_t first = d.schedule.firstOfRound(pixel), end = d.schedule.sampleCount(pixel);
  if (sample < first || sample >= end)
    throw std::out_of_range("odisGetSampleWeight: expected a sample of the pixel from " +
                            std::to_string(first) + " to below " + std::to_string(end) + ", found " +
                            std::to_string(sample));
  return d.schedule.sampleWeight(pixel, sample < d.schedule.pilotCount(pixel), d.options.pilotWeight);
}

PixelMean Frame::mean(uint32_t pixel) const {
  const Data& d = *m_data;
  d.requirePixel(pixel, "odisGetPixelMean");
  d.requireMeans("odisGetPixelMean");
  const float pilotWeight = d.schedule.pilotCount(pixel) > 0 ? d.pilotWeightOf(pixel) : 1;
  const WeightedSums parts[] = {{&d.pilot.sums()[pixel], pilotWeight}, {&d.later.sums()[pixel], 1}};
  return weightedMean({parts, 2});
}

uint32_t Frame::sampleCount(uint32_t pixel) const {
  m_data->requirePixel(pixel, "odisGetSampleCount");
  return m_data->pilotTaken(pixel) + m_data->laterTaken(pixel);
}

FrameStatistics Frame::statistics() const {
  const Data& d = *m_data;
  FrameStatistics result = summary();
  double pilot = 0, all = 0;
  for (uint32_t pixel = 0; pixel < d.pixelCount; ++pixel) {
    const uint32_t pilotCount = d.pilotTaken(pixel);
    const double weight = pilotCount > 0 ? pilotCount * double(d.pilotWeightOf(pixel)) : 0;
    pilot += weight;
    all += weight + d.laterTaken(pixel);
  }
  result.pilotFraction = all > 0 ? pilot / all : 0;
  return result;
}

FrameStatistics Frame::summary() const {
  const Data& d = *m_data;
  FrameStatistics result;
  result.width = d.options.width;
  result.height = d.options.height;
  result.samples = d.pilotSamplesTaken + d.laterSamplesTaken;
  result.pilotSamples = d.pilotSamplesTaken;
  result.notFinite = d.notFinite;
  result.pilotVertices = d.pilotVertexCount;
  result.cells = d.guide.view().cellCount;
  result.guideBytes = d.guide.bytes();
  result.buildingBytes = d.buildingBytes;
  result.missingSamples = d.missingSamples;
  result.passesWithoutVertices = d.passesWithoutVertices;
  result.guidesBuilt = d.guidesBuilt;
  result.predictedVarianceRatio = d.guide.predictedVarianceRatio();
  result.measuredCostRatio = d.measuredCostRatio;
  result.guidingGivenUp = d.guidingGivenUp;
  result.samplesPerPixel = d.schedule.samplesPerPixel();
  return result;
}

VertexCounts Frame::vertexCounts() const {
  VertexCounts counts = m_data->vertexCounts;
  counts.outsideFrame += m_data->outsideFrame;
  counts.twice += m_data->twice;
  return counts;
}

const Guide& Frame::guide() const {
  return m_data->guide;
}

ArrayView<const PixelSums> Frame::pilotImage() const {
  m_data->requireMeans("odisGetPilotImage");
  return m_data->pilot.sums();
}

size_t Frame::pilotVertexCount() const {
  if (m_data->next == ODIS_PASS_PILOT) return 0;
  size_t count = 0;
  for (const std::vector<PathVertex>& tile : m_data->pilotVertices) count += tile.size();
  return count;
}

std::vector<PathVertex> Frame::pilotVertices() const {
  std::vector<PathVertex> vertices;
  if (m_data->next == ODIS_PASS_PILOT) return vertices;
  vertices.reserve(pilotVertexCount());
  for (const std::vector<PathVertex>& tile : m_data->pilotVertices)
    vertices.insert(vertices.end(), tile.begin(), tile.end());
  return vertices;
}

}  // namespace odis::core
