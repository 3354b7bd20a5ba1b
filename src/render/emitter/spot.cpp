// spot: a point light that shines into a cone about +z, with a linear falloff in angle towards its rim.
//
//   to_world       transform       places the light, which shines along +z, in the world; default identity
//   intensity      rgb or number   along the axis, W/sr; default 1
//   cutoff_angle   number          degrees from the axis beyond which there is no light; default 20
//   beam_width     number          degrees from the axis within which the light is full; default 3/4 of
//                                  cutoff_angle
#include "render/emitter/spot.h"

#include "render/emitter/factories.h"

namespace odis::render {

SpotLight::SpotLight(const Vec3& position, const Vec3& axis, const Rgb& intensity, float cutoff,
                     float beamWidth)
    : m_position(position),
      m_axis(axis),
      m_intensity(intensity),
      m_cutoff(cutoff),
      m_beamWidth(beamWidth),
      m_cosCutoff(std::cos(cutoff)),
      m_cosBeam(std::cos(beamWidth)),
      m_inverseTransition(cutoff > beamWidth ? 1 / (cutoff - beamWidth) : 0) {}

// Full within the beam, and nothing beyond the rim; importance fades with the cosine from one to the other,
// so the two are kept within a right angle.
LightBounds SpotLight::bounds(uint32_t) const {
  const float full = std::max(m_beamWidth, m_cutoff - kPi / 2);
  return {.min = m_position,
          .max = m_position,
          .axis = m_axis,
          .thetaO = full,
          .thetaE = m_cutoff - full,
          .phi = average(m_intensity) / axialIntensity(full)};
}

EmitterSample SpotLight::sample(uint32_t, const Vec3& ref, const Vec2&) const {
  const Vec3 toLight = m_position - ref;
  const float distance = length(toLight);
  if (!(distance > 0)) return {};
  const Vec3 wi = toLight / distance;
  const float cosTheta = -dot(wi, m_axis);
  if (!(cosTheta > m_cosCutoff)) return {};
  const float falloff = cosTheta >= m_cosBeam ? 1.0f : (m_cutoff - std::acos(cosTheta)) * m_inverseTransition;
  return {.wi = wi,
          .distance = distance,
          .radiance = m_intensity * (falloff / sqr(distance)),
          .pdf = 1,
          .delta = true};
}

std::vector<EmitterPtr> makeSpot(const Properties& node, Builder& builder) {
  const Matrix4 toWorld = node.transform("to_world");
  const float cutoff = node.number("cutoff_angle", between(0.001, 180), 20.0f);
  float beamWidth = node.number("beam_width", between(0, 180), cutoff * 0.75f);
  if (beamWidth > cutoff) {
    builder.warn(node.placeOf("beam_width"),
                 "the beam_width of a spot light is more than its cutoff_angle; it is clamped");
    beamWidth = cutoff;
  }
  const Vec3 position = transformPoint(toWorld, Vec3(0, 0, 0)),
             axis = transformVector(toWorld, Vec3(0, 0, 1));
  if (!isFinite(position) || !isFinite(axis) || !(length(axis) > 0))
    throw SceneError(node.location, "the to_world of a spot light is not a finite, invertible transform");
  constexpr float kDegree = kPi / 180;
  return {std::make_shared<SpotLight>(position, normalize(axis), emission(node, "intensity"),
                                      cutoff * kDegree, beamWidth * kDegree)};
}

}  // namespace odis::render
