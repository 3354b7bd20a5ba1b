// Reconstruction filters: their values, their moments, and that sampling reproduces them.
#include <gtest/gtest.h>

#include <random>

#include "render/film/filter.h"
#include "support/chi2.h"

namespace odis::render {
namespace {

struct Case {
  std::string name;
  std::function<std::unique_ptr<Filter>()> make;
};

std::vector<Case> cases() {
  return {{"box", [] { return makeBoxFilter(); }},
          {"box", [] { return makeBoxFilter(1.5f); }},
          {"tent", [] { return makeTentFilter(); }},
          {"tent", [] { return makeTentFilter(2.25f); }},
          {"gaussian", [] { return makeGaussianFilter(); }},
          {"gaussian", [] { return makeGaussianFilter(0.3f); }},
          {"mitchell", [] { return makeMitchellFilter(); }},
          {"mitchell", [] { return makeMitchellFilter(1.0f, 0.0f); }},
          {"catmullrom", [] { return makeMitchellFilter(0.0f, 0.5f); }},
          {"lanczos", [] { return makeLanczosFilter(); }},
          {"lanczos", [] { return makeLanczosFilter(2); }}};
}

// Midpoint quadrature of value(x, y) g(x, y) over the support.
template <class G>
double integrate(const Filter& filter, G&& g, int n = 800) {
  const double r = filter.radius(), h = 2 * r / n;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const Vec2 p(float(-r + (i + 0.5) * h), float(-r + (j + 0.5) * h));
      sum += filter.value(p) * g(p);
    }
  return sum * h * h;
}

TEST(Filter, SamplesManyAsItSamplesEach) {
  constexpr size_t kCount = 13;  // leaves lanes unused
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (const Case& c : cases()) {
    const auto filter = c.make();
    Column u{}, v{};
    for (size_t i = 0; i < kCount; ++i) {
      u[i] = uniform(engine);
      v[i] = uniform(engine);
    }
    FilterSamples samples;
    filter->sampleEach(kCount, u, v, samples);
    for (size_t i = 0; i < kCount; ++i) {
      const FilterSample expected = filter->sample({u[i], v[i]});
      EXPECT_EQ(Vec2(samples.x[i], samples.y[i]), expected.offset) << c.name;
      EXPECT_EQ(samples.weight[i], expected.weight) << c.name;
    }
  }
}

TEST(Filter, NamesAndRadii) {
  for (const Case& c : cases()) EXPECT_EQ(c.make()->name(), c.name);
  EXPECT_FLOAT_EQ(makeBoxFilter()->radius(), 0.5f);
  EXPECT_FLOAT_EQ(makeTentFilter()->radius(), 1.0f);
  EXPECT_FLOAT_EQ(makeGaussianFilter()->radius(), 2.0f);
  EXPECT_FLOAT_EQ(makeMitchellFilter()->radius(), 2.0f);
  EXPECT_FLOAT_EQ(makeLanczosFilter()->radius(), 3.0f);
}

TEST(Filter, IntegratesToOneAndEndsAtItsRadius) {
  for (const Case& c : cases()) {
    const auto filter = c.make();
    EXPECT_NEAR(integrate(*filter, [](Vec2) { return 1.0; }), 1.0, 1e-4) << c.name;
    const float outside = filter->radius() * 1.001f;
    EXPECT_EQ(filter->value({outside, 0.0f}), 0.0f) << c.name;
    EXPECT_EQ(filter->value({0.0f, -outside}), 0.0f) << c.name;
  }
}

// The profiles by hand: ratios of values along x, so that the normalisation plays no part.
TEST(Filter, KnownValues) {
  const auto ratio = [](const Filter& f, float x) { return f.value({x, 0.0f}) / f.value({0.0f, 0.0f}); };
  EXPECT_NEAR(ratio(*makeTentFilter(), 0.25f), 0.75f, 1e-6f);
  // exp(-x^2 / (2 0.25)) - exp(-8), over its value at 0.
  const float end = std::exp(-8.0f);
  EXPECT_NEAR(ratio(*makeGaussianFilter(), 0.7f), (std::exp(-0.98f) - end) / (1 - end), 1e-6f);
  // B = C = 1/3: k(0) = 16/18, k(1) = 1/18, k(1.5) = -5/144.
  EXPECT_NEAR(ratio(*makeMitchellFilter(), 1.0f), 1.0f / 16.0f, 1e-6f);
  EXPECT_NEAR(ratio(*makeMitchellFilter(), 1.5f), -5.0f / 128.0f, 1e-6f);
  // Catmull-Rom interpolates: 1 at 0, 0 at 1; k(0.5) = 9/16, k(1.5) = -1/16.
  EXPECT_NEAR(makeMitchellFilter(0.0f, 0.5f)->value({0.0f, 0.0f}), 1.0f, 1e-6f);
  EXPECT_NEAR(ratio(*makeMitchellFilter(0.0f, 0.5f), 1.0f), 0.0f, 1e-6f);
  EXPECT_NEAR(ratio(*makeMitchellFilter(0.0f, 0.5f), 0.5f), 9.0f / 16.0f, 1e-6f);
  EXPECT_NEAR(ratio(*makeMitchellFilter(0.0f, 0.5f), 1.5f), -1.0f / 16.0f, 1e-6f);
}

// E[weight g(offset)] must be the integral of filter times g, for g = 1, x, x^2, x^2 y^2 and a step.
TEST(Filter, WeightedSamplesIntegrate) {
  const std::vector<std::function<double(Vec2)>> functions = {
      [](Vec2) { return 1.0; }, [](Vec2 p) { return double(p.x); }, [](Vec2 p) { return double(p.x) * p.x; },
      [](Vec2 p) { return double(p.x) * p.x * p.y * p.y; },
      [](Vec2 p) { return p.x + 2 * p.y > 0.3 ? 1.0 : 0.0; }};
  const int tests = int(cases().size() * functions.size());
  // Two-sided z for significance 0.01 over so many tests, by bisection on the normal tail.
  const double alpha = 1 - std::pow(0.99, 1.0 / tests);
  double low = 0, high = 10;
  while (high - low > 1e-6)
    (std::erfc((low + high) / 2 / std::sqrt(2.0)) > alpha ? low : high) = (low + high) / 2;
  std::mt19937_64 engine(7);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  for (const Case& c : cases()) {
    const auto filter = c.make();
    constexpr int n = 200000;
    std::vector<double> sum(functions.size()), squares(functions.size());
    for (int i = 0; i < n; ++i) {
      const float u = std::min(uniform(engine), kOneMinusEpsilon),
                  v = std::min(uniform(engine), kOneMinusEpsilon);
      const FilterSample s = filter->sample({u, v});
      ASSERT_LE(std::abs(s.offset.x), filter->radius());
      ASSERT_LE(std::abs(s.offset.y), filter->radius());
      for (size_t k = 0; k < functions.size(); ++k) {
        const double y = s.weight * functions[k](s.offset);
        sum[k] += y;
        squares[k] += y * y;
      }
    }
    for (size_t k = 0; k < functions.size(); ++k) {
      const double mean = sum[k] / n, error = std::sqrt(std::max(0.0, squares[k] / n - mean * mean) / n);
      // The quadrature of the step has an error of its own, about its cell.
      const double expected = integrate(*filter, functions[k]), slack = k == 4 ? 1e-3 : 1e-4;
      EXPECT_NEAR(mean, expected, high * error + slack) << c.name << ", function " << k;
    }
  }
}

// The density that weight and value imply, value / weight, is the one that the samples have: per axis by
// chi-squared.
TEST(Filter, SamplesFollowTheirDensity) {
  const int tests = int(cases().size()) * 2;
  const double threshold = 1 - std::pow(1 - 0.01, 1.0 / tests);
  for (const Case& c : cases()) {
    const auto filter = c.make();
    const double r = filter->radius();
    constexpr int cells = 60, n = 200000, steps = 200;
    // |profile| per cell, normalised; value(x, 0) is the profile but for a constant.
    std::vector<double> expected(cells);
    double total = 0;
    for (int i = 0; i < cells; ++i)
      for (int j = 0; j < steps; ++j) {
        const double x = -r + 2 * r * (i + (j + 0.5) / steps) / cells;
        const double f = std::abs(filter->value({float(x), 0.0f}));
        expected[i] += f;
        total += f;
      }
    std::vector<double> observed[2] = {std::vector<double>(cells), std::vector<double>(cells)};
    std::mt19937_64 engine(11);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    for (int i = 0; i < n; ++i) {
      const float u = std::min(uniform(engine), kOneMinusEpsilon),
                  v = std::min(uniform(engine), kOneMinusEpsilon);
      const FilterSample s = filter->sample({u, v});
      for (int axis = 0; axis < 2; ++axis)
        observed[axis][std::clamp(int((s.offset[axis] + r) / (2 * r) * cells), 0, cells - 1)] += 1;
    }
    for (const std::vector<double>& counts : observed) {
      double statistic = 0, pooledExpected = 0, pooledObserved = 0;
      int degrees = -1;
      for (int i = 0; i < cells; ++i) {
        pooledExpected += expected[i] / total * n;
        pooledObserved += counts[i];
        if (pooledExpected < 5) continue;
        statistic += sqr(float(pooledObserved - pooledExpected)) / pooledExpected;
        pooledExpected = pooledObserved = 0;
        ++degrees;
      }
      EXPECT_GT(test::chi2PValue(statistic, degrees), threshold) << c.name << ": chi2 = " << statistic;
    }
  }
}

// Filters without negative lobes need no weight.
TEST(Filter, PositiveFiltersHaveUnitWeights) {
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  for (const auto& filter : {makeBoxFilter(), makeTentFilter()})
    EXPECT_EQ(filter->sample({uniform(engine), uniform(engine)}).weight, 1.0f);
  const auto gaussian = makeGaussianFilter();
  for (int i = 0; i < 1000; ++i) {
    const FilterSample s = gaussian->sample({uniform(engine), uniform(engine)});
    EXPECT_NEAR(s.weight, 1.0f, 0.01f) << s.offset.x << ", " << s.offset.y;
  }
}

// The filter over the offsets between two places of an axis, times g, by the midpoint rule; but for a factor.
template <class G>
double integrateAxis(const Filter& filter, double from, double to, G&& g) {
  constexpr int n = 4000;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double x = from + (i + 0.5) / n * (to - from);
    sum += filter.value({float(x), 0.0f}) * g(x);
  }
  return sum * (to - from) / n;
}

// On films of few pixels, from even numbers: what lies beyond the film is not drawn, and what lies on it
// counts as the filter says, over the filter's integral on the film.
TEST(Filter, KeepsToTheFilm) {
  using Function = std::function<double(double)>;
  const Function functions[] = {[](double) { return 1.0; }, [](double x) { return x; },
                                [](double x) { return x > 0.2 ? 1.0 : 0.0; }};
  constexpr int n = 4000;
  for (const Case& c : cases()) {
    const auto filter = c.make();
    const float other = 0.4f;  // draws the place along the other axis, whose weight is divided by
    double otherWeight = 0;
    for (int i = 0; i < n; ++i) otherWeight += filter->sample({(float(i) + 0.5f) / n, other}).weight / n;
    for (const auto& [before, after] : std::vector<std::pair<int, int>>{
             {0, 0}, {0, 1}, {1, 0}, {0, 2}, {1, 1}, {2, 0}, {0, 7}, {1, 6}, {2, 5}, {5, 2}, {7, 0}}) {
      SCOPED_TRACE(c.name + " between " + std::to_string(before) + " and " + std::to_string(after));
      const FilterPart part = filter->part(before, after);
      const double from = -std::min(before + 0.5, double(filter->radius())),
                   to = std::min(after + 0.5, double(filter->radius()));
      double sums[3] = {};
      for (int i = 0; i < n; ++i) {
        const FilterSample s = filter->sample({part.number((float(i) + 0.5f) / n), other});
        ASSERT_GE(s.offset.x, from - 1e-5);
        ASSERT_LE(s.offset.x, to + 1e-5);
        for (int k = 0; k < 3; ++k)
          sums[k] += part.weight * s.weight / otherWeight * functions[k](s.offset.x) / n;
      }
      const double integral = integrateAxis(*filter, from, to, functions[0]);
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(sums[k], integrateAxis(*filter, from, to, functions[k]) / integral, 2e-3);
    }
  }
}

TEST(Filter, IsWholeAwayFromBorders) {
  for (const Case& c : cases()) {
    const auto filter = c.make();
    const FilterPart part = filter->part(filter->reach(), filter->reach());
    EXPECT_EQ(part.weight, 1.0f) << c.name;
    for (const float u : {0.0f, 1e-8f, 0.3f, 0.5f, kOneMinusEpsilon}) EXPECT_EQ(part.number(u), u) << c.name;
    EXPECT_LT(filter->radius(), float(filter->reach()) + 0.5f + 1e-6f);
  }
}

TEST(Filter, ExtremeRandomNumbersStayFinite) {
  for (const Case& c : cases()) {
    const auto filter = c.make();
    for (float u : {0.0f, 1e-8f, 0.5f, std::nextafter(0.5f, 0.0f), kOneMinusEpsilon})
      for (float v : {0.0f, 0.5f, kOneMinusEpsilon}) {
        const FilterSample s = filter->sample({u, v});
        EXPECT_TRUE(std::isfinite(s.weight) && std::isfinite(s.offset.x) && std::isfinite(s.offset.y))
            << c.name;
        EXPECT_LT(std::abs(s.weight), 3.0f) << c.name << " at " << u << ", " << v;
      }
  }
}

TEST(Filter, RefusesAbsurdParameters) {
  EXPECT_THROW(makeBoxFilter(0.0f), std::invalid_argument);
  EXPECT_THROW(makeTentFilter(-1.0f), std::invalid_argument);
  EXPECT_THROW(makeGaussianFilter(NAN), std::invalid_argument);
  EXPECT_THROW(makeMitchellFilter(INFINITY, 0.0f), std::invalid_argument);
}

}  // namespace
}  // namespace odis::render
