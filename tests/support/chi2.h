// Pearson's chi-squared test of a direction sampler against its density, in the manner of Mitsuba's chi2.py.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

namespace odis::test {

// The greatest number below 1.
inline constexpr float kOneMinusEpsilon = 0x1.fffffep-1f;

// Upper regularised incomplete gamma function Q(a, x) by series or continued fraction (Abramowitz and
// Stegun 6.5).
inline double gammaQ(double a, double x) {
  if (x <= 0) return 1;
  const double scale = std::exp(-x + a * std::log(x) - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < 10000 && std::abs(term) > std::abs(sum) * 1e-15; ++n) sum += term *= x / (a + n);
    return 1 - sum * scale;
  }
  double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
  for (int n = 1; n < 10000; ++n) {
    const double an = -n * (n - a);
    b += 2;
    d = an * d + b;
    if (std::abs(d) < 1e-300) d = 1e-300;
    c = b + an / c;
    if (std::abs(c) < 1e-300) c = 1e-300;
    d = 1 / d;
    const double delta = d * c;
    h *= delta;
    if (std::abs(delta - 1) < 1e-15) break;
  }
  return h * scale;
}

// The p-value of a chi-squared statistic with so many degrees of freedom.
inline double chi2PValue(double statistic, int degrees) {
  return gammaQ(degrees / 2.0, statistic / 2.0);
}

struct Chi2Options {
  int thetaCells = 24, phiCells = 48;  // equal in cos(theta) and in phi
  int samples = 200000;
  int quadrature = 12;  // midpoint samples per cell and axis; raise it for sharp densities
  double significance = 0.01;
  int testCount = 1;  // for the Šidák correction: how many tests the suite makes
  uint64_t seed = 1;
};

// `sample(u)` gives a direction (of any type with x, y and z), or nothing if it fails, from three uniform
// numbers; `pdf(w)` its solid-angle density. Failed samples count against a total probability of less than
// one. Pools cells expected to hold fewer than five.
template <class Sample, class Pdf>
::testing::AssertionResult chi2Test(Sample&& sample, Pdf&& pdf, const Chi2Options& options = {}) {
  using Direction = typename decltype(std::optional(sample(0.0f, 0.0f, 0.0f)))::value_type;
  constexpr float kPi = std::numbers::pi_v<float>;
  const int cells = options.thetaCells * options.phiCells;
  std::vector<double> observed(cells + 1, 0.0), expected(cells + 1, 0.0);
  std::mt19937_64 engine(options.seed);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  const auto draw = [&] { return std::min(uniform(engine), kOneMinusEpsilon); };
  for (int i = 0; i < options.samples; ++i) {
    const float u0 = draw(), u1 = draw(), u2 = draw();
    const std::optional w = sample(u0, u1, u2);
    if (!w) {
      observed[cells] += 1;
      continue;
    }
    const int row = std::clamp(int((w->z + 1) / 2 * options.thetaCells), 0, options.thetaCells - 1);
    float phi = std::atan2(w->y, w->x);
    if (phi < 0) phi += 2 * kPi;
    const int column = std::clamp(int(phi / (2 * kPi) * options.phiCells), 0, options.phiCells - 1);
    observed[row * options.phiCells + column] += 1;
  }
  const int q = options.quadrature;
  const double cellMeasure = 4 * std::numbers::pi / cells;
  double total = 0;
  for (int row = 0; row < options.thetaCells; ++row)
    for (int column = 0; column < options.phiCells; ++column) {
      double sum = 0;
      for (int i = 0; i < q; ++i)
        for (int j = 0; j < q; ++j) {
          const double z = -1 + 2 * (row + (i + 0.5) / q) / options.thetaCells;
          const double phi = 2 * std::numbers::pi * (column + (j + 0.5) / q) / options.phiCells;
          const double r = std::sqrt(std::max(0.0, 1 - z * z));
          sum += pdf(Direction{float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)});
        }
      const double probability = sum / (q * q) * cellMeasure;
      total += probability;
      expected[row * options.phiCells + column] = probability * options.samples;
    }
  if (total > 1.01) return ::testing::AssertionFailure() << "the density integrates to " << total << " > 1";
  expected[cells] = std::max(0.0, 1 - total) * options.samples;

  std::vector<int> order(cells + 1);
  for (int i = 0; i <= cells; ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](int a, int b) { return expected[a] < expected[b]; });
  double statistic = 0, pooledExpected = 0, pooledObserved = 0;
  int degrees = -1;
  for (int i : order) {
    if (expected[i] == 0 && i < cells && observed[i] > options.samples * 1e-5)
      return ::testing::AssertionFailure()
             << observed[i] << " samples in cell " << i << " where the density is zero";
    pooledExpected += expected[i];
    pooledObserved += observed[i];
    if (pooledExpected < 5) continue;
    statistic += (pooledObserved - pooledExpected) * (pooledObserved - pooledExpected) / pooledExpected;
    ++degrees;
    pooledExpected = pooledObserved = 0;
  }
  if (degrees < 1) return ::testing::AssertionSuccess() << "a single cell";
  const double p = chi2PValue(statistic, degrees);
  const double threshold = 1 - std::pow(1 - options.significance, 1.0 / options.testCount);
  if (!(p > threshold))
    return ::testing::AssertionFailure()
           << "chi2 = " << statistic << " with " << degrees << " degrees of freedom, p = " << p
           << " <= " << threshold << "; the density integrates to " << total << ", failed draws "
           << observed[cells] / options.samples;
  return ::testing::AssertionSuccess();
}

}  // namespace odis::test
