// What a network is to predict, where that is worth many samples: for some cells and some pixels, maps of
// the light that arrives, what is scattered back and what it costs, and what each group of lights gives.
#pragma once

#include <odis/octahedral.h>

#include <span>
#include <vector>

#include "learn/data/pilots.h"

namespace odis::learn {

// Maps are equal-area octahedral squares (odis/octahedral.h) of so many texels a side, row by row.
inline constexpr int kTargetSize = 32;
inline constexpr int kTargetTexels = kTargetSize * kTargetSize;
// In data sets of incident radiance they have so many.
inline constexpr int kWindowMapSize = 16;
inline constexpr int kWindowMapTexels = kWindowMapSize * kWindowMapSize;

// The direction of a point of a texel, its place within given from 0 to 1.
inline Float3 directionInTexel(int texel, const Float2& within) {
  const int x = texel % kTargetSize, y = texel / kTargetSize;
  return squareToDirection(Float2{(float(x) + within.x) / kTargetSize, (float(y) + within.y) / kTargetSize});
}

struct TargetSettings {
  int cells = 192, pixels = 64;  // how many of each
  int perTexel = 2;    // directions in a map's texel; half of them lie below most surfaces, and aren't traced
  int outgoing = 256;  // samples of what is scattered back
  int lights = 1024;   // samples of next-event estimation, of all groups together
};

// What a group of lights gives, as next-event estimation that chooses the group sees it: f |cos| Le V over
// the density within the group, luminance; with and without the weight of MIS against the BSDF.
struct LightMoments {
  float mean = 0, rms = 0, misMean = 0, misRms = 0;
  float probability = 0;  // with which the group is chosen if nothing was learned
};

struct Target {
  bool pixel = false;         // of one vertex of a pixel's path, or of the vertices of a cell
  uint32_t vertex = 0;        // that vertex, or one of the cell; counts through all pilots
  uint32_t cellVertices = 0;  // usable ones in the cell, of all pilots
  uint32_t starts = 0;        // at how many of them samples start
  Float3 position, normal;    // means of these, the normal of unit length

  // Maps of what arrives, each sample from one of these vertices: means and roots of mean squares of
  // luminance. `indirect` is what is scattered, `emission` what lights shed without MIS weight; `lightPdf`
  // the density with which next-event estimation finds that light (mean over the samples that met one),
  // `rays` what a sample costs. Directions that no vertex scatters from have zero samples, and zeros.
  std::vector<float> indirect, indirectRms, emission, emissionRms, lightPdf, rays;
  std::vector<uint8_t> samples;

  Float3 outgoing;  // mean of what the vertices scatter back along their paths, next-event estimate included
  float outgoingRms = 0;   // of its luminance
  float outgoingRays = 0;  // that this takes, the shadow ray at the vertex included

  std::vector<LightMoments> lights;  // of each group
};

// Paths of targets begin at their vertices: roulette by throughput, which pilots' paths meet at a fixed
// depth, is as far away from each as it is from a camera. That changes second moments and rays, not means.

// Chooses cells in proportion to the root of how many vertices they have and pixels evenly, and traces
// their samples: the same for the same seed. There are fewer targets than asked for where the pilots saw
// fewer cells or pixels.
std::vector<Target> traceTargets(const render::Scene& scene, const render::LightSampler& lights,
                                 std::span<const Pilot> pilots, const ViewFrame& frame,
                                 const TargetSettings& settings, uint64_t seed);

// Adds the arrays of the targets; radiance in the frame's unit.
void addColumns(ShardWriter& writer, const std::string& prefix, std::span<const Target> targets,
                size_t groups, const ViewFrame& frame);
// The same with maps of so many texels a side, and without what is scattered back and what lights give.
void addMapColumns(ShardWriter& writer, const std::string& prefix, std::span<const Target> targets,
                   size_t side, const ViewFrame& frame);
// Of either kind. Throws ShardError.
std::vector<Target> readTargets(const ShardReader& reader, const std::string& prefix, const ViewFrame& frame);

}  // namespace odis::learn
