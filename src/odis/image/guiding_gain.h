// Whether guided samples, and a better guide, are worth what they cost.
#pragma once

#include <optional>

#include "odis/image/pixel_samples.h"
#include "odis/work/tasks.h"

namespace odis::core {

// The variance of a guided sample times its rays, over the variance of an unguided one times its rays: below
// 1 guided samples leave less error for as many rays.
struct GuidingGain {
  double ratio, standardError;
};

// From sums over the samples of each pixel, row by row; nothing where fewer than 2048 pixels have samples of
// both kinds.
//
// Variances are relative to the pixels' values squared. Both kinds are compared with the mean of the guided
// samples of the eight pixels around. What that mean is off by adds as much to both kinds' squares, and is
// taken off again: it is the product of both kinds' distances, whose errors are independent. As in the error
// that images are compared by, the worst 0.1 % of either kind are left out. The standard error is found from
// blocks of 8 x 8 pixels.
std::optional<GuidingGain> guidedOverUnguided(const Tasks& tasks, ArrayView<const PixelSums> unguided,
                                              ArrayView<const PixelSums> guided, uint32_t width);
std::optional<GuidingGain> guidedOverUnguided(const Tasks& tasks, const PixelSamples& unguided,
                                              const PixelSamples& guided, uint32_t width);

// Whether guided samples, whose rays take `guidedCost` times as long, are worse with a confidence of 99 %.
// What was spent on the guide is spent in either case.
bool guidingIsWorse(const GuidingGain& gain, double guidedCost);

// A guide that could be built once more, and what would follow. Samples are those of all pixels.
struct PossibleRefinement {
  double predictedRatio;  // of the variance of a guided sample to an unguided one's (GuidingPrediction)
  double raysPerSample;   // that follow the first vertex
  double cells;           // of the guide
  double seen, learned;   // samples that it has learned from, and that it would learn from
  double remaining;       // samples that it would guide
  double builtCellCost, recordedRayCost;  // in the time of a ray (FrameOptions)
};

// Whether that is worth the time of recording and building. What maps save at all tells what better ones
// would: where it is little, or cells have seen many samples, a guide that has seen more saves little more.
bool refinementPays(const PossibleRefinement& possible);

}  // namespace odis::core
