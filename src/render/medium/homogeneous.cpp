// homogeneous: a medium whose density is the same everywhere.
//
//   sigma_t          extinction coefficient, number or colour, 1 / length from 0; 1
//   albedo           of single scattering, number, colour or volume, 0 to 1; 0.75
//   scale            factor of sigma_t, from 0; 1
//   (nested phase)   phase function; isotropic
//   sample_emitters  whether light is sampled by next-event estimation from within; true
//
// Scenes of Mitsuba 0.6 give two of sigma_s, sigma_a, sigma_t and albedo, or a `material` by its name.
#include "render/medium/channels.h"
#include "render/medium/factories.h"

namespace odis::render {
namespace {

class Homogeneous final : public Medium {
 public:
  Homogeneous(const MediumSettings& settings, const Rgb& extinction)
      : Medium(settings.phase, settings.samplesEmitters),
        m_albedo(settings.albedo),
        m_extinction(extinction) {}

  Flight fly(const MediumSegment& segment, const Rgb& throughput, float u, RandomStream&) const override {
    const Rgb extinction = extinctionOn(segment), shares = channelShares(throughput);
    // One number chooses the channel that draws the distance and, stretched again, draws it.
    float end = shares.x, begin = 0, drawing = extinction.x;
    if (u >= end) begin = end, end += shares.y, drawing = extinction.y;
    if (u >= end) begin = end, end = 1, drawing = extinction.z;
    const float within = std::min((u - begin) / (end - begin), kOneMinusEpsilon);
    const float distance =
        isGrey(extinction) ? -std::log1p(-u) / extinction.x : -std::log1p(-within) / drawing;
    Flight flight;
    if (distance < segment.length) {
      const Rgb density = extinction * exponential(extinction * -distance);
      flight.scattered = true;
      flight.distance = distance;
      flight.weight = albedo(segment.at(distance)) * density / mixed(shares, density);
    } else if (!isGrey(extinction)) {
      const Rgb transmittance = transmittanceOf(extinction, segment.length);
      flight.weight = transmittance / mixed(shares, transmittance);
    }
    if (!isFinite(flight.weight)) flight.weight = Rgb(0.0f);
    return flight;
  }

  Rgb transmittance(const MediumSegment& segment, RandomStream&) const override {
    return transmittanceOf(extinctionOn(segment), segment.length);
  }

  Rgb albedo(const Vec3& p) const override { return clampUnit(m_albedo->rgb(p)); }

 private:
  // Along a ray on which the phase function, whose flakes may lie alike everywhere, is what it is at its
  // start.
  Rgb extinctionOn(const MediumSegment& segment) const {
    return m_extinction * phase().projectedArea({segment.origin, -segment.direction});
  }
  // A channel that nothing absorbs passes, however far it is.
  static Rgb transmittanceOf(const Rgb& extinction, float length) {
    const auto of = [&](float x) { return x > 0 ? std::exp(-x * length) : 1.0f; };
    return {of(extinction.x), of(extinction.y), of(extinction.z)};
  }

  VolumePtr m_albedo;
  Rgb m_extinction;
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
