// What a saved frame says by itself, whatever model it has.
#pragma once

#include "odis/files/archive.h"
#include "odis/frame_data.h"

namespace odis::core {

// Where a frame is between its first sample and its last.
struct FramePosition {
  uint64_t guidesBuilt, notFinite, outsideFrame, twice, buildingBytes, pilotVertices;
  uint64_t pilotSamplesTaken, laterSamplesTaken;
  uint64_t missingSamples, passesWithoutVertices;
  double measuredCostRatio;
  // What the schedule says. One of the same options has to say it again, or other samples would be taken from
  // here on.
  uint64_t pilotSamples;
  uint32_t passEnd, spreadAfter;
  // What is asked for by now, and was before the last round.
  uint32_t samplesPerPixel, samplesBefore;
  uint32_t next, done, finished, builder, guidingGivenUp;
};

// The options of a saved frame; those of its guide without a model. Throws FileError.
FrameOptions loadOptions(const Archive& file);

// All of a frame but what its builder has gathered. Throws FileError.
struct SavedFrame {
  explicit SavedFrame(const Archive& file);

  FrameOptions options;
  size_t pixelCount;
  uint64_t modelId;
  std::vector<uint8_t> hostData;
  std::vector<float> pixelValues;
  Schedule schedule;
  PixelSamples pilot, later;
  FramePosition position;
  VertexCounts vertexCounts;
  VertexTiles pilotVertices;
  Guide guide;
  std::unique_ptr<ResumedPass> pass;  // null between passes

 private:
  void readPosition(const Archive& file);
  void readPixels(const Archive& file);
  void readPass(const Archive& file);
};

}  // namespace odis::core
