// projector: a pinhole that throws an image.
//
//   irradiance             texture, rgb or number   the image, as the irradiance / pi that it gives a plane
//                                                   at distance 1, W/m^2; its upper left corner goes to where
//                                                   a camera in its place would see it. Default 1
//   scale                  number                   multiplies it; default 1
//   to_world               transform                places the light, which shines along +z; default identity
//   fov, fov_axis, focal_length                     see sensor/field_of_view.h; the aspect is that of the
//                                                   image's pixels, 1 for textures without
//
// The factor pi is Mitsuba's, too (3.9). Chosen among other lights by its mean.
#include "render/emitter/projector.h"

#include "render/emitter/factories.h"
#include "render/sensor/field_of_view.h"

namespace odis::render {

Projector::Projector(const Matrix4& toWorld, TexturePtr image, const Projection& projection)
    : m_position(transformPoint(toWorld, Vec3(0, 0, 0))),
      m_axis(normalize(transformVector(toWorld, Vec3(0, 0, 1)))),
      m_toLocal(toWorld.inverse()),
      m_image(std::move(image)),
      m_projection(projection) {}

LightBounds Projector::bounds(uint32_t) const {
  // To the farthest corner, and a little more than rounding.
  const Vec3 corner(m_projection.halfWidth, m_projection.halfHeight, 1);
  const float theta = std::acos(1 / length(corner)) + 1e-3f;
  return {.min = m_position,
          .max = m_position,
          .axis = m_axis,
          .thetaO = theta,
          .thetaE = 0,
          .phi = kPi * m_projection.scale * average(m_image->mean()) / axialIntensity(theta)};
}

EmitterSample Projector::sample(uint32_t, const Vec3& ref, const Vec2&) const {
  const Vec3 local = transformPoint(m_toLocal, ref), toLight = m_position - ref;
  const float distance = length(toLight);
  if (!(local.z > 0) || !(distance > 0)) return {};
  const Vec2 uv(0.5f - 0.5f * local.x / (local.z * m_projection.halfWidth),
                0.5f - 0.5f * local.y / (local.z * m_projection.halfHeight));
  if (!(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1)) return {};
  const Vec3 wi = toLight / distance;
  const float cosine = -dot(wi, m_axis);
  return {.wi = wi,
          .distance = distance,
          .radiance = m_image->rgb(uv) * (kPi * m_projection.scale / (sqr(local.z) * cosine)),
          .pdf = 1,
          .delta = true};
}

std::vector<EmitterPtr> makeProjector(const Properties& node, Builder& builder) {
  const Matrix4 toWorld = node.transform("to_world");
  const TexturePtr image =
      builder.texture(node, "irradiance", {"colour or texture", kEmissionRange}, {1, 1, 1});
  const Rgb mean = image->mean();
  if (!isFinite(mean) || mean.x < 0 || mean.y < 0 || mean.z < 0)
    throw SceneError(node.placeOf("irradiance"), "the irradiance of a projector is not finite and positive");
  const Vec2i size = image->resolution();
  const float halfWidth = float(std::tan(horizontalFieldOfView(node, size) / 2));
  const Projector::Projection projection{halfWidth, halfWidth * float(size.y) / float(size.x),
                                         emissionScale(node, "scale", 1.0f)};
  return {std::make_shared<Projector>(toWorld, image, projection)};
}

}  // namespace odis::render
