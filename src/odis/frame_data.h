// What a frame holds.
#pragma once

#include <atomic>

#include "odis/frame.h"
#include "odis/image/pixel_samples.h"
#include "odis/image/schedule.h"
#include "odis/image/tiles.h"
#include "odis/paper_method.h"

namespace odis::core {

// Vertices of each tile.
using VertexTiles = std::vector<std::vector<PathVertex>>;

// What a saved frame has of a pass: all of the tiles whose samples were in.
struct ResumedPass {
  std::vector<uint8_t> tilesDone;
  std::vector<VertexSamples> samples;
};

struct FramePosition;

// What a pilot sample weighs in its pixel in units of a guided one; the pixel has `later` other samples.
float pilotWeight(const FrameOptions& options, const Schedule& schedule, uint32_t pixel, uint32_t later);
// What a frame keeps of the pilot's samples and of those after it, at the beginning: sums, of which there are
// means, or what decisions need.
PixelSamples keptOfPilot(const FrameOptions& options, const Schedule& schedule);
PixelSamples keptOfLater(const FrameOptions& options, const Schedule& schedule);
TileGrid tilesOf(const FrameOptions& options);
// Throws std::invalid_argument where an option is out of its range.
const FrameOptions& checkedOptions(const FrameOptions& options);

// Sums over tiles: vertices by what can be learned from them, all vertices, memory.
VertexCounts countsOf(ArrayView<const VertexSamples> tiles);
uint64_t vertexCount(ArrayView<const VertexSamples> tiles);
uint64_t bytesOf(ArrayView<const VertexSamples> tiles);
uint64_t bytesOf(const VertexTiles& tiles);

// The most samples of a pass that the guide learns from; where there are more, it learns from some pixels
// only. The number of cells does not grow with the image, so more would gain nothing and cost memory. A
// pilot's samples take more of it than guided ones.
inline constexpr uint64_t kMostPilotSamples = 1200000, kMostGuidedSamples = 2400000;

struct Frame::Data {
  Data(const FrameOptions& o, std::shared_ptr<const Tasks> tasks, std::shared_ptr<GuideBuilder> given);

  // The stages, in their order.
  void describePass();
  void take(uint32_t tile, ArrayView<const FrameSample> samples, TileVertices& vertices);
  void endPilot();
  void endOraclePass();
  bool needsGuide() const;
  void learnUnguided(bool forFractions);
  void useCells();
  bool nextRefinementPays() const;
  void settleRefinement();
  void buildGuide();
  void endGuidedPass();
  void learnFromGuidedPass();
  void spreadSamples();
  void endRefinement();
  bool guideSavesNothing() const;
  bool guidingDoesNotPay();
  void giveUpGuiding();
  void refineGuide();
  void countKept();
  void takeStock();

  bool learns() const { return done < schedule.lastRefinement(); }
  SampleRange samples(uint32_t pixel) const;  // without their weight
  float weightInPass(uint32_t pixel) const;
  void requirePixel(uint32_t pixel, const char* function) const {
    if (pixel >= pixelCount) refusePixel(pixel, function);
  }
  [[noreturn]] void refusePixel(uint32_t pixel, const char* function) const;
  void requireMeans(const char* function) const;
  bool lacksVertices() const;
  // Whether the guide learns from the pass's samples of a pixel, or keeps their vertices.
  bool wantsVertices(uint32_t pixel) const {
    if (pixelsPerLearned == 1) return pass.wantsVertices;
    return pass.wantsVertices &&
           (pixel % options.width + 2 * (pixel / options.width)) % pixelsPerLearned == 0;
  }
  // How many samples a pixel has by now; without means, those of the passes that have ended, all of which are
  // taken to have come.
  uint32_t pilotTaken(uint32_t pixel) const;
  uint32_t laterTaken(uint32_t pixel) const;
  float pilotWeightOf(uint32_t pixel) const {
    return pilotWeight(options, schedule, pixel, laterTaken(pixel));
  }

  // Goes on with the pass that was under way when the frame was saved.
  void resume();
  FramePosition position() const;
  void moveTo(const FramePosition& position);

  FrameOptions options;
  bool ownsBuilder;
  std::shared_ptr<const Tasks> tasks;
  std::shared_ptr<GuideBuilder> builder;  // null once the guide is final
  GuideOptions guideOptions;
  uint64_t modelId;  // the same for models that decide the same; 0 where there is none
  size_t pixelCount;
  Schedule schedule;
  PixelSamples pilot, later;  // the pilot's samples, and those after it
  TileCollector tiles;
  std::vector<float> pixelValues;
  Guide guide;
  Guide cells;                         // what the cells know of it, until the guide is final
  std::unique_ptr<PaperMethod> paper;  // null in ordinary frames; until the guide is final
  uint64_t guidesBuilt = 0;

  FramePass pass;
  GuideView view;  // of the guide of the pass
  bool inPass = false, finished = false;
  OdisPassKind next;                       // of the pass under way, or of the next one
  uint32_t done = 0, end = 0;              // samples after the pilot: done before the pass, and by its end
  uint32_t pixelsPerLearned = 1;           // of the pass: the guide learns from one pixel in so many
  VertexTiles pilotVertices;               // [tile], where they are kept
  std::vector<VertexSamples> passSamples;  // [tile], of a pass that is learned from
  std::atomic<uint64_t> notFinite{0};
  std::atomic<uint64_t> pilotSamplesTaken{0}, laterSamplesTaken{0};
  std::atomic<uint64_t> passVertexCount{0};  // vertices of the pass that are learned from, so far
  std::atomic<uint64_t> keptBytes{0};        // of vertices, and of what was taken from them
  // Of the pass, so far: all that came, learned from or not.
  std::atomic<uint64_t> passSamplesCame{0}, passRaysCame{0}, passVerticesCame{0};
  uint64_t outsideFrame = 0, twice = 0, buildingBytes = 0, pilotVertexCount = 0;
  uint64_t missingSamples = 0, passesWithoutVertices = 0;
  double measuredCostRatio = 0;  // of guided samples over unguided ones; 0: not measured
  bool guidingGivenUp = false;
  VertexCounts vertexCounts;
  std::unique_ptr<ResumedPass> resumed;
  std::vector<uint8_t> hostData;
};

}  // namespace odis::core
