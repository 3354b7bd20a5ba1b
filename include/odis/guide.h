// From pilot vertices to decisions: nested cells in world space, and in each a sampling map, selection
// probabilities, what going on is worth, and which lights matter.
//
//   odis::GuideBuilder builder(options);
//   builder.add(pilotVertices);              // once, or as samples arrive
//   odis::Guide guide = builder.build(pilotVertices);
//   ...
//   if (const odis::Cell* cell = guide.find(position, normal)) {
//     odis::VertexMap map;
//     map.prepare(cell->map, normal, odis::Sides::reflection);
//     ... one-sample mixture with alpha = cell->alpha[int(materialClass(roughness))]
//     ... roulette with survivalProbability(*cell, throughput / pixel), lights by guide.lights(*cell)
//   }
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "odis/pilot.h"
#include "odis/sampling.h"

namespace odis {

class ContinuationModel;
class DirectionModel;
class LightModel;
struct CellStatistics;
struct DirectionDistribution;

inline constexpr int kCellLevels = 4;  // nested cells with edges e, 2e, 4e, 8e

// Groups of lights that are equal parts of one light: where nothing was learned, each is as likely as the others.
struct LightParts {
  uint32_t first = 0, count = 0;
};

struct GuideOptions {
  // What turns statistics into maps (src/odis/decisions/direction_model.h); null: the histogram formula.
  std::shared_ptr<const DirectionModel> model;
  // What tells how much comes back from a cell (src/odis/decisions/roulette.h); null: the formula.
  std::shared_ptr<const ContinuationModel> continuations;
  // What tells what the groups of lights give (src/odis/decisions/lights.h); null: the formula.
  std::shared_ptr<const LightModel> lights;
  int cellsPerDiagonal = 32;  // the finest cells have an edge of (diagonal of what the pilot saw) / this
  // How many samples' worth of trust the coarser level has when it is blended with a finer one, per level,
  // finest first; the last one is for the uniform map.
  float trust[kCellLevels] = {250, 250, 120, 30};
  bool controlVariate = true;          // whether something stands in for paths that roulette ends
  uint32_t lightGroups = 0;            // that the vertices tell apart; 0: learn nothing about lights
  std::vector<LightParts> lightParts;  // which of these groups are parts of one light
  float floor = 0.03f;                 // share of the uniform distribution in every map
  float clamp = 20;      // a sample counts at most this many times the mean of its neighbourhood (maps only)
  float fixedAlpha = 0;  // > 0: this selection probability everywhere instead of the one by variance and cost
};

// What the pilot predicts of a sample of one of its pixels, relative to the pixel's value squared.
struct PixelPrediction {
  float variance = 0;  // without guiding
  float saved = 0;     // of it, by guiding
};

// What a cell tells a path.
struct Cell {
  SamplingMap map;
  float alpha[kMaterialClasses] = {1, 1, 1};  // share of smooth draws that stay with the BSDF; 1: don't guide

  // What going on from here is worth beside what it costs: see survivalProbability().
  float worth = INFINITY;
  // Radiance that a vertex here scatters back on average, next-event estimate included, or nothing: what a path adds that
  // ends before it knows. One that survives with probability p adds (1 - 1/p) times as much, so that what is right on
  // average remains so, whatever this is; pixels may become negative.
  Float3 expected{0, 0, 0};
  float lightShare = 0;  // see LearnedLights

  // Whether there is a class to guide; where there is none, a vertex need not find out which it is of.
  bool guidesAny() const { return std::min({alpha[0], alpha[1], alpha[2]}) < 1; }
};

// The probability with which a path should go on from a vertex in this cell, instead of ending before its
// next-event estimation: what the pilot saw come back from there, for what cost, decides. In (0, 1].
//   throughput   the path's up to the vertex, over (an estimate of) its pixel's value; both as luminance
inline float survivalProbability(const Cell& cell, float throughput) {
  constexpr float kLeast = 0.3f;  // so that no path weighs more than three times as much for it
  const float survival = throughput * cell.worth;
  return survival < 1 ? std::max(survival, kLeast) : 1;  // 1 for what is not a number
}

// The probability with which a shadow ray should be traced for light that, if nothing hides it, adds so much to the pixel
// (over an estimate of the pixel's value, as luminance). In (0, 1].
inline float shadowRayProbability(float contribution) {
  constexpr float kEnough = 0.05f, kLeast = 0.2f;
  return contribution < kEnough ? std::max(contribution / kEnough, kLeast) : 1;  // 1 for what is not a number
}

// What is known in a cell about the choice of a light: a share of the choices draws a group of lights from a table,
// the others choose as ever.
struct LearnedLights {
  const float* cdf = nullptr;  // one entry more than groups, from 0 to 1
  float share = 0;             // in [0, 1); 0: nothing known, no table
};

// Where a vertex is: its position and unit shading normal on the side of the outgoing direction.
struct Place {
  Float3 position, normal;
};

// Pilot vertices as they lie in memory: one array for each part of the image, say.
using PilotParts = std::span<const std::span<const PilotVertex>>;

// What a builder takes of a run of vertices, so that those need not be kept: about 70 bytes a vertex.
class PilotDigest {
 public:
  PilotDigest();
  ~PilotDigest();
  PilotDigest(PilotDigest&&) noexcept;
  PilotDigest& operator=(PilotDigest&&) noexcept;

 private:
  friend class GuideBuilder;
  struct Data;
  std::unique_ptr<Data> m_data;
};

// A set of cells, fixed once built. Thread-safe.
class Guide {
 public:
  Guide();
  ~Guide();
  Guide(Guide&&) noexcept;
  Guide& operator=(Guide&&) noexcept;

  // The finest cell there is for a vertex; null where the pilot saw nothing at all.
  const Cell* find(const Float3& position, const Float3& normal) const;
  // The same for many vertices at once, which is faster: cells lie all over memory, and here none waits for the
  // memory of another. `cells` has room for as many as there are `places`.
  void find(std::span<const Place> places, std::span<const Cell*> cells) const;
  // Asks for everything that a vertex may read of a cell of this guide to be fetched: to be called a few vertices ahead.
  void prefetch(const Cell& cell) const;

  // What is known about lights in a cell of this guide. The table lasts as long as the guide.
  LearnedLights lights(const Cell& cell) const;

  // The number of a cell of this guide, below cellCount().
  uint32_t indexOf(const Cell& cell) const;

  uint64_t cellCount() const;
  uint64_t bytes() const;
  // The variance that the pilot predicts of a guided sample, as a ratio to an unguided one; 1 before build().
  float predictedVarianceRatio() const;
  // The same for each pixel that build() got the value of; zeros where it did not look. 8 bytes a pixel. They
  // are made from single samples: pilotWeights() averages them.
  std::span<const PixelPrediction> predictions() const;

 private:
  friend class GuideBuilder;
  struct Data;
  std::unique_ptr<Data> m_data;
};

// How much a pilot sample should weigh in the mean of a pixel's samples, as a ratio to a guided one: by the
// inverse of their variances. `predictions` are those of an image of `width` pixels a row. A pixel's weight
// is made from the blocks of 8 x 8 pixels around its own without that block, and from all other blocks where
// those have seen little: it does not depend on the pixel's own samples, so the weighted mean is unbiased.
std::vector<float> pilotWeights(std::span<const PixelPrediction> predictions, int width);

// Gathers pilot vertices and builds guides from them. Results do not depend on the number of threads.
class GuideBuilder {
 public:
  explicit GuideBuilder(const GuideOptions& options = {});
  ~GuideBuilder();

  // Adds to the statistics of the cells. The first call fixes the extent of the cells, so it should hold at
  // least one pass over the image. Vertices of guided paths may be added, too, their `pdf` being the mixture's.
  // Vertices with values that are not finite are left out.
  void add(PilotParts parts);
  void add(std::span<const PilotVertex> vertices) { add(PilotParts(&vertices, 1)); }
  // The same in two steps, after a first call of add() above: digest() may be called by many threads at once, for a part
  // of the image each. Empty digests are fine.
  PilotDigest digest(std::span<const PilotVertex> vertices) const;
  void add(std::span<const PilotDigest> digests);
  // Builds maps from all that was added, and selection probabilities from vertices that should be (a part
  // of) the same, without those of guided paths. `pixelValues`, indexed by PilotVertex::pixel, are what the
  // vertices' contributions are divided by; without them they are taken as they are.
  Guide build(PilotParts parts, std::span<const float> pixelValues = {}) const;
  Guide build(std::span<const PilotVertex> vertices, std::span<const float> pixelValues = {}) const {
    return build(PilotParts(&vertices, 1), pixelValues);
  }
  // Builds all but selection probabilities and predictions anew, from all that was added by now. Those are taken
  // from `previous`, which came from this builder; cells that are new have their parents' probabilities.
  Guide rebuild(const Guide& previous) const;
  // Held at most, the vertices themselves not included.
  uint64_t bytes() const;

 private:
  struct Data;
  Guide buildMaps(const std::vector<CellStatistics>& cells,
                  std::vector<DirectionDistribution>& distributions) const;
  void addRouletteAndLights(Guide& guide, const std::vector<CellStatistics>& cells) const;
  std::unique_ptr<Data> m_data;
};

}  // namespace odis
