#include "eval/variance_split.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "eval/median.h"
#include "eval/metrics.h"
#include "render/integrators/sample_image.h"

namespace odis::eval {

using namespace render;

namespace {

// Samples are summed in so many groups, each of which the jackknife leaves out once.
constexpr int kMostGroups = 16;

// Sums of T_S for each row (a cause, or at last everything), group of samples and pixel.
class Sums {
 public:
  Sums(size_t rows, size_t groups, size_t pixels) : m_groups(groups), m_pixels(pixels) {
    m_sums.assign(rows, std::vector<float>(groups * pixels));
  }

  // Adds half the squared differences of two samples of each pixel.
  void add(size_t row, size_t group, const std::vector<Rgbd>& weights, const std::vector<Rgb>& a,
           const std::vector<Rgb>& b) {
    float* sums = m_sums[row].data() + group * m_pixels;
    for (size_t i = 0; i < m_pixels; ++i) {
      const Rgbd difference = Rgbd(a[i].x, a[i].y, a[i].z) - Rgbd(b[i].x, b[i].y, b[i].z);
      const Rgbd squares = weights[i] * difference * difference;
      sums[i] += float((squares.x + squares.y + squares.z) / 2);
    }
  }

  // A row's estimate for each pixel.
  std::vector<float> map(size_t row, int samples) const {
    std::vector<float> result(m_pixels);
    for (size_t i = 0; i < m_groups * m_pixels; ++i) result[i % m_pixels] += m_sums[row][i] / float(samples);
    return result;
  }
  // Of each group, over these pixels.
  std::vector<double> totals(size_t row, const std::vector<uint32_t>& pixels) const {
    std::vector<double> result(m_groups);
    for (size_t group = 0; group < m_groups; ++group)
      for (const uint32_t i : pixels) result[group] += double(m_sums[row][group * m_pixels + i]);
    return result;
  }

 private:
  size_t m_groups, m_pixels;
  std::vector<std::vector<float>> m_sums;
};

// All pixels but those with the largest entries in any of the maps.
std::vector<uint32_t> keptPixels(const std::vector<std::vector<float>>& maps) {
  const size_t count = maps.front().size();
  std::vector<uint32_t> pixels(count);
  std::iota(pixels.begin(), pixels.end(), 0u);
  std::vector<float> worst(count);
  for (const std::vector<float>& map : maps)
    for (size_t i = 0; i < count; ++i) worst[i] = std::max(worst[i], map[i]);
  const size_t kept = count - size_t(kTrimmedShare * double(count));
  std::stable_sort(pixels.begin(), pixels.end(), [&](uint32_t a, uint32_t b) { return worst[a] < worst[b]; });
  pixels.resize(kept);
  std::sort(pixels.begin(), pixels.end());  // sums don't depend on how ranks came about
  return pixels;
}

// The sum of `a` over that of `b` and its error by leaving out one group after the other (Quenouille 1956,
// Tukey 1958).
Estimated jackknifedRatio(const std::vector<double>& a, const std::vector<double>& b) {
  const double sumA = std::accumulate(a.begin(), a.end(), 0.0),
               sumB = std::accumulate(b.begin(), b.end(), 0.0);
  if (!(sumB > 0)) return {};
  const auto n = double(a.size());
  std::vector<double> without;
  for (size_t i = 0; i < a.size(); ++i) without.push_back(sumB > b[i] ? (sumA - a[i]) / (sumB - b[i]) : 0);
  const double middle = mean(without);
  double squares = 0;
  for (const double value : without) squares += (value - middle) * (value - middle);
  return {sumA / sumB, std::sqrt(squares * (n - 1) / n)};
}

VarianceSplit evaluate(const Sums& sums, int samples, const std::vector<double>& samplesOfGroups) {
  const size_t causeCount = causes().size();
  VarianceSplit result;
  std::vector<std::vector<float>> maps;
  for (size_t row = 0; row <= causeCount; ++row) maps.push_back(sums.map(row, samples));
  const std::vector<uint32_t> pixels = keptPixels(maps);
  result.varianceMap = std::move(maps.back());
  maps.pop_back();
  result.maps = std::move(maps);

  const std::vector<double> all = sums.totals(causeCount, pixels);
  std::vector<double> counts = samplesOfGroups;
  for (double& count : counts) count *= double(pixels.size());
  result.variance = jackknifedRatio(all, counts);
  for (size_t row = 0; row < causeCount; ++row)
    result.shares.push_back(jackknifedRatio(sums.totals(row, pixels), all));
  return result;
}

}  // namespace

const std::vector<Cause>& causes() {
  constexpr Purposes kSurvival = kFirstSurvival | kLaterSurvival;
  static const std::vector<Cause> list{
      {"pixel and lens", "pixel, lens", kPixelAndLens},
      {"of visible emission only", "emission", kPixelAndLens, true},
      {"first vertex: which light", "1st light", kFirstLightChoice},
      {"first vertex: point on the light", "1st point", kFirstLightPoint},
      {"first vertex: direction", "1st direction", kFirstDirection},
      {"later vertices: which light", "later light", kLaterLightChoice},
      {"later vertices: point on the light", "later point", kLaterLightPoint},
      {"later vertices: direction", "later direction", kLaterDirection},
      {"roulette", "roulette", kSurvival},
      {"all choices of lights", "all lights", kFirstLightChoice | kLaterLightChoice},
      {"all next-event estimation", "all NEE",
       kFirstLightChoice | kLaterLightChoice | kFirstLightPoint | kLaterLightPoint},
      {"all directions", "all directions", kFirstDirection | kLaterDirection},
      {"everything after the camera ray", "after camera", kAllPurposes & ~kPixelAndLens},
      {"everything after the first direction", "after 1st direction",
       kLaterLightChoice | kLaterLightPoint | kLaterDirection | kSurvival},
  };
  return list;
}

VarianceSplit splitVariance(const Scene& scene, const RenderOptions& options, const ColorImage& reference,
                            int samples, Progress& progress) {
  const std::vector<Rgbd> weights = relMseWeights(reference);
  const Crop& crop = scene.film().crop;
  if (reference.width != crop.width || reference.height != crop.height)
    throw std::invalid_argument("the reference differs in size");
  const size_t groups = size_t(std::min(samples, kMostGroups)), all = causes().size();
  Sums sums(all + 1, groups, weights.size());
  std::vector<double> samplesOfGroups(groups);
  uint64_t rays = 0;
  renderSamples(scene, options, progress, [&](const SampleRenderer& renderSample) {
    progress.begin("split", uint64_t(samples) * weights.size() * (all + 1));
    for (int i = 0; i < samples && !progress.cancelled(); ++i) {
      const size_t group = size_t(i) * groups / size_t(samples);
      ++samplesOfGroups[group];
      const SampleImage base = renderSample(uint32_t(i), 0);
      rays += base.rays;
      SampleImage other;
      Purposes redrawn = 0;  // in `other`
      for (size_t row = 0; row <= all; ++row) {
        const Cause cause = row < all ? causes()[row] : Cause{"", "", kAllPurposes};
        if (cause.purposes != redrawn) other = renderSample(uint32_t(i), redrawn = cause.purposes);
        sums.add(row, group, weights, cause.emission ? base.emitted : base.value,
                 cause.emission ? other.emitted : other.value);
      }
    }
    progress.end();
  });
  if (progress.cancelled()) return {};
  VarianceSplit result = evaluate(sums, samples, samplesOfGroups);
  result.raysPerSample = double(rays) / (double(samples) * double(weights.size()));
  return result;
}

Estimated ratio(const Estimated& a, const Estimated& b) {
  if (!(b.value > 0)) return {};
  const double value = a.value / b.value;
  return {value, std::hypot(a.error / b.value, value * b.error / b.value)};
}

}  // namespace odis::eval
