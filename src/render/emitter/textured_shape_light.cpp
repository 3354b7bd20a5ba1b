#include "render/emitter/textured_shape_light.h"

#include "render/shape/surface_math.h"

namespace odis::render {

namespace {

constexpr uint32_t kResolution = 64;
// Points of a cell along each axis for averaging the texture over it.
constexpr uint32_t kAveraged = 4;

}  // namespace

TexturedShapeLight::TexturedShapeLight(const Shape& shape, TexturePtr radiance)
    : AreaLight(shape, std::move(radiance)), m_table(weights(), kResolution, kResolution) {}

std::vector<float> TexturedShapeLight::weights() const {
  std::vector<float> weights(kResolution * kResolution, 0.0f);
  constexpr uint32_t points = kResolution * kAveraged;
  for (uint32_t y = 0; y < points; ++y)
    for (uint32_t x = 0; x < points; ++x) {
      const Vec2 uv = Vec2(float(x) + 0.5f, float(y) + 0.5f) / float(points);
      const float weight = average(texture().rgb(uv)) * shape().areaElement(uv);
      if (std::isfinite(weight) && weight > 0) weights[y / kAveraged * kResolution + x / kAveraged] += weight;
    }
  return weights;
}

EmitterSample TexturedShapeLight::sample(uint32_t, const Vec3& ref, const Vec2& u) const {
  ShapeSample point;
  if (u.x < 0.5f) {
    point = shape().sample(ref, {2 * u.x, u.y});
    point.at.uv = shape().uvOf(point.at);
  } else {
    point.at = shape().pointAtUv(m_table.sample({2 * u.x - 1, u.y}).x);
    const Vec3 d = point.at.p - ref;
    point.distance = length(d);
    if (!(point.distance > 0)) return {};
    point.wi = d / point.distance;
  }
  point.pdf = pdf(ref, point.at);
  return emitterSample(point);
}

float TexturedShapeLight::pdf(const Vec3& ref, const SurfacePoint& at) const {
  // uniformAreaPdf turns a density of one over `area` into one with respect to solid angle.
  const float pdfUv = m_table.pdf({std::min(at.uv.x, kOneMinusEpsilon), std::min(at.uv.y, kOneMinusEpsilon)});
  const float byTable = pdfUv > 0 ? uniformAreaPdf(ref, at, shape().areaElement(at.uv) / pdfUv) : 0.0f;
  return (shape().pdf(ref, at) + byTable) / 2;
}

}  // namespace odis::render
