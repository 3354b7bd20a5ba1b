// spot: a point light that shines into a cone about +z, with a linear falloff in angle towards its rim.
//
//   to_world       transform       places the light, which shines along +z, in the world; default identity
//   intensity      rgb or number   along the axis, W/sr; default 1
//   cutoff_angle   number          degrees from the axis beyond which there is no light; default 20
//   beam_width     number          degrees from the axis within which the light is full; default 3/4 of
//                                  cutoff_angle
//   texture        texture, rgb or number   multiplies the intensity; the cone of cutoff_angle is
//                                  inscribed in its unit square, u along +x, v along +y; default: none
#include "render/emitter/spot.h"

#include "render/emitter/factories.h"
#include "render/xml/element.h"

namespace odis::render {

SpotLight::SpotLight(const Matrix4& toWorld, const Rgb& intensity, const Beam& beam)
    : m_position(transformPoint(toWorld, Vec3(0, 0, 0))),
      m_axis(normalize(transformVector(toWorld, Vec3(0, 0, 1)))),
      m_toLocal(toWorld.inverse()),
      m_intensity(intensity),
      m_beam(beam),
      m_cosCutoff(std::cos(beam.cutoff)),
      m_cosBeam(std::cos(beam.beamWidth)),
      m_inverseTransition(beam.cutoff > beam.beamWidth ? 1 / (beam.cutoff - beam.beamWidth) : 0) {}

// Full within the beam, and nothing beyond the rim; importance fades with the cosine from one to the other,
// so the two are kept within a right angle.
LightBounds SpotLight::bounds(uint32_t) const {
  const float full = std::max(m_beam.beamWidth, m_beam.cutoff - kPi / 2);
  const Rgb mean = m_beam.texture ? m_intensity * m_beam.texture->mean() : m_intensity;
  return {.min = m_position,
          .max = m_position,
          .axis = m_axis,
          .thetaO = full,
          .thetaE = m_beam.cutoff - full,
          .phi = average(mean) / axialIntensity(full)};
}

Rgb SpotLight::textureTowards(const Vec3& ref) const {
  const Vec3 local = transformPoint(m_toLocal, ref);
  const float scale = 0.5f / (local.z * std::tan(m_beam.cutoff));
  const Vec2 uv(0.5f + local.x * scale, 0.5f + local.y * scale);
  return std::isfinite(uv.x + uv.y) ? m_beam.texture->rgb(uv) : Rgb(0, 0, 0);
}

EmitterSample SpotLight::sample(uint32_t, const Vec3& ref, const Vec2&) const {
  const Vec3 toLight = m_position - ref;
  const float distance = length(toLight);
  if (!(distance > 0)) return {};
  const Vec3 wi = toLight / distance;
  const float cosTheta = -dot(wi, m_axis);
  if (!(cosTheta > m_cosCutoff)) return {};
  const float falloff =
      cosTheta >= m_cosBeam ? 1.0f : (m_beam.cutoff - std::acos(cosTheta)) * m_inverseTransition;
  Rgb intensity = m_intensity * falloff;
  if (m_beam.texture) intensity *= textureTowards(ref);
  return {.wi = wi, .distance = distance, .radiance = intensity / sqr(distance), .pdf = 1, .delta = true};
}

std::vector<EmitterPtr> makeSpot(const Properties& node, Builder& builder) {
  const Matrix4 toWorld = node.transform("to_world");
  const float cutoff = node.number("cutoff_angle", between(0.001, 180), 20.0f);
  float beamWidth = node.number("beam_width", between(0, 180), cutoff * 0.75f);
  node.describeFallback("beam_width", "3/4 of cutoff_angle");
  if (beamWidth > cutoff) {
    builder.warn(node.placeOf("beam_width"),
                 "the beam_width of a spot light is more than its cutoff_angle; it is clamped");
    beamWidth = cutoff;
  }
  const TexturePtr texture = builder.optionalTexture(
      node, "texture", {.type = "colour or texture", .range = kEmissionRange, .otherwise = "none"});
  if (texture && !isFinite(texture->mean()))
    throw SceneError(node.placeOf("texture"), "the texture of a spot light is not a finite number");
  if (!isInvertibleAffine(toWorld))
    throw SceneError(node.location, "the to_world of a spot light is not a finite, invertible transform");
  constexpr float kDegree = kPi / 180;
  return {std::make_shared<SpotLight>(toWorld, emission(node, "intensity"),
                                      SpotLight::Beam{cutoff * kDegree, beamWidth * kDegree, texture})};
}

}  // namespace odis::render
