// area: a shape that emits light.
//
//   radiance   texture, rgb or number   what leaves every point in every direction, W/(m^2 sr); default 1
//
// Nested in a shape. It emits on the side that the shading normal points to; the other side is black. The
// triangles of a mesh are chosen one by one (see light_sampler.h). Points are drawn by the shape: by the cone
// that it fills where the shape knows it (spheres), else uniformly by area. A textured radiance is looked up
// at the point's uv and steers where points are drawn: the triangles of a mesh are cut into about 8192
// smaller ones (none if it has more), each chosen by its average; on other shapes half of the points come
// from a table of 64 x 64 over uv.
#include "render/emitter/area.h"

#include "render/emitter/factories.h"
#include "render/emitter/textured_mesh_light.h"
#include "render/emitter/textured_shape_light.h"
#include "render/scene/builder.h"
#include "render/shape/sphere.h"

namespace odis::render {

namespace {

// Two triangles, mostly a rectangle, are one part: little is gained by choosing between them.
constexpr uint64_t kWholePrimitives = 2;

}  // namespace

AreaLight::AreaLight(const Shape& shape, TexturePtr radiance)
    : m_shape(shape), m_radiance(std::move(radiance)), m_whole(shape.primitiveCount() <= kWholePrimitives) {
  if (!m_radiance->isConstant()) return;
  if (const auto* sphere = dynamic_cast<const Sphere*>(&shape); sphere && !sphere->flipsNormals())
    m_sphere = {sphere->center(), sphere->radius(), m_radiance->mean()};
  const auto* mesh = dynamic_cast<const Mesh*>(&shape);
  if (!mesh || !mesh->isFlat()) return;
  m_mesh = mesh;
  m_triangles.reserve(mesh->primitiveCount());
  for (uint32_t i = 0; i < mesh->primitiveCount(); ++i)
    m_triangles.push_back({mesh->corners(i), mesh->placeOn(i, {0, 0}).ng,
                           m_whole ? mesh->area() : mesh->triangleArea(i), m_radiance->mean()});
}

uint32_t AreaLight::partCount() const {
  return m_whole ? 1 : uint32_t(m_shape.primitiveCount());
}

LightBounds AreaLight::bounds(uint32_t part) const {
  LightBounds result;
  const uint32_t end = m_whole ? uint32_t(m_shape.primitiveCount()) : part + 1;
  for (uint32_t primitive = part; primitive < end; ++primitive) {
    const PrimitiveExtent extent = m_shape.extent(primitive);
    const LightBounds bounds{.min = extent.min,
                             .max = extent.max,
                             .axis = extent.axis,
                             .thetaO = extent.theta,
                             .phi = extent.area * average(m_radiance->mean())};
    result = primitive == part ? bounds : merged(result, bounds);
  }
  return result;
}

EmitterSample AreaLight::sample(uint32_t part, const Vec3& ref, const Vec2& u) const {
  return emitterSample(m_whole ? m_shape.sample(ref, u) : m_shape.samplePrimitive(part, ref, u));
}

const LightTriangle* AreaLight::drawTriangle(uint32_t part, Vec2& u) const {
  if (!m_mesh) return nullptr;
  return &m_triangles[m_whole ? m_mesh->drawTriangle(u) : part];
}

EmitterSample AreaLight::emitterSample(const ShapeSample& point) const {
  if (!(point.pdf > 0)) return {};
  return {.wi = point.wi,
          .distance = point.distance,
          .radiance = radiance(point.at, -point.wi),
          .pdf = point.pdf,
          .delta = false};
}

Rgb AreaLight::radiance(const SurfacePoint& at, const Vec3& wo) const {
  if (!(dot(at.shading.n, wo) > 0)) return {0, 0, 0};
  return m_radiance->rgbAt(at);
}

float AreaLight::pdf(const Vec3& ref, const SurfacePoint& at) const {
  return m_whole ? m_shape.pdf(ref, at) : m_shape.primitivePdf(ref, at);
}

std::shared_ptr<SurfaceEmitter> makeSurfaceEmitter(const Properties& node, const Shape& shape,
                                                   Builder& builder) {
  if (node.type != "area")
    throw SceneError(node.location,
                     "a shape cannot carry the emitter \"" + node.type + "\"; expected \"area\"");
  TexturePtr radiance = builder.texture(node, "radiance", {"colour or texture", kEmissionRange}, {1, 1, 1});
  const SourceLocation& at = node.placeOf("radiance");
  const Rgb mean = radiance->mean();
  if (!isFinite(mean)) throw SceneError(at, "the radiance of an area light is not a finite number");
  if (mean.x < 0 || mean.y < 0 || mean.z < 0)
    throw SceneError(at, "the radiance of an area light is negative; expected zero or more");
  if (!(shape.area() > 0) || !std::isfinite(shape.area())) {
    builder.warn(node.location, "an area light on a shape without area emits nothing and is left out");
    return nullptr;
  }
  if (radiance->isConstant()) return std::make_shared<AreaLight>(shape, std::move(radiance));
  if (const auto* mesh = dynamic_cast<const Mesh*>(&shape))
    return std::make_shared<TexturedMeshLight>(*mesh, std::move(radiance));
  return std::make_shared<TexturedShapeLight>(shape, std::move(radiance));
}

}  // namespace odis::render
