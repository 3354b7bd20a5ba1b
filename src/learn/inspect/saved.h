// What a host saved with the library, looked into without the model that it had: guides, builders, vertices,
// frames.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "learn/inspect/inspect.h"
#include "odis/files/archive.h"
#include "odis/guide.h"

namespace odis::learn {

// How numbers are spread: one in ten is below `low`, half of them below `middle`, nine in ten below `high`.
// kUnknown if there are none.
struct Quantiles {
  float low = kUnknown, middle = kUnknown, high = kUnknown;
};

struct Bounds {
  Float3 low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
};

struct GuideSummary {
  core::Guide guide;
  std::array<uint32_t, kCellLevels> cells{};  // at each level, finest first
  float finestEdge = 0;
  Bounds bounds;  // of all cells' cubes
  // Over the cells of the finest level.
  Quantiles bsdfFraction[kRoughnessClasses];
  Quantiles entropy, survivalFactor, learnedLightFraction;
};

// The finest cell at a point.
struct CellSummary {
  uint32_t cell = 0;
  int level = 0;
  float edge = 0;
  Float3 middle, normal;  // of its cube; that it was found by
  CellDecisions decisions;
  std::vector<float> lights;  // probability of each group where the cell's table is followed; empty: no table
  float entropy = 0;          // of the map in bits; 8: even
  SquareMap map;
};

struct VertexSummary {
  static constexpr size_t kDepths = 9;

  uint64_t count = 0;
  VertexCounts counts;                    // how many a builder takes, and how many it refuses
  std::array<uint64_t, kDepths> depth{};  // of depth 1, 2, ...; the last one: of that depth or more
  uint64_t discrete = 0, scattersBothSides = 0;
  // Of those that a builder takes.
  Bounds bounds;
  uint32_t firstPixel = UINT32_MAX, lastPixel = 0, firstSample = UINT32_MAX, lastSample = 0;
  Quantiles distance, radiance, pdf;  // radiance as luminance
};

// An option of a frame or its guide that is not the default.
struct ChosenOption {
  std::string name, value;
};

// What one builder has gathered.
struct PartSummary {
  uint64_t id = 0;
  std::array<uint32_t, kCellLevels> cells{};
  VertexCounts counts;
  uint64_t unguided = 0;        // vertices that BSDF sampling fractions are chosen from
  int coarsening = 1;           // how many times larger cells are than was asked for, to save memory
  uint64_t samplesLeftOut = 0;  // for the same reason
};

struct BuilderSummary {
  std::vector<ChosenOption> options;
  std::string model;  // in words
  uint64_t own = 0;   // id of what is added to it
  std::vector<PartSummary> parts;
};

struct FrameSummary {
  uint32_t width = 0, height = 0;
  std::vector<ChosenOption> options;
  std::string model, state;         // in words
  size_t tiles = 0, tilesDone = 0;  // of the pass under way; 0: none is
  bool hasMeans = true;  // else the film is the host's: no rays, counts and luminance, a black image
  uint64_t samples = 0, rays = 0;      // of the image
  uint64_t fewest = 0, most = 0;       // samples of a pixel
  double luminance = 0;                // mean of the image
  uint64_t notFinite = 0, guides = 0;  // samples that counted as black; how often a guide was built
  VertexCounts vertexCounts;           // taken and refused by the builder, when the guide was built last
  std::optional<VertexSummary> pilotVertices;  // if they are kept
  std::optional<VertexCounts> passVertices;    // that came in the pass under way
  std::optional<BuilderSummary> builder;
  uint64_t hostBytes = 0;          // data that the host added
  std::vector<render::Rgb> image;  // so far, the pilot weighed as the frame does
};

// Of a guide `guide`, of a builder `builder`, of vertices `vertices`, of a frame `frame` and its guide.
struct SavedInspection {
  std::string kind;
  std::optional<GuideSummary> guide;
  std::optional<CellSummary> cell;
  std::optional<BuilderSummary> builder;
  std::optional<VertexSummary> vertices;
  std::optional<FrameSummary> frame;
};

// Whether a file begins as all do that the library saves.
bool isSaved(const std::string& path);
// Throws FileError where the file is damaged, or holds something unknown.
SavedInspection inspectSaved(const core::Archive& file);
// The map of a cell, and its entropy.
SquareMap mapSquare(const GuideView& view, uint32_t cell);
float mapEntropy(const GuideView& view, uint32_t cell);
// The cell of a saved guide or of a frame's guide; without a normal the finest one there. Throws OptionError
// if there is none.
CellSummary inspectCell(const SavedInspection& saved, const Float3& point,
                        const std::optional<Float3>& normal);

}  // namespace odis::learn
