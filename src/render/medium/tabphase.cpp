// tabphase: a table over the cosine of the angle of deflection, interpolated linearly and normalized.
//
//   values   string   two numbers or more, not negative, at cosines evenly spaced from -1 (light goes back)
//                     to 1 (it goes on)
#include <span>

#include "render/math/distribution.h"
#include "render/medium/around_axis.h"
#include "render/medium/volume_factories.h"
#include "render/xml/element.h"

namespace odis::render {
namespace {

class Table final : public PhaseFunction {
 public:
  // At least two values, none negative and not all zero.
  explicit Table(std::span<const double> values) : m_cdf(values.size()) {
    const size_t intervals = values.size() - 1;
    const double width = 2.0 / double(intervals);
    double sum = 0, meanCosine = 0;
    std::vector<float> areas;
    for (size_t i = 0; i < intervals; ++i) {
      const double a = values[i], b = values[i + 1], cosA = -1 + width * double(i), cosB = cosA + width;
      areas.push_back(float(width * (a + b) / 2));
      sum += width * (a + b) / 2;
      // The integral of a product of two linear functions.
      meanCosine += width * ((cosA * a + cosB * b) / 3 + (cosA * b + cosB * a) / 6);
    }
    for (const double value : values) m_values.push_back(float(value / sum));
    buildCdf(areas, m_cdf);
    m_roughness = limited(float(1 - std::abs(meanCosine / sum)), 0.0f, 1.0f);
  }

  Sample sample(const MediumPoint& at, float, const Vec2& u) const override {
    const uint32_t interval = findCell(m_cdf, u.x);
    // Within the interval the density is linear: the root of a quadratic, in the form that loses no digits.
    const float a = m_values[interval], b = m_values[interval + 1];
    const float part = (u.x - m_cdf[interval]) / (m_cdf[interval + 1] - m_cdf[interval]);
    const float root = a + safeSqrt(lerp(part, a * a, b * b));
    const float t = root > 0 ? std::min(part * (a + b) / root, 1.0f) : 0.0f;
    const float cosTheta = 2 * (float(interval) + t) / float(m_values.size() - 1) - 1;
    return {aroundAxis(-at.wo, cosTheta, u.y), density(cosTheta)};
  }
  float pdf(const MediumPoint& at, const Vec3& wi) const override { return density(-dot(at.wo, wi)); }
  float roughness() const override { return m_roughness; }

 private:
  float density(float cosTheta) const {
    const float x = (limited(cosTheta, -1.0f, 1.0f) + 1) / 2 * float(m_values.size() - 1);
    const uint32_t interval = std::min(uint32_t(x), uint32_t(m_values.size()) - 2);
    return (kInvPi / 2) * lerp(x - float(interval), m_values[interval], m_values[interval + 1]);
  }

  std::vector<float> m_values;  // density with respect to the cosine
  std::vector<float> m_cdf;
  float m_roughness;
};

}  // namespace

PhaseFunctionPtr makeTabulated(const Properties& node, Builder&) {
  const std::string text = node.string("values");
  const std::vector<double> values = parseNumbers(text, "'values'", node.placeOf("values"));
  bool positive = false;
  for (const double value : values) {
    if (value < 0) node.refuse("values", fmt::format("{}", value), "no number below 0");
    positive |= value > 0;
  }
  if (values.size() < 2 || !positive)
    node.refuse("values", "'" + text + "'", "two numbers or more that are not all 0");
  return std::make_shared<Table>(values);
}

}  // namespace odis::render
