// homogeneous: a medium whose density is the same everywhere.
//
//   sigma_t          extinction coefficient, number or colour, 1 / length from 0; 1
//   albedo           of single scattering, number, colour or volume, 0 to 1; 0.75
//   scale            factor of sigma_t, from 0; 1
//   (nested phase)   phase function; isotropic
//   sample_emitters  whether light is sampled by next-event estimation from within; true
//
// In place of sigma_t and albedo there may be those of Mitsuba 0.6:
//
//   sigma_s, sigma_a  scattering and absorption coefficient, numbers or colours, 1 / length from 0; 0
//   material          name of a measured medium, see materials.cpp, for a scene in decimetres as in 0.6
//
// In a scene of that version what is not given is that of the material skin1, and `g` is the mean cosine by
// which the scattering is reduced.
#include "render/medium/channels.h"
#include "render/medium/factories.h"

namespace odis::render {
namespace {

// Distances along a segment in proportion to the angle that they span as seen from a place.
class EquiAngular {
 public:
  EquiAngular(const Vec3& from, const MediumSegment& segment) {
    m_foot = dot(from - segment.origin, segment.direction);
    m_nearest = std::max(length(from - segment.at(m_foot)), 1e-6f * std::abs(m_foot));
    m_begin = std::atan(-m_foot / m_nearest);
    m_end = segment.length < kInfinity ? std::atan((segment.length - m_foot) / m_nearest) : 0.5f * kPi;
  }
  // The distance of the place from the line.
  float nearest() const { return m_nearest; }
  float sample(float u) const {
    return std::max(m_foot + m_nearest * std::tan(lerp(u, m_begin, m_end)), 0.0f);
  }
  // Per unit of length.
  float pdf(float distance) const {
    return m_nearest / ((m_end - m_begin) * (sqr(m_nearest) + sqr(distance - m_foot)));
  }

 private:
  float m_foot, m_nearest;  // distances: of the nearest point of the line, of the place from it
  float m_begin, m_end;     // angles, in radians
};

// The share of the distances that are drawn by angle where the lamp is on the ray; less, the further it is
// off.
constexpr float kMostByAngle = 0.25f;

class Homogeneous final : public Medium {
 public:
  Homogeneous(const MediumSettings& settings, const Rgb& extinction)
      : Medium(settings.phase, settings.samplesEmitters),
        m_albedo(settings.albedo),
        m_extinction(extinction),
        m_isGrey(isGrey(extinction)),
        m_hasFlakes(settings.phase->greatestProjectedArea() != 1) {}

  Flight fly(const MediumSegment& segment, const Rgb& throughput, float u, RandomStream&) const override {
    const Rgb extinction = extinctionOn(segment);
    return m_isGrey ? flyThroughGrey(segment, extinction.x, u)
                    : flyThrough(segment, extinction, throughput, u);
  }

  float meanFreePath() const override {
    const float least = std::min({m_extinction.x, m_extinction.y, m_extinction.z});
    return least > 0 ? 1 / least : 0;
  }

  Flight flyPast(const Vec3& lamp, const MediumSegment& segment, const Rgb& throughput,
                 float u) const override {
    const Rgb extinction = extinctionOn(segment), shares = channelShares(throughput);
    const Rgb passing = transmittanceOf(extinction, segment.length);
    const float scatters = 1 - mixed(shares, passing);
    if (!(u < scatters)) return {false, 0, passing / (1 - scatters)};
    u = std::min(u / scatters, kOneMinusEpsilon);
    const EquiAngular angles(lamp, segment);
    const float byAngle = kMostByAngle * std::exp(-angles.nearest() / meanFreePath());
    float distance;
    if (u < byAngle) {
      distance = angles.sample(u / byAngle);
    } else {
      // By the extinction of a channel, among distances within the segment.
      const ChannelDraw draw(shares * (Rgb(1.0f) - passing), (u - byAngle) / (1 - byAngle) * scatters);
      distance = -std::log(1 - draw.u * (1 - draw.of(passing))) / draw.of(extinction);
    }
    const Rgb density = extinction * exponential(extinction * -distance);
    const float pdf = (1 - byAngle) * mixed(shares, density) + byAngle * scatters * angles.pdf(distance);
    Flight flight{true, distance, albedo(segment.at(distance)) * density / pdf};
    if (!isFinite(flight.weight)) flight.weight = Rgb(0.0f);
    return flight;
  }

  Rgb transmittance(const MediumSegment& segment, RandomStream&) const override {
    const Rgb extinction = extinctionOn(segment);
    return m_isGrey ? Rgb(transmittanceOf(extinction.x, segment.length))
                    : transmittanceOf(extinction, segment.length);
  }

  Rgb albedo(const Vec3& p) const override { return clampUnit(m_albedo->rgb(p)); }
  bool varies() const override { return !m_albedo->isConstant(); }
  uint64_t bytes() const override { return m_albedo->bytes(); }

 private:
  Flight flyThroughGrey(const MediumSegment& segment, float extinction, float u) const {
    const float distance = -std::log(1 - u) / extinction;
    if (!(distance < segment.length)) return {};
    return {true, distance, albedo(segment.at(distance))};
  }

  Flight flyThrough(const MediumSegment& segment, const Rgb& extinction, const Rgb& throughput,
                    float u) const {
    const Rgb shares = channelShares(throughput);
    // One number chooses the channel that draws the distance and, stretched again, draws it.
    const ChannelDraw draw(shares, u);
    const float distance = -std::log(1 - draw.u) / draw.of(extinction);
    Flight flight;
    if (distance < segment.length) {
      const Rgb density = extinction * exponential(extinction * -distance);
      flight = {true, distance, albedo(segment.at(distance)) * density / mixed(shares, density)};
    } else {
      const Rgb transmittance = transmittanceOf(extinction, segment.length);
      flight.weight = transmittance / mixed(shares, transmittance);
    }
    if (!isFinite(flight.weight)) flight.weight = Rgb(0.0f);
    return flight;
  }

  // Along a ray on which the phase function, whose flakes may lie alike everywhere, is what it is at its
  // start.
  Rgb extinctionOn(const MediumSegment& segment) const {
    if (!m_hasFlakes) return m_extinction;
    return m_extinction * phase().projectedArea({segment.origin, -segment.direction});
  }
  // A channel that nothing absorbs passes, however far it is.
  static float transmittanceOf(float extinction, float length) {
    return extinction > 0 ? std::exp(-extinction * length) : 1.0f;
  }
  static Rgb transmittanceOf(const Rgb& extinction, float length) {
    return {transmittanceOf(extinction.x, length), transmittanceOf(extinction.y, length),
            transmittanceOf(extinction.z, length)};
  }

  VolumePtr m_albedo;
  Rgb m_extinction;
  bool m_isGrey, m_hasFlakes;
};

}  // namespace

MediumPtr makeHomogeneous(const Properties& properties, Builder& builder) {
  const MediumSettings settings = readMedium(properties, builder);
  if (!settings.extinction->isConstant())
    throw SceneError(
        properties.placeOf("sigma_t"),
        "found a volume for 'sigma_t' of the medium 'homogeneous', expected a number or a colour "
        "(a medium 'heterogeneous' may vary)");
  return std::make_shared<Homogeneous>(settings, settings.extinction->greatest() * settings.scale);
}

}  // namespace odis::render
