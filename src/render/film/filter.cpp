#include "render/film/filter.h"

#include <fmt/format.h>
#include <odis/instruction_sets.h>

#include <array>
#include <cassert>
#include <stdexcept>
#include <utility>
#include <vector>

namespace odis::render {

namespace {

void require(float value, const NumberRange& range, const std::string& what) {
  if (!range.contains(value))
    throw std::invalid_argument(fmt::format("{} is {}, expected {}", what, value, range.text()));
}

// Constant within the radius. Offsets lie in [-radius, radius).
class BoxFilter final : public Filter {
 public:
  explicit BoxFilter(float radius) : Filter(radius), m_radius(radius) {
    require(radius, kFilterRadius, "the radius of a box filter");
  }
  FilterSample sample(const Vec2& u) const override {
    return {{(2 * u.x - 1) * m_radius, (2 * u.y - 1) * m_radius}, 1.0f};
  }
  float value(const Vec2& offset) const override {
    const bool inside = std::abs(offset.x) <= m_radius && std::abs(offset.y) <= m_radius;
    return inside ? 1 / sqr(2 * m_radius) : 0.0f;
  }
  void taps(float offset, float* values) const override {
    const int pixels = reach();
    // Without one of its ends, so that a sample between two pixels counts in one.
    for (int i = -pixels; i <= pixels; ++i) {
      const float x = float(i) - offset;
      *values++ = x > -m_radius && x <= m_radius ? 1.0f : 0.0f;
    }
  }
  float radius() const override { return m_radius; }
  std::string name() const override { return "box"; }

 private:
  Side side(int pixels) const override {
    const double share = 0.5 * std::min(1.0, (pixels + 0.5) / m_radius);
    return {share, share};
  }

  float m_radius;
};

// Falls linearly to zero at the radius.
class TentFilter final : public Filter {
 public:
  explicit TentFilter(float radius) : Filter(radius), m_radius(radius) {
    require(radius, kFilterRadius, "the radius of a tent filter");
  }
  FilterSample sample(const Vec2& u) const override { return {{invert(u.x), invert(u.y)}, 1.0f}; }
  float value(const Vec2& offset) const override { return profile(offset.x) * profile(offset.y); }
  void taps(float offset, float* values) const override {
    const int pixels = reach();
    for (int i = -pixels; i <= pixels; ++i)
      *values++ = std::max(0.0f, m_radius - std::abs(float(i) - offset));
  }
  void sampleEach(size_t count, const Column& u, const Column& v, FilterSamples& samples) const override {
    sampleLanes(*this, count, u, v, samples);
  }
  float radius() const override { return m_radius; }
  std::string name() const override { return "tent"; }

 private:
  ODIS_WIDE static void sampleLanes(const TentFilter& filter, size_t count, const Column& u, const Column& v,
                                    FilterSamples& samples) {
    for (size_t i = 0, end = endOfLanes(count); i < end; ++i) {
      samples.x[i] = filter.invert(u[i]);
      samples.y[i] = filter.invert(v[i]);
      samples.weight[i] = 1;
    }
  }
  Side side(int pixels) const override {
    const double x = std::min(1.0, (pixels + 0.5) / m_radius), share = x - 0.5 * x * x;
    return {share, share};
  }
  float profile(float x) const { return std::max(0.0f, 1 - std::abs(x) / m_radius) / m_radius; }
  float invert(float u) const {
    // The halves are symmetric. A branch between them would be mispredicted half of the time.
    return m_radius * std::copysign(1 - std::sqrt(2 * std::min(u, 1 - u)), u - 0.5f);
  }

  float m_radius;
};

// Samples a symmetric, normalised profile on [-radius, radius] by the linear interpolation of its absolute
// value between kCells + 1 nodes a side. The weight is the exact profile over that density, so the table
// costs no bias, only weights that differ from their mean by less than a part in a thousand (but for the
// cells where the profile changes its sign).
template <class Profile>
class TabulatedFilter final : public Filter {
 public:
  TabulatedFilter(Profile profile, std::string name)
      : Filter(profile.radius), m_profile(profile), m_name(std::move(name)) {
    for (int i = 0; i <= kCells; ++i) m_density[i] = std::abs(m_profile(float(i) * cellWidth()));
    m_cdf[0] = 0;
    double sum = 0;
    for (int i = 0; i < kCells; ++i) {
      sum += 0.5 * (double(m_density[i]) + m_density[i + 1]) * cellWidth();
      m_cdf[i + 1] = float(sum);
    }
    for (float& node : m_density) node = float(node / sum);
    for (float& node : m_cdf) node = float(node / sum);
    m_cdf[kCells] = 1;
    double integral = 0;
    for (int i = 0; i < reach(); ++i) {
      integral += integrate(std::max(float(i) - 0.5f, 0.0f), float(i) + 0.5f);
      m_sides.push_back({0.5 * cdf(float(i) + 0.5f), integral});
    }
    if (reach() <= kMostSplatReach) tabulateTaps();
  }

  FilterSample sample(const Vec2& u) const override {
    const auto [x, weightX] = sample1D(u.x);
    const auto [y, weightY] = sample1D(u.y);
    return {{x, y}, weightX * weightY};
  }
  float value(const Vec2& offset) const override { return profileAt(offset.x) * profileAt(offset.y); }
  // Interpolated between 257 offsets, by which a value is off by less than a part in 100,000 of the largest.
  void taps(float offset, float* values) const override {
    assert(!m_taps.empty());
    const int count = 2 * reach() + 1;
    const float place = (offset + 0.5f) * kTapCells;
    const int cell = std::clamp(int(place), 0, kTapCells - 1);
    const float t = place - float(cell);
    const float* from = &m_taps[size_t(cell) * size_t(count)];
    for (int i = 0; i < count; ++i) values[i] = from[i] + (from[i + count] - from[i]) * t;
  }
  float radius() const override { return m_profile.radius; }
  std::string name() const override { return m_name; }

 private:
  static constexpr int kCells = 512;
  static constexpr int kTapCells = 256;

  void tabulateTaps() {
    for (int cell = 0; cell <= kTapCells; ++cell)
      for (int i = -reach(); i <= reach(); ++i)
        m_taps.push_back(profileAt(float(i) + 0.5f - float(cell) / kTapCells));
  }
  Side side(int pixels) const override {
    return size_t(pixels) < m_sides.size() ? m_sides[size_t(pixels)] : Side{0.5, 0.5};
  }
  // How probable it is that an offset is below x, 0 to the radius, without its sign.
  double cdf(float x) const {
    const int cell = std::min(int(x / cellWidth()), kCells - 1);
    const double a = m_density[cell], b = m_density[cell + 1], t = x / cellWidth() - float(cell);
    return m_cdf[cell] + cellWidth() * (a * t + (b - a) * t * t / 2);
  }
  // Midpoint rule.
  double integrate(float from, float to) const {
    constexpr int kSteps = 1000;
    const float step = (to - from) / kSteps;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) sum += m_profile(from + (float(i) + 0.5f) * step);
    return sum * step;
  }
  float cellWidth() const { return m_profile.radius / kCells; }
  float profileAt(float x) const { return std::abs(x) < m_profile.radius ? m_profile(std::abs(x)) : 0.0f; }

  // An offset of either sign and its weight.
  std::pair<float, float> sample1D(float u) const {
    const bool negative = u < 0.5f;
    const float v = std::min(negative ? 1 - 2 * u : 2 * u - 1, kOneMinusEpsilon);
    const int cell = int(std::upper_bound(m_cdf.begin(), m_cdf.end(), v) - m_cdf.begin()) - 1;
    // Inverts the integral of a + (b - a) t over [0, t], in the form that is stable for a = b.
    const float a = m_density[cell], b = m_density[cell + 1];
    const float area = (v - m_cdf[cell]) / cellWidth();
    const float root = std::sqrt(std::max(sqr(a) + 2 * (b - a) * area, 0.0f));
    const float t = a + root > 0 ? std::min(2 * area / (a + root), 1.0f) : 0.0f;
    const float x = (float(cell) + t) * cellWidth();
    const float density = 0.5f * (a + (b - a) * t);
    const float weight = density > 0 ? profileAt(x) / density : 0.0f;
    return {negative ? -x : x, weight};
  }

  Profile m_profile;
  std::string m_name;
  std::array<float, kCells + 1> m_density;  // of |x| over [0, radius]
  std::array<float, kCells + 1> m_cdf;
  std::vector<Side> m_sides;  // behind 0, 1, ... pixels, up to the radius
  std::vector<float> m_taps;  // [offset][pixel]: the profile, as taps() has it; empty: reaches too far
};

// exp(-x^2 / (2 stddev^2)) less its value at the radius of four standard deviations, so that it ends at zero.
struct GaussianProfile {
  explicit GaussianProfile(float stddev) : radius(4 * stddev), exponent(-0.5f / sqr(stddev)) {
    offset = std::exp(exponent * sqr(radius));
    const double integral =
        double(stddev) * std::sqrt(2 * M_PI) * std::erf(radius / (stddev * std::sqrt(2.0))) -
        2.0 * radius * offset;
    scale = float(1 / integral);
  }
  float operator()(float x) const { return std::max(0.0f, std::exp(exponent * sqr(x)) - offset) * scale; }

  float radius, exponent, offset, scale;
};

// The sinc function under the central lobe of one that is stretched to the radius (Lanczos; Duchon 1979,
// "Lanczos Filtering in One and Two Dimensions"). Takes x >= 0.
struct LanczosProfile {
  explicit LanczosProfile(int lobes) : radius(float(lobes)) {
    // Its integral is near one but has no closed form: midpoint rule.
    constexpr int kSteps = 1 << 14;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) sum += (*this)((float(i) + 0.5f) / kSteps * radius);
    scale = float(kSteps / (2 * sum * radius));
  }
  float operator()(float x) const { return sinc(x) * sinc(x / radius) * scale; }
  static float sinc(float x) { return x < 1e-4f ? 1.0f : std::sin(kPi * x) / (kPi * x); }

  float radius, scale = 1;
};

// The cubics of Mitchell and Netravali 1988, "Reconstruction Filters in Computer Graphics"; their integral is
// one for every b and c. Takes x >= 0.
struct MitchellProfile {
  float operator()(float x) const {
    const float x2 = sqr(x), x3 = x2 * x;
    if (x < 1) return ((12 - 9 * b - 6 * c) * x3 + (-18 + 12 * b + 6 * c) * x2 + (6 - 2 * b)) / 6;
    const float y = 2 - x;  // the outer cubic about its double root at the radius
    return ((b + 6 * c) * y - 6 * c) * sqr(y) / 6;
  }

  float b, c;
  float radius = 2;
};

}  // namespace

std::unique_ptr<Filter> makeBoxFilter(float radius) {
  return std::make_unique<BoxFilter>(radius);
}

std::unique_ptr<Filter> makeTentFilter(float radius) {
  return std::make_unique<TentFilter>(radius);
}

std::unique_ptr<Filter> makeGaussianFilter(float stddev) {
  require(stddev, kFilterRadius, "the standard deviation of a gaussian filter");
  return std::make_unique<TabulatedFilter<GaussianProfile>>(GaussianProfile(stddev), "gaussian");
}

std::unique_ptr<Filter> makeLanczosFilter(int lobes) {
  require(float(lobes), kFilterLobes, "the number of lobes of a lanczos filter");
  return std::make_unique<TabulatedFilter<LanczosProfile>>(LanczosProfile(lobes), "lanczos");
}

std::unique_ptr<Filter> makeMitchellFilter(float b, float c) {
  require(b, kMitchellRange, "b of a mitchell filter");
  require(c, kMitchellRange, "c of a mitchell filter");
  const bool catmullRom = b == 0.0f && c == 0.5f;
  return std::make_unique<TabulatedFilter<MitchellProfile>>(MitchellProfile{b, c},
                                                            catmullRom ? "catmullrom" : "mitchell");
}

}  // namespace odis::render
