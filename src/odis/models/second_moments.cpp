#include "odis/models/second_moments.h"

#include <algorithm>
#include <cmath>

#include "odis/mixture.h"

namespace odis::core {

namespace {

// Weight of the coarser level's sums beside a cell's own, in samples. Second moments have heavy
// tails: with fewer, cells take the extremes by chance.
constexpr double kMomentPriorSamples = 2000;
// What a share of the image's rays is worth in shares of its variance. 1 would be error times rays; it is
// less, because the rays that are saved by steering paths out of the scene are those that would have
// carried something.
constexpr double kCostWeight = 0.3;
// A contribution counts at most this many times the pixel's value.
constexpr float kContributionLimit = 50;
// A candidate must be predicted to save this share of what the cell costs without guiding: predictions are
// made from few samples, and the best of several looks better than it is.
constexpr double kMargin = 0.02;
// The least ratio of densities by which the number of rays is divided.
constexpr float kLeastRatio = 0.05f;

// The lesser number; the limit for what is not a number.
float limited(float value, float limit) {
  return value < limit ? value : limit;
}

}  // namespace

void MomentSums::add(const MomentSums& other, double scale) {
  count += scale * other.count;
  for (size_t a = 0; a < kBsdfFractions.size(); ++a) {
    secondMoment[a] += scale * other.secondMoment[a];
    rays[a] += scale * other.rays[a];
  }
}

// With D the direction's contribution at the pilot's density b and q the mixture's density, the second moment
// of the contribution under q is E_b[D^2 b / q]; next-event estimate N and direction are independent given
// the vertex, so their cross term is E[N] E[D] whatever q is. MIS weights depend on q and are made anew.
SecondMoments addVertex(MomentSums& sums, const FractionSample& v, float mapPdf, float lightMapPdf,
                        float scale) {
  SecondMoments moments;
  sums.count += 1;
  // A discrete lobe is as likely under every candidate. Anything over infinity is nothing: no weight is lost
  // where MIS does not apply.
  const float own = v.discrete ? 1 : v.pdf;
  const float guidablePdf = v.discrete ? 0 : v.guidablePdf;
  const float guidableProbability = v.discrete ? 0 : v.guidableProbability;
  const float emissionPdf = v.discrete ? 0 : v.emissionLightPdf;
  const float lightPdf = v.lightPdf > 0 ? v.lightPdf : INFINITY;
  const float indirect = v.indirect * scale, emission = v.emission * scale, light = v.light * scale;
  for (size_t a = 0; a < kBsdfFractions.size(); ++a) {
    const float fraction = kBsdfFractions[a];
    const float density = mixturePdf(own, guidablePdf, guidableProbability, fraction, mapPdf);
    const float ratio = own / density;
    const float emissionRatio = emissionPdf / density;
    const float direction =
        limited(indirect + emission / (1 + emissionRatio * emissionRatio), kContributionLimit);
    const float lightRatio =
        mixturePdf(v.lightBsdfPdf, v.lightGuidablePdf, v.guidableProbability, fraction, lightMapPdf) /
        lightPdf;
    const float direct = limited(light / (1 + lightRatio * lightRatio), kContributionLimit);
    moments[a] = direct * direct + 2 * direct * direction + direction * direction * ratio;
    sums.secondMoment[a] += moments[a];
    sums.rays[a] += v.raysAfter / std::max(ratio, kLeastRatio);
  }
  return moments;
}

MomentSums shrunkSums(const MomentSums& own, const MomentSums& coarser) {
  MomentSums sums = own;
  if (coarser.count > 0) sums.add(coarser, std::min(1.0, kMomentPriorSamples / coarser.count));
  return sums;
}

size_t chooseFraction(const MomentSums& sums, const ImageMoments& image) {
  if (!(sums.count > 0) || !(image.variance > 0) || !(image.rays > 0)) return 0;
  std::array<double, kBsdfFractions.size()> score;
  for (size_t a = 0; a < kBsdfFractions.size(); ++a)
    score[a] = sums.secondMoment[a] / image.variance + kCostWeight * sums.rays[a] / image.rays;
  const size_t best = size_t(std::min_element(score.begin(), score.end()) - score.begin());
  return score[best] < (1 - kMargin) * score[0] ? best : 0;
}

}  // namespace odis::core
