// What there is to see of a frame: the image, and numbers.
#include <stdexcept>

#include "odis/frame_data.h"

namespace odis::core {

// All that comes after the pilot depends on it, how many samples a pixel has included. The pilot's share in
// its pixel must not: it stays what it would be if all pixels had as many samples.
float pilotWeight(const FrameOptions& options, const Schedule& schedule, uint32_t pixel,
                  const PixelSums& later) {
  return later.count > 0 ? options.pilotWeight * schedule.remainingRatio(pixel) : 1;
}

float Frame::sampleWeight(uint32_t pixel, uint32_t sample) const {
  const Data& d = *m_data;
  d.requirePixel(pixel, "odisGetSampleWeight");
  if (sample >= d.schedule.sampleCount(pixel))
    throw std::out_of_range("odisGetSampleWeight: expected a sample of the pixel, found " +
                            std::to_string(sample) + " of " + std::to_string(d.schedule.sampleCount(pixel)));
  return d.schedule.sampleWeight(pixel, sample < d.schedule.pilotCount(pixel), d.options.pilotWeight);
}

PixelMean Frame::mean(uint32_t pixel) const {
  const Data& d = *m_data;
  d.requirePixel(pixel, "odisGetPixelMean");
  const float pilotWeight = d.schedule.pilotCount(pixel) > 0 ? d.pilotWeightOf(pixel) : 1;
  const WeightedSums parts[] = {{&d.pilot[pixel], pilotWeight}, {&d.later[pixel], 1}};
  return weightedMean({parts, 2});
}

uint32_t Frame::sampleCount(uint32_t pixel) const {
  m_data->requirePixel(pixel, "odisGetSampleCount");
  return m_data->pilot[pixel].count + m_data->later[pixel].count;
}

FrameStatistics Frame::statistics() const {
  const Data& d = *m_data;
  FrameStatistics result = summary();
  double pilot = 0, all = 0;
  for (uint32_t pixel = 0; pixel < d.pilot.size(); ++pixel) {
    const uint32_t pilotCount = d.pilot[pixel].count;
    const double weight = pilotCount > 0 ? pilotCount * double(d.pilotWeightOf(pixel)) : 0;
    pilot += weight;
    all += weight + d.later[pixel].count;
    result.samples += pilotCount + d.later[pixel].count;
    result.pilotSamples += pilotCount;
  }
  result.pilotFraction = all > 0 ? pilot / all : 0;
  return result;
}

FrameStatistics Frame::summary() const {
  const Data& d = *m_data;
  FrameStatistics result;
  result.width = d.options.width;
  result.height = d.options.height;
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
  return m_data->pilot;
}

size_t Frame::pilotVertexCount() const {
  size_t count = 0;
  for (const std::vector<PathVertex>& tile : m_data->pilotVertices) count += tile.size();
  return count;
}

std::vector<PathVertex> Frame::pilotVertices() const {
  std::vector<PathVertex> vertices;
  vertices.reserve(pilotVertexCount());
  for (const std::vector<PathVertex>& tile : m_data->pilotVertices)
    vertices.insert(vertices.end(), tile.begin(), tile.end());
  return vertices;
}

}  // namespace odis::core
