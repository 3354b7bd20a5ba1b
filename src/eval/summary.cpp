#include "eval/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "eval/median.h"

namespace odis::eval {

namespace {

using Runs = std::vector<const Measurement*>;
using Field = std::function<double(const Measurement&)>;

double errorOf(const Measurement& m) {
  return m.error.trimmedRelMse;
}
double untrimmedOf(const Measurement& m) {
  return m.error.relMse;
}
double errorTimeOf(const Measurement& m) {
  return errorOf(m) * m.cpuSeconds;
}
double errorRaysOf(const Measurement& m) {
  return errorOf(m) * double(m.rays);
}

std::vector<double> valuesOf(const Runs& runs, const Field& field) {
  std::vector<double> values;
  for (const Measurement* run : runs) values.push_back(field(*run));
  return values;
}

// A row and the resamples of its ratios, from which those of means over scenes are made.
struct Entry {
  ComparisonRow row;
  Runs runs;
  std::vector<double> error, untrimmed, errorTime, errorRays;
};

// The ratio of `field` of the seeds that both have.
Interval ratioOf(const Runs& runs, const Runs& base, const Field& field, Middle middle,
                 std::vector<double>& resamples) {
  std::vector<double> a, b;
  for (const Measurement* run : runs) {
    const auto same = std::find_if(base.begin(), base.end(), [&](auto* m) { return m->seed == run->seed; });
    if (same == base.end()) continue;
    a.push_back(field(*run));
    b.push_back(field(**same));
  }
  constexpr uint64_t kSeed = 1;
  resamples = a.empty() ? std::vector<double>(kResamples, NAN) : resampledRatios(a, b, kSeed, middle);
  return intervalOf(a.empty() ? NAN : middle(a) / middle(b), resamples);
}

void fillRow(Entry& entry) {
  ComparisonRow& row = entry.row;
  const Measurement& first = *entry.runs.front();
  row.scene = first.scene;
  row.method = first.method;
  row.spp = first.spp;
  row.equalTime = first.equalTime;
  row.denoised = first.denoised;
  row.seeds = int(entry.runs.size());
  const auto medianBy = [&](const Field& field) { return median(valuesOf(entry.runs, field)); };
  row.error.mse = medianBy([](const Measurement& m) { return m.error.mse; });
  row.error.relMse = medianBy([](const Measurement& m) { return m.error.relMse; });
  row.error.trimmedRelMse = medianBy(errorOf);
  row.error.smape = medianBy([](const Measurement& m) { return m.error.smape; });
  row.error.flip = medianBy([](const Measurement& m) { return m.error.flip; });
  row.error.ssim = medianBy([](const Measurement& m) { return m.error.ssim; });
  row.mean = meanWithInterval(valuesOf(entry.runs, [](const Measurement& m) { return m.error.mean; }));
  for (const Measurement* run : entry.runs) row.error.nonFinitePixels += run->error.nonFinitePixels;
  row.seconds = medianBy([](const Measurement& m) { return m.seconds; });
  row.cpuSeconds = medianBy([](const Measurement& m) { return m.cpuSeconds; });
  row.rays = medianBy([](const Measurement& m) { return double(m.rays); });
  row.samples = medianBy([](const Measurement& m) { return m.samples; });
  for (const Measurement* run : entry.runs)
    if (run->seed == 0) row.image = run->image;
}

void fillRatios(Entry& entry, const Entry& base) {
  ComparisonRow& row = entry.row;
  row.errorRatio = ratioOf(entry.runs, base.runs, errorOf, median, entry.error);
  row.untrimmedRatio = ratioOf(entry.runs, base.runs, untrimmedOf, mean, entry.untrimmed);
  row.errorTimeRatio = ratioOf(entry.runs, base.runs, errorTimeOf, median, entry.errorTime);
  row.errorRaysRatio = ratioOf(entry.runs, base.runs, errorRaysOf, median, entry.errorRays);
  row.cpuSecondsRatio = row.cpuSeconds / base.row.cpuSeconds;
  row.raysRatio = row.rays / base.row.rays;
}

// Whether two rows of a method are of the same images.
bool sameImages(const ComparisonRow& a, const ComparisonRow& b) {
  return a.scene == b.scene && a.method == b.method && a.denoised == b.denoised && !a.image.empty() &&
         a.image == b.image;
}

bool sameKind(const ComparisonRow& a, const ComparisonRow& b) {
  return a.method == b.method && a.spp == b.spp && a.equalTime == b.equalTime && a.denoised == b.denoised;
}

// Groups by scene, samples and method, in order of appearance.
std::vector<Entry> group(const std::vector<Measurement>& measurements) {
  std::vector<Entry> entries;
  for (const Measurement& m : measurements) {
    auto entry = std::find_if(entries.begin(), entries.end(), [&](const Entry& known) {
      const Measurement& first = *known.runs.front();
      return first.scene == m.scene && first.method == m.method && first.spp == m.spp &&
             first.equalTime == m.equalTime && first.denoised == m.denoised;
    });
    if (entry == entries.end()) entry = entries.insert(entries.end(), Entry());
    entry->runs.push_back(&m);
  }
  return entries;
}

Interval geometricMean(const std::vector<const Entry*>& entries, Interval ComparisonRow::*value,
                       std::vector<double> Entry::*resamples) {
  double logs = 0;
  std::vector<double> sums(kResamples, 0.0);
  for (const Entry* entry : entries) {
    logs += std::log((entry->row.*value).value);
    for (size_t i = 0; i < sums.size(); ++i) sums[i] += std::log((entry->*resamples)[i]);
  }
  const auto count = double(entries.size());
  for (double& sum : sums) sum = std::exp(sum / count);
  return intervalOf(std::exp(logs / count), std::move(sums));
}

// The rows of one kind over all scenes.
ComparisonRow meanOf(const std::vector<const Entry*>& entries) {
  ComparisonRow row;
  row.scene = ComparisonRow::kAllScenes;
  const ComparisonRow& first = entries.front()->row;
  row.method = first.method;
  row.spp = first.spp;
  row.equalTime = first.equalTime;
  row.denoised = first.denoised;
  row.seeds = first.seeds;
  row.errorRatio = geometricMean(entries, &ComparisonRow::errorRatio, &Entry::error);
  row.untrimmedRatio = geometricMean(entries, &ComparisonRow::untrimmedRatio, &Entry::untrimmed);
  row.errorTimeRatio = geometricMean(entries, &ComparisonRow::errorTimeRatio, &Entry::errorTime);
  row.errorRaysRatio = geometricMean(entries, &ComparisonRow::errorRaysRatio, &Entry::errorRays);
  double seconds = 0, rays = 0, samples = 0, needed = 0;
  bool allWithin = true;
  for (const Entry* entry : entries) {
    seconds += std::log(entry->row.cpuSecondsRatio);
    rays += std::log(entry->row.raysRatio);
    samples += std::log(entry->row.samples);
    needed += std::log(entry->row.needed.samples);
    allWithin = allWithin && entry->row.needed.where == SamplesNeeded::within;
  }
  const auto count = double(entries.size());
  row.cpuSecondsRatio = std::exp(seconds / count);
  row.raysRatio = std::exp(rays / count);
  row.samples = std::exp(samples / count);
  if (allWithin) row.needed = {SamplesNeeded::within, std::exp(needed / count)};
  return row;
}

}  // namespace

std::vector<ComparisonRow> summarize(const std::vector<Measurement>& measurements) {
  std::vector<Entry> entries = group(measurements);
  for (Entry& entry : entries) fillRow(entry);
  const std::string first = entries.empty() ? "" : entries.front().row.method;

  for (Entry& entry : entries) {
    // The first method with as many samples, and its whole curve, on the same scene.
    std::vector<CurvePoint> curve;
    const Entry* base = nullptr;
    for (const Entry& other : entries) {
      if (other.row.scene != entry.row.scene || other.row.method != first || other.row.equalTime ||
          other.row.denoised != entry.row.denoised)
        continue;
      curve.push_back({double(other.row.spp), other.row.error.trimmedRelMse});
      if (other.row.spp == entry.row.spp) base = &other;
    }
    if (base) fillRatios(entry, *base);
    entry.row.needed = samplesNeeded(curve, entry.row.error.trimmedRelMse);
  }

  std::vector<ComparisonRow> rows;
  for (const Entry& entry : entries) {
    rows.push_back(entry.row);
    if (!entry.row.equalTime) continue;
    const auto same = std::find_if(rows.begin(), rows.end() - 1,
                                   [&](const ComparisonRow& row) { return sameImages(row, entry.row); });
    if (same != rows.end() - 1)
      rows.back().sameAs = fmt::format(fmt::runtime(same->equalTime ? "time of {}" : "{} spp"), same->spp);
  }
  if (rows.empty() || rows.front().scene == rows.back().scene) return rows;
  // A mean over some scenes only, because the comparison was interrupted, would mean nothing next to others.
  size_t scenes = 0;
  for (size_t i = 0; i < entries.size(); ++i)
    scenes += i == 0 || entries[i].row.scene != entries[i - 1].row.scene;
  for (const Entry& kind : entries) {
    if (kind.row.scene != entries.front().row.scene) continue;
    std::vector<const Entry*> same;
    for (const Entry& entry : entries)
      if (sameKind(entry.row, kind.row) && !entry.error.empty()) same.push_back(&entry);
    if (same.size() == scenes) rows.push_back(meanOf(same));
  }
  return rows;
}

}  // namespace odis::eval
