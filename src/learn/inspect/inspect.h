// One place looked into: what the pilot saw there, what the guide makes of it, and what is true.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "learn/data/targets.h"
#include "odis/cells/statistics.h"
#include "render/integrators/render.h"

namespace odis::learn {

struct InspectSettings {
  // The first vertex of a pixel's path that may be guided; the pixel counts in the full image.
  std::optional<render::Vec2i> pixel;
  // Or the cell at a point, of surfaces that face about this way; without a normal the finest cell there,
  // and of several that with the most samples.
  std::optional<Float3> point, normal;
  int paths = 1 << 17;  // that what really arrives is measured with, about
};

// A function of direction: an equal-area octahedral square of `side` texels a side, row by row, over its
// mean on the whole sphere: 1 everywhere if it is even. kUnknown where nothing was measured.
struct SquareMap {
  int side = 0;
  std::vector<float> values;
};

// What directions that are drawn from a map do at the vertex.
struct Judgement {
  float entropy = 0;     // of the map in bits; 8: even
  float divergence = 0;  // of a map from the converged one: Kullback and Leibler's, in bits
  // The second moment of what the vertex scatters, next-event estimate and one sampled direction, over its
  // squared mean: with the cell's BSDF sampling fraction, and with the best one. kUnknown where nothing
  // arrives.
  float moment = kUnknown, bestMoment = kUnknown;
  float bestBsdfFraction = 1;
};

// A cell, or one around it.
struct LevelView {
  uint32_t cell = 0;  // its number in the guide
  float edge = 0;
  double effective = 0;  // samples
  double own =
      0;  // its histogram's weight when the formula blends it with the next coarser level's distribution
  core::CellStatistics statistics;
  SquareMap histogram;  // of radiance x cosine
  Judgement judgement;  // of its histogram alone, made into a map as the formula's distribution is
};

struct MapView {
  std::string name;
  SquareMap radiance, density;  // what the map was made of (over the mean cosine), and the map
  SquareMap mixture;            // with the BSDF, at the cell's BSDF sampling fraction
  Judgement judgement;
  float bsdfFraction[kRoughnessClasses] = {1, 1, 1};  // that the guide chose for its map
};

struct GroupView {
  render::LightGroup lights;
  float unlearned = 0,
        learned = 0;  // probability of the group: by the hierarchy, and as guided vertices choose
  LightMoments converged;
};

// A pilot's sample of the cell: where it came from, seen from the cell's centroid, and its radiance x
// cosine / density over the mean of the cell's samples.
struct SampleDot {
  Float2 at;
  float value = 0;
};

struct Inspection {
  // The pilot's image: the crop. Where there was no sample, its neighbours'.
  render::Crop crop;
  std::vector<render::Rgb> image;
  render::Vec2i pixel{0, 0};         // of the vertex, in the full image
  std::vector<uint32_t> cellPixels;  // of the crop, whose first vertices are in the cell

  PathVertex vertex;       // that everything is looked at from
  float guidable = 0;      // probability that its BSDF draws a direction that may be guided
  float bsdfFraction = 1;  // of its material class
  float pixelValue = 0;
  float survival = 1;  // by learned roulette, of a path whose throughput is one
  CellDecisions cell;  // what the guide says; by the chosen model

  std::vector<LevelView>
      levels;  // from the finest that the pilot saw something in; its statistics()'s level says which
  std::vector<SampleDot> samples;
  std::vector<GroupView> groups;
  float lightShare = 0;  // of the choices that follow what was learned

  std::vector<MapView> maps;  // of the formula, then of another model if one is chosen
  MapView converged;
  SquareMap bsdf, best;    // BSDF x cosine, and that times what arrives: what a density should be like
  Judgement bsdfAlone;     // nothing is guided: its moment
  float noise = 0;         // divergence of one half of the converged samples from the other, as maps
  uint64_t paths = 0;      // that the converged map is made of
  uint32_t starts = 0;     // vertices that these start at
  Float3 outgoing;         // converged: mean of what the cell's vertices scatter back
  float outgoingRms = 0;   // of its luminance
  float outgoingRays = 0;  // rays that this takes
};

// Traces the scene's pilot as `render` with these options does, builds its guide, and looks into it. Throws
// OptionError where there is no such place or the pilot saw nothing there. Nothing if it was interrupted.
std::optional<Inspection> inspect(const render::Scene& scene, const render::RenderOptions& options,
                                  const InspectSettings& settings, render::Progress& progress);

}  // namespace odis::learn
