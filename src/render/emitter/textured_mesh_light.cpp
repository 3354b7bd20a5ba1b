#include "render/emitter/textured_mesh_light.h"

#include "render/math/warp.h"
#include "render/shape/surface_math.h"

namespace odis::render {

namespace {

// About how many parts a mesh is cut into, if it has fewer triangles.
constexpr float kTexturedParts = 8192;
// Cuts of a cell for averaging the texture over it.
constexpr uint32_t kAveragedTexels = 4;
// The share of the texture's mean in what a part counts for, as its average may miss what is small and
// bright.
constexpr float kTexturedMeanFraction = 0.05f;

// The cells of a triangle that is cut n times along each edge: row i holds those with floor(n b1) = i, from
// b2 = 0 on, by turns upright and upside down.
uint32_t subdivisionRowStart(uint32_t n, uint32_t i) {
  return i * (2 * n - i);
}

// The barycentric coordinates of a point of the cell, from those within it.
Vec2 pointInSubdivision(uint32_t n, uint32_t cell, const Vec2& within) {
  const uint32_t i = n - uint32_t(std::ceil(std::sqrt(float(n * n - cell))));
  const uint32_t inRow = cell - subdivisionRowStart(n, i);
  const Vec2 corner(float(i), float(inRow / 2));
  const Vec2 p = inRow % 2 == 0 ? corner + within : corner + Vec2(1, 1) - within;
  return p / float(n);
}

uint32_t subdivisionAt(uint32_t n, const Vec2& barycentric) {
  const Vec2 scaled = barycentric * float(n);
  const auto i = uint32_t(limited(scaled.x, 0.0f, float(n - 1)));
  const auto j = uint32_t(limited(scaled.y, 0.0f, float(n - 1 - i)));
  const bool upsideDown = scaled.x - float(i) + scaled.y - float(j) > 1 && i + j + 1 < n;
  return subdivisionRowStart(n, i) + 2 * j + uint32_t(upsideDown);
}

}  // namespace

TexturedMeshLight::TexturedMeshLight(const Mesh& mesh, TexturePtr radiance)
    : AreaLight(mesh, std::move(radiance)), m_mesh(mesh), m_first{0} {
  for (uint32_t triangle = 0; triangle < mesh.primitiveCount(); ++triangle) {
    const float parts = kTexturedParts * mesh.triangleArea(triangle) / mesh.area();
    const auto n = uint32_t(std::sqrt(limited(parts, 1.0f, kTexturedParts)));
    m_first.push_back(m_first.back() + n * n);
  }
}

uint32_t TexturedMeshLight::divisions(uint32_t triangle) const {
  return uint32_t(std::lround(std::sqrt(float(m_first[triangle + 1] - m_first[triangle]))));
}

TexturedMeshLight::Cell TexturedMeshLight::cellOf(uint32_t part) const {
  const auto after = std::upper_bound(m_first.begin(), m_first.end(), part);
  const auto triangle = uint32_t(after - m_first.begin()) - 1;
  return {triangle, divisions(triangle), part - m_first[triangle]};
}

float TexturedMeshLight::meanRadiance(const Cell& cell) const {
  float sum = 0;
  for (uint32_t i = 0; i < kAveragedTexels * kAveragedTexels; ++i) {
    const Vec2 within = pointInSubdivision(kAveragedTexels, i, Vec2(1.0f / 3));
    sum += average(
        texture().rgbAt(m_mesh.pointOn(cell.triangle, pointInSubdivision(cell.n, cell.index, within))));
  }
  const float mean = sum / float(kAveragedTexels * kAveragedTexels);
  return std::isfinite(mean) ? std::max(mean, 0.0f) : average(texture().mean());
}

LightBounds TexturedMeshLight::bounds(uint32_t part) const {
  const Cell cell = cellOf(part);
  const PrimitiveExtent extent = m_mesh.extent(cell.triangle);
  LightBounds result{
      .min = Vec3(kInfinity), .max = Vec3(-kInfinity), .axis = extent.axis, .thetaO = extent.theta};
  for (const Vec2& corner : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)}) {
    const Vec3 p = m_mesh.pointOn(cell.triangle, pointInSubdivision(cell.n, cell.index, corner)).p;
    for (int axis = 0; axis < 3; ++axis) {
      result.min[axis] = std::min(result.min[axis], p[axis]);
      result.max[axis] = std::max(result.max[axis], p[axis]);
    }
  }
  result.phi = extent.area / float(cell.n * cell.n) *
               lerp(kTexturedMeanFraction, meanRadiance(cell), average(texture().mean()));
  return result;
}

EmitterSample TexturedMeshLight::sample(uint32_t part, const Vec3& ref, const Vec2& u) const {
  const Cell cell = cellOf(part);
  const auto draw = [&] {
    return m_mesh.placeOn(cell.triangle, pointInSubdivision(cell.n, cell.index, squareToTriangle(u)));
  };
  return emitterSample(
      uniformAreaSample(ref, draw, m_mesh.triangleArea(cell.triangle) / float(cell.n * cell.n)));
}

uint32_t TexturedMeshLight::part(const SurfacePoint& at) const {
  return m_first[at.primitive] + subdivisionAt(divisions(at.primitive), at.barycentric);
}

float TexturedMeshLight::pdf(const Vec3& ref, const SurfacePoint& at) const {
  return m_mesh.primitivePdf(ref, at) * float(m_first[at.primitive + 1] - m_first[at.primitive]);
}

}  // namespace odis::render
