// What a frame holds.
#pragma once

#include <atomic>

#include "odis/frame.h"
#include "odis/image/schedule.h"
#include "odis/image/tiles.h"

namespace odis::core {

// Vertices of each tile.
using VertexTiles = std::vector<std::vector<PathVertex>>;

// What a saved frame has of a pass: all of the tiles whose samples were in.
struct ResumedPass {
  std::vector<uint8_t> tilesDone;
  VertexTiles vertices;
  std::vector<CellSamples> cellSamples;
};

struct FramePosition;

// What a pilot sample weighs in its pixel in units of a guided one; `later` are the pixel's other samples.
float pilotWeight(const FrameOptions& options, const Schedule& schedule, uint32_t pixel,
                  const PixelSums& later);
// Throws std::invalid_argument where an option is out of its range.
const FrameOptions& checkedOptions(const FrameOptions& options);

struct Frame::Data {
  Data(const FrameOptions& o, std::shared_ptr<const Tasks> tasks, std::shared_ptr<GuideBuilder> given);

  // The stages, in their order.
  void describePass();
  void take(uint32_t tile, ArrayView<const FrameSample> samples, TileVertices& vertices);
  void endPilot();
  void endOraclePass();
  void describePixels();
  void useCells();
  void buildGuide(const VertexTiles& taught, const VertexTiles& judged);
  void endGuidedPass();
  void spreadSamples();
  bool guidingDoesNotPay() const;
  void giveUpGuiding();
  void refineGuide();
  void takeStock(uint64_t vertices);

  bool learns() const { return done < schedule.lastRefinement(); }
  SampleRange samples(uint32_t pixel) const;

  // Goes on with the pass that was under way when the frame was saved.
  void resume();
  void moveTo(const FramePosition& position);

  FrameOptions options;
  bool ownsBuilder;
  std::shared_ptr<const Tasks> tasks;
  std::shared_ptr<GuideBuilder> builder;  // null once the guide is final
  GuideOptions guideOptions;
  std::vector<OdisLightParts> lightParts;
  uint64_t modelId;  // the same for models that decide the same; 0 where there is none
  Schedule schedule;
  std::vector<PixelSums> pilot, later;  // of the pilot's samples, and of those after it
  TileCollector tiles;
  std::vector<float> pixelValues;
  Guide guide;
  Guide cells;  // the guide without maps at pixels; like those, until the guide is final
  PixelMaps pixelMaps;
  std::unique_ptr<PixelOracle> pixelOracle;
  uint64_t guidesBuilt = 0;

  FramePass pass;
  GuideView view;  // of the guide of the pass
  bool inPass = false, finished = false;
  OdisPassKind next;                        // of the pass under way, or of the next one
  uint32_t oraclePasses = 0;                // passes of the oracle that are done
  uint32_t done = 0, end = 0;               // samples after the pilot: done before the pass, and by its end
  uint32_t pixelsPerLearned = 1;            // of the pass: the guide learns from one pixel in so many
  VertexTiles pilotVertices, passVertices;  // [tile]
  VertexTiles oracleVertices;               // those that the oracle's BSDF sampling fractions are made from
  std::vector<CellSamples> cellSamples;     // [tile]
  std::atomic<uint64_t> notFinite{0};
  std::atomic<uint64_t> keptBytes{0};  // of vertices, or of what was taken from them
  uint64_t outsideFrame = 0, buildingBytes = 0, pilotVertexCount = 0;
  VertexCounts vertexCounts;
  std::unique_ptr<ResumedPass> resumed;
  std::vector<uint8_t> hostData;
};

}  // namespace odis::core
