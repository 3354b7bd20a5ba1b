// Second moments of guided samples, as the pilot predicts them for each candidate of the BSDF sampling
// fraction.
#pragma once

#include <array>

#include "odis/guide_view.h"
#include "odis/models/fraction_samples.h"

namespace odis::core {

// The BSDF sampling fraction where contributions or costs are unknown.
inline constexpr float kFallbackBsdfFraction = 0.5f;

// The candidates; 1 means not to guide.
inline constexpr std::array<float, 6> kBsdfFractions = {1.0f, 0.8f, 0.6f, 0.4f, 0.25f, 0.15f};

// Sums over the vertices of one roughness class of a cell, for each candidate: the second moment of
// next-event estimate plus direction, relative to the pixel's value squared, and the rays of what follows.
struct MomentSums {
  double count = 0;  // number of vertices
  std::array<double, kBsdfFractions.size()> secondMoment{};
  std::array<double, kBsdfFractions.size()> rays{};

  void add(const MomentSums& other, double scale = 1);
};
using CellMoments = std::array<MomentSums, kRoughnessClasses>;

// The second moments of one vertex, one for each candidate.
using SecondMoments = std::array<float, kBsdfFractions.size()>;

// Adds one vertex, whose density under its cell's map (with the vertex's own sample taken out) is `mapPdf`
// for its direction and `lightMapPdf` for the direction of its next-event estimate. What it adds to its pixel
// is multiplied by `scale`. Returns what it added to the second moments.
SecondMoments addVertex(MomentSums& sums, const FractionSample& vertex, float mapPdf, float lightMapPdf,
                        float scale = 1);

// What the sums are weighed against: sums over the first vertices of the whole image.
struct ImageMoments {
  double variance = 0;  // relative to the pixels' values squared
  double rays = 0;      // traced because of the first vertices' directions
  double count = 0;     // number of first vertices
};

// A cell's sums with those of a coarser one added, scaled to a fixed number of samples.
MomentSums shrunkSums(const MomentSums& own, const MomentSums& coarser);

// The index of the candidate with the least predicted variance + cost.
size_t chooseFraction(const MomentSums& sums, const ImageMoments& image);

}  // namespace odis::core
