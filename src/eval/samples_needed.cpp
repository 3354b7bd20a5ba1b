#include "eval/samples_needed.h"

#include <cmath>

namespace odis::eval {

SamplesNeeded samplesNeeded(const std::vector<CurvePoint>& curve, double error) {
  const auto hasLog = [](double x) { return std::isfinite(x) && x > 0; };
  if (curve.size() < 2 || !hasLog(error)) return {};
  for (const CurvePoint& point : curve)
    if (!hasLog(point.error) || !hasLog(point.samples)) return {};
  if (curve.front().error < error) return {SamplesNeeded::below, curve.front().samples};
  if (curve.front().error == error) return {SamplesNeeded::within, curve.front().samples};
  for (size_t i = 1; i < curve.size(); ++i) {
    if (curve[i].error > error) continue;
    const CurvePoint &a = curve[i - 1], &b = curve[i];
    const double share = std::log(a.error / error) / std::log(a.error / b.error);
    return {SamplesNeeded::within, a.samples * std::pow(b.samples / a.samples, share)};
  }
  return {SamplesNeeded::beyond, curve.back().samples};
}

}  // namespace odis::eval
