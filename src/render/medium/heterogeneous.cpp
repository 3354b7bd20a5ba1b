// heterogeneous: a medium whose density varies.
//
//   sigma_t          extinction coefficient, volume, number or colour, 1 / length from 0; 1
//   albedo           of single scattering, volume, number or colour, 0 to 1; 0.75
//   scale            factor of sigma_t, from 0; 1
//   (nested phase)   phase function; isotropic
//   sample_emitters  whether light is sampled by next-event estimation from within; true
//
// It ends at the borders of sigma_t's unit cube. Scenes of Mitsuba 0.6 call sigma_t `density`, and can't do
// without it and albedo. In place of both there may be sigma_s and sigma_a, or a material, as in
// homogeneous.cpp.
//
// Distances are drawn by delta tracking, shadow rays by ratio tracking (Novak et al. 2014, "Residual Ratio
// Tracking for Estimating Attenuation in Participating Media"), against the greatest density of each brick of
// a coarse grid (Yue et al. 2010, "Unbiased, Adaptive Stochastic Sampling for Rendering Inhomogeneous
// Participating Media").
#include <array>

#include "render/medium/channels.h"
#include "render/medium/factories.h"

namespace odis::render {
namespace {

// Shadow rays of which less than this is left are played for.
constexpr float kFullTransmittance = 0.1f, kLeastSurvival = 0.25f;

class Heterogeneous final : public Medium {
 public:
  explicit Heterogeneous(const MediumSettings& settings)
      : Medium(settings.phase, settings.samplesEmitters),
        m_extinction(settings.extinction),
        m_albedo(settings.albedo),
        m_scale(settings.scale),
        m_majorantScale(settings.scale * settings.phase->greatestProjectedArea()),
        m_maxima(m_extinction->maxima()) {
    if (const Matrix4* toCube = m_extinction->toUnitCube()) m_toCube = *toCube;
    for (size_t axis = 0; axis < 3; ++axis) m_size[axis] = float(m_maxima.size[axis]);
    m_isGrey = m_extinction->isGrey() || (m_extinction->isConstant() && isGrey(m_extinction->greatest()));
  }

  Flight fly(const MediumSegment& segment, const Rgb& throughput, float u,
             RandomStream& random) const override {
    Flight flight;
    Collisions collisions(*this, segment, u);
    float distance, majorant;
    while (collisions.next(random, distance, majorant)) {
      const Rgb extinction = extinctionAt(segment, distance), real = extinction * (1 / majorant);
      const float scatters = m_isGrey ? real.x : mixed(channelShares(throughput * flight.weight), real);
      if (random.get1D() < scatters) {
        flight.scattered = true;
        flight.distance = distance;
        if (!m_isGrey) flight.weight *= real / scatters;
        flight.weight *= albedo(segment.at(distance));
        return flight;
      }
      if (!m_isGrey) flight.weight *= (Rgb(1.0f) - real) / (1 - scatters);
    }
    return flight;
  }

  Rgb transmittance(const MediumSegment& segment, RandomStream& random) const override {
    Rgb result(1.0f);
    Collisions collisions(*this, segment, random.get1D());
    float distance, majorant;
    while (collisions.next(random, distance, majorant)) {
      result *= Rgb(1.0f) - extinctionAt(segment, distance) * (1 / majorant);
      const float left = maxComponent(result);
      if (left >= kFullTransmittance) continue;
      const float survival = std::max(left / kFullTransmittance, kLeastSurvival);
      if (!(left > 0) || random.get1D() >= survival) return Rgb(0.0f);
      result = result / survival;
    }
    return result;
  }

  Rgb albedo(const Vec3& p) const override { return clampUnit(m_albedo->rgb(p)); }
  bool varies() const override { return !m_extinction->isConstant() || !m_albedo->isConstant(); }
  uint64_t bytes() const override {
    return m_extinction->bytes() + m_albedo->bytes() + m_maxima.values.size() * sizeof(float);
  }

 private:
  // Places along a segment where it may be scattered, brick by brick.
  class Collisions {
   public:
    Collisions(const Heterogeneous& medium, const MediumSegment& segment, float u)
        : m_medium(medium), m_depth(-std::log(1 - u)) {
      Vec3 origin = transformPoint(medium.m_toCube, segment.origin),
           direction = transformVector(medium.m_toCube, segment.direction);
      m_at = 0;
      m_end = segment.length;
      for (int axis = 0; axis < 3; ++axis) {
        origin[axis] *= medium.m_size[size_t(axis)];
        direction[axis] *= medium.m_size[size_t(axis)];
        clip(origin[axis], direction[axis], medium.m_size[size_t(axis)]);
      }
      if (!(m_at < m_end)) return;
      for (int axis = 0; axis < 3; ++axis) enter(axis, origin[axis], direction[axis]);
      m_majorant = majorantHere();
    }

    // The next tentative collision: its distance and the majorant there. False once the segment or the medium
    // has ended.
    bool next(RandomStream& random, float& distance, float& majorant) {
      while (m_at < m_end) {
        const int axis = m_crossing[0] < m_crossing[1] ? (m_crossing[0] < m_crossing[2] ? 0 : 2)
                                                       : (m_crossing[1] < m_crossing[2] ? 1 : 2);
        const float border = std::min(m_crossing[size_t(axis)], m_end);
        const float inBrick = m_majorant * (border - m_at);
        if (m_depth < inBrick) {
          m_at += m_depth / m_majorant;
          distance = m_at;
          majorant = m_majorant;
          m_depth = -std::log(1 - random.get1D());
          return true;
        }
        m_depth -= inBrick;
        m_at = border;
        if (!step(size_t(axis))) return false;
      }
      return false;
    }

   private:
    void clip(float origin, float direction, float size) {
      if (direction == 0) {
        if (origin < 0 || origin > size) m_end = -1;
        return;
      }
      const float a = -origin / direction, b = (size - origin) / direction;
      m_at = std::max(m_at, std::min(a, b));
      m_end = std::min(m_end, std::max(a, b));
    }
    void enter(int number, float origin, float direction) {
      const auto axis = size_t(number);
      const float place = origin + direction * m_at, last = m_medium.m_size[axis] - 1;
      m_brick[axis] = int(limited(std::floor(place), 0.0f, last));
      m_turn[axis] = direction > 0 ? 1 : -1;
      m_step[axis] = direction != 0 ? std::abs(1 / direction) : kInfinity;
      const float border = float(m_brick[axis] + (direction > 0));
      m_crossing[axis] = direction != 0 ? std::max((border - origin) / direction, m_at) : kInfinity;
    }
    bool step(size_t axis) {
      m_brick[axis] += m_turn[axis];
      if (m_brick[axis] < 0 || m_brick[axis] >= int(m_medium.m_maxima.size[axis])) return false;
      m_crossing[axis] += m_step[axis];
      m_majorant = majorantHere();
      return true;
    }
    float majorantHere() const {
      const auto& size = m_medium.m_maxima.size;
      const size_t brick = (size_t(m_brick[2]) * size[1] + size_t(m_brick[1])) * size[0] + size_t(m_brick[0]);
      return m_medium.m_maxima.values[brick] * m_medium.m_majorantScale;
    }

    const Heterogeneous& m_medium;
    float m_depth;  // optical depth that is left until the next collision
    float m_at, m_end, m_majorant = 0;
    std::array<int, 3> m_brick{}, m_turn{};
    std::array<float, 3> m_crossing{}, m_step{};  // distances: of the next border, from border to border
  };

  Rgb extinctionAt(const MediumSegment& segment, float distance) const {
    const Vec3 p = segment.at(distance);
    const float area = m_scale * phase().projectedArea({p, -segment.direction});
    return m_isGrey ? Rgb(m_extinction->scalar(p) * area) : m_extinction->rgb(p) * area;
  }

  VolumePtr m_extinction, m_albedo;
  float m_scale, m_majorantScale;
  Matrix4 m_toCube;
  VolumeMaxima m_maxima;
  std::array<float, 3> m_size{};
  bool m_isGrey;
};

}  // namespace

MediumPtr makeHeterogeneous(const Properties& properties, Builder& builder) {
  return std::make_shared<Heterogeneous>(readMedium(properties, builder));
}

}  // namespace odis::render
