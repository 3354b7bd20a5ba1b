#include "odis/decisions/selection.h"

namespace odis {

namespace {

// How many samples' worth of the coarser level's sums stand behind a cell's own. Second moments have heavy
// tails: with fewer, cells take the extremes by chance.
constexpr double kPriorSamples = 2000;
// What a share of the image's rays is worth in shares of its variance. 1 is error times rays; less, because
// the rays that are saved by steering paths out of the scene are those that would have carried something.
constexpr double kCostWeight = 0.3;
// A contribution counts at most this many times the pixel's value.
constexpr float kContributionLimit = 50;
// A candidate must be predicted to save this share of what the cell costs without guiding: predictions are
// made from few samples, and the best of several looks better than it is.
constexpr double kMargin = 0.02;

// The lesser one; the limit for what is not a number.
float limited(float value, float limit) {
  return value < limit ? value : limit;
}

}  // namespace

void SelectionSums::add(const SelectionSums& other, double scale) {
  count += scale * other.count;
  for (size_t a = 0; a < kAlphas.size(); ++a) {
    secondMoment[a] += scale * other.secondMoment[a];
    rays[a] += scale * other.rays[a];
  }
}

// With D the direction's contribution at the pilot's density b and q the mixture's density, the second moment
// of the contribution under q is E_b[D^2 b / q]; next-event estimate N and direction are independent given
// the vertex, so their cross term is E[N] E[D] whatever q is. MIS weights depend on q and are made anew.
SecondMoments addVertex(CellSelection& sums, const PilotVertex& v, float mapPdf, float lightMapPdf,
                        float scale) {
  SecondMoments moments;
  SelectionSums& s = sums[int(materialClass(v.roughness))];
  s.count += 1;
  // A discrete lobe is as likely under every candidate. Anything over infinity is nothing: no weight is lost
  // where MIS does not apply.
  const float own = v.discrete ? 1 : v.pdf;
  const float gain = v.discrete ? 0 : v.guidableProbability * mapPdf - v.guidablePdf;
  const float emissionPdf = v.discrete ? 0 : v.emissionLightPdf;
  const float lightGain = v.guidableProbability * lightMapPdf - v.lightGuidablePdf;
  const float lightPdf = v.lightPdf > 0 ? v.lightPdf : INFINITY;
  const float indirect = v.indirect * scale, emission = v.emission * scale, light = v.light * scale;
  for (size_t a = 0; a < kAlphas.size(); ++a) {
    const float guided = 1 - kAlphas[a];
    const float density = own + guided * gain;  // mixturePdf
    const float ratio = own / density;
    const float emissionRatio = emissionPdf / density;
    const float direction =
        limited(indirect + emission / (1 + emissionRatio * emissionRatio), kContributionLimit);
    const float lightRatio = (v.lightBsdfPdf + guided * lightGain) / lightPdf;
    const float direct = limited(light / (1 + lightRatio * lightRatio), kContributionLimit);
    moments[a] = direct * direct + 2 * direct * direction + direction * direction * ratio;
    s.secondMoment[a] += moments[a];
    s.rays[a] += v.raysAfter / std::max(ratio, 0.05f);
  }
  return moments;
}

SelectionSums back(const SelectionSums& own, const SelectionSums& prior) {
  SelectionSums sums = own;
  if (prior.count > 0) sums.add(prior, std::min(1.0, kPriorSamples / prior.count));
  return sums;
}

size_t chooseAlpha(const SelectionSums& sums, const SelectionTotals& totals) {
  if (!(sums.count > 0) || !(totals.variance > 0) || !(totals.rays > 0)) return 0;
  std::array<double, kAlphas.size()> score;
  for (size_t a = 0; a < kAlphas.size(); ++a)
    score[a] = sums.secondMoment[a] / totals.variance + kCostWeight * sums.rays[a] / totals.rays;
  const size_t best = size_t(std::min_element(score.begin(), score.end()) - score.begin());
  return score[best] < (1 - kMargin) * score[0] ? best : 0;
}

}  // namespace odis
