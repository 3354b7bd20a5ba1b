// What a frame decides between its passes by what samples have cost and brought: how many samples pixels get,
// whether the guide is refined, whether there is one. No clock is read, so that bits stay the same.
#include "odis/frame_data.h"
#include "odis/image/guiding_gain.h"
#include "odis/image/sample_counts.h"
#include "odis/models/lights.h"

namespace odis::core {

// The time to build a cell without a map of its own, over that with one.
constexpr double kCostWithoutMaps = 0.25;
// Where paths trace fewer rays than this beyond their first vertex, learned roulette saves less time than
// looking it up takes.
constexpr double kFewRays = 3;

// Settles how many samples each pixel has.
void Frame::Data::spreadSamples() {
  std::vector<PixelNoise> noise(pixelCount);
  tasks->forEach(options.height, [&](size_t row) {
    for (size_t pixel = row * options.width; pixel < (row + 1) * options.width; ++pixel) {
      PixelSums sums = pilot[pixel];
      addSums(sums, later[pixel]);
      noise[pixel] = noiseOf(sums);
    }
  });
  schedule.spread(sampleCounts(*tasks, noise, int(options.width), schedule.most()));
}

// Whether the guide should be built once more, after as many more samples as were guided and one.
bool Frame::Data::nextRefinementPays() const {
  const double pixels = double(pixelCount), learnedInPass = std::min(pixels, double(kMostGuidedSamples));
  const double pilotSamples = double(schedule.pilotSamples()), next = 2.0 * done + 1;
  PossibleRefinement possible;
  possible.predictedRatio = cells.predictedVarianceRatio();
  possible.raysPerSample = cells.raysPerPath();
  possible.cells = builder->visitedCells();
  possible.seen = std::min(pilotSamples, double(kMostPilotSamples)) + done * learnedInPass;
  possible.learned = (next - done) * learnedInPass;
  possible.remaining = (schedule.most() - next) * pixels - pilotSamples;
  possible.builtCellCost = options.builtCellCost * (cells.guidesDirections() ? 1 : kCostWithoutMaps);
  possible.recordedRayCost = options.recordedRayCost;
  return refinementPays(possible);
}

// Lets the guide learn no more where that does not pay. A builder that others learn from learns on, and so
// does a guide of which nothing was predicted, or that learns about many groups of lights: the prediction
// knows maps alone.
void Frame::Data::settleRefinement() {
  if (guideOptions.lightGroups > kFewGroups) return;
  const bool predicted = guideOptions.fixedBsdfFraction == 0 && cells.raysPerPath() > 0;
  if (options.guidedCost > 0 && ownsBuilder && predicted && !nextRefinementPays()) endRefinement();
}

void Frame::Data::endRefinement() {
  schedule.endRefinement();
  if (done > 0 || laterSamplesTaken > 0) return;
  schedule.spreadLater();
  later = keptOfLater(options, schedule);
}

// Whether the pilot tells that a guide would not save what its look-ups take: no directions, no lights, and
// few rays. The radiance cache needs its cells in any case.
bool Frame::Data::guideSavesNothing() const {
  if (options.guidedCost == 0 || !ownsBuilder || paper || guideOptions.caches()) return false;
  return cells.raysPerPath() > 0 && cells.raysPerPath() < kFewRays && !cells.guidesDirections() &&
         !cells.choosesLights();
}

// Whether the first guided samples, compared with the pilot's, were clearly not worth their time.
bool Frame::Data::guidingDoesNotPay() {
  if (!options.guided || guidingGivenUp || options.oracleSamples() > 0 || options.guidedCost == 0)
    return false;
  if (end != schedule.comparedAfter() || end >= schedule.mostRemaining()) return false;
  const std::optional<GuidingGain> gain = guidedOverUnguided(*tasks, pilot, later, options.width);
  if (gain) measuredCostRatio = gain->ratio * options.guidedCost;
  return gain && guidingIsWorse(*gain, options.guidedCost);
}

// Goes on without a guide. No sample's weight changes, nor how many there are: only samples that are still to
// be drawn know of it, and their mean is the same in any case.
void Frame::Data::giveUpGuiding() {
  guidingGivenUp = true;
  guide = cells = Guide();
  ++guidesBuilt;
  endRefinement();
  takeStock();
}

}  // namespace odis::core
