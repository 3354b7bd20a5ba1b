#include "render/shape/mesh.h"

#include <fmt/format.h>

#include "render/math/warp.h"
#include "render/shape/creases.h"
#include "render/shape/embree.h"
#include "render/shape/surface_math.h"

namespace odis::render {

namespace {

using Vec3d = Imath::V3d;

// Twice the area of the triangle along its normal. Differences of floats are exact enough in double precision
// for triangles that are tiny and far from the origin.
Vec3d areaVector(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3d base(a);
  return (Vec3d(b) - base).cross(Vec3d(c) - base);
}

// How far off its plane Embree may find a triangle that a ray starts near to: it rounds the differences of
// the corners and the ray's origin, and the cross product of two edges, which turns thin triangles more. Some
// times what was measured (docs/experiments/0056-large-grounds.md).
float intersectionError(const Vec3& a, const Vec3& b, const Vec3& c, double area) {
  const Vec3d e1 = Vec3d(b) - Vec3d(a), e2 = Vec3d(c) - Vec3d(a), e3 = e2 - e1;
  const double squared = std::max({e1.dot(e1), e2.dot(e2), e3.dot(e3)});
  const double edgeOverHeight = squared / (2 * area);
  return float(std::sqrt(squared) * (4 + std::min(500.0, 0.5 * edgeOverHeight)) * 0x1p-24);
}
// The share of it that is left where the triangle is met in double precision, with room to spare.
constexpr float kPreciseShare = 0x1p-25f;

// Triangles by the power of two that their size is.
constexpr int kLeastPower = -149, kGreatestPower = 150;
using SizeCounts = std::array<size_t, kGreatestPower - kLeastPower + 1>;

// The extent that so many triangles cover, if all are as large as the median of the smallest ones.
double extentOfSmallest(const SizeCounts& counts, size_t count) {
  size_t below = 0, power = 0;
  for (; 2 * (below + counts[power]) < count; ++power) below += counts[power];
  return std::ldexp(2.0, int(power) + kLeastPower) * std::sqrt(double(count));
}

// The unit normal of a triangle: in single precision unless it is a sliver, whose cross product would be
// lost.
Vec3 faceNormal(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 e1 = b - a, e2 = c - a, normal = cross(e1, e2);
  const float squared = lengthSquared(normal);
  if (squared > 1e-4f * lengthSquared(e1) * lengthSquared(e2) && squared > 1e-20f && squared < 1e20f)
    return normal * (1 / std::sqrt(squared));
  return normalizeOr(areaVector(a, b, c), {0, 0, 1});
}

void dropNonFinite(MeshData& data, const SourceLocation& at, Warnings& warnings) {
  const auto broken = [&](const Triangle& t) {
    return !isFinite(data.positions[t[0]]) || !isFinite(data.positions[t[1]]) ||
           !isFinite(data.positions[t[2]]);
  };
  for (MeshAttribute& attribute : data.attributes) {
    if (!attribute.ofFaces()) continue;
    size_t kept = 0;
    for (size_t i = 0; i < data.triangles.size(); ++i) {
      if (broken(data.triangles[i])) continue;
      for (uint32_t c = 0; c < attribute.channels; ++c)
        attribute.values[kept++] = attribute.values[i * attribute.channels + c];
    }
    attribute.values.resize(kept);
  }
  const size_t dropped = std::erase_if(data.triangles, broken);
  if (dropped > 0) warnings.add(at, fmt::format("dropped {} triangles with non-finite vertices", dropped));
  for (Vec2& uv : data.uvs)
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) uv = {0, 0};
  for (MeshAttribute& attribute : data.attributes) {
    const auto broken = std::count_if(attribute.values.begin(), attribute.values.end(),
                                      [](float value) { return !std::isfinite(value); });
    if (broken > 0)
      warnings.add(at, fmt::format("{} numbers of the attribute '{}' are not finite, they count as 0", broken,
                                   attribute.name));
    std::replace_if(
        attribute.values.begin(), attribute.values.end(), [](float value) { return !std::isfinite(value); },
        0.0f);
  }
}

void transform(MeshData& data, const Matrix4& toWorld) {
  if (toWorld == Matrix4()) return;
  const Imath::M44d matrix(toWorld);
  for (Vec3& p : data.positions) p = Vec3(Vec3d(p) * matrix);
  const Matrix4 inverse(matrix.inverse());
  for (Vec3& n : data.normals) n = transformNormal(inverse, n);
}

// Averages the normals of the adjacent triangles, weighted by their angle at the vertex (Thürmer and Wüthrich
// 1998, "Computing Vertex Normals from Polygonal Facets").
std::vector<Vec3> smoothNormals(const MeshData& data) {
  std::vector<Vec3> normals(data.positions.size(), Vec3(0, 0, 0));
  for (const Triangle& triangle : data.triangles) {
    const Vec3 p[3] = {data.positions[triangle[0]], data.positions[triangle[1]], data.positions[triangle[2]]};
    const Vec3 normal = normalizeOr(areaVector(p[0], p[1], p[2]), Vec3(0, 0, 0));
    for (int i = 0; i < 3; ++i) {
      const Vec3 a = p[(i + 1) % 3] - p[i], b = p[(i + 2) % 3] - p[i];
      const float angle = std::atan2(length(cross(a, b)), dot(a, b));
      normals[triangle[i]] += normal * angle;
    }
  }
  return normals;
}

}  // namespace

std::shared_ptr<Mesh> Mesh::make(MeshData data, const MeshOptions& options, const SourceLocation& at,
                                 Warnings& warnings) {
  const size_t count = data.positions.size();
  for (size_t i = 0; i < data.triangles.size(); ++i)
    for (const uint32_t vertex : data.triangles[i])
      if (vertex >= count)
        throw SceneError(
            at, fmt::format("triangle {} refers to vertex {}, expected less than {}", i, vertex, count));
  // Two lists of faces, of which one has attributes, make none.
  std::erase_if(data.attributes, [&](const MeshAttribute& attribute) {
    return attribute.values.size() !=
           (attribute.ofFaces() ? data.triangles.size() : count) * attribute.channels;
  });
  transform(data, options.toWorld);
  dropNonFinite(data, at, warnings);
  if (data.triangles.empty()) {
    warnings.add(at, "the mesh has no triangles and is left out");
    return nullptr;
  }
  if (options.maxSmoothAngle && !options.faceNormals) data = withCreases(data, *options.maxSmoothAngle);
  return std::shared_ptr<Mesh>(new Mesh(std::move(data), options));
}

Mesh::Mesh(MeshData data, const MeshOptions& options) {
  m_mesh = this;
  if (options.faceNormals)
    data.normals.clear();
  else if (data.normals.empty())
    data.normals = smoothNormals(data);
  // A normal that has no direction stays zero: the triangle's own takes its place.
  const float side = options.flipNormals ? -1.0f : 1.0f;
  for (Vec3& n : data.normals) n = normalizeOr(Vec3d(n), {0, 0, 0}) * side;

  m_hasNormals = !data.normals.empty();
  m_hasUvs = !data.uvs.empty();
  m_vertices.resize(data.positions.size());
  for (size_t i = 0; i < m_vertices.size(); ++i) {
    m_vertices[i].position = data.positions[i];
    if (m_hasNormals) m_vertices[i].normal = data.normals[i];
    if (m_hasUvs) m_vertices[i].uv = data.uvs[i];
  }
  m_attributes = std::move(data.attributes);

  double sum = 0;
  std::vector<double> sums;
  sums.reserve(data.triangles.size());
  m_faces.reserve(data.triangles.size());
  for (const Triangle& corners : data.triangles) {
    const Vec3 &a = data.positions[corners[0]], &b = data.positions[corners[1]],
               &c = data.positions[corners[2]];
    const Vec3d normal = areaVector(a, b, c);
    const double area = 0.5 * std::sqrt(normal.dot(normal));
    m_faces.push_back({corners, faceNormal(a, b, c) * side, float(area), intersectionError(a, b, c, area)});
    sums.push_back(sum += area);
  }
  m_area = float(sum);
  m_cdf.assign(m_faces.size() + 1, 0.0f);
  if (sum > 0)
    for (size_t i = 0; i < sums.size(); ++i) m_cdf[i + 1] = float(sums[i] / sum);
}

float Mesh::sideOf(const Face& face) const {
  const auto& [c0, c1, c2] = face.corners;
  const Vec3 &a = m_vertices[c0].position, &b = m_vertices[c1].position, &c = m_vertices[c2].position;
  return std::max({maxAbs(b - a), maxAbs(c - b), maxAbs(a - c)});
}

float Mesh::detail() const {
  PrimitiveExtent whole{Vec3(kInfinity), Vec3(-kInfinity)};
  for (const Vertex& vertex : m_vertices) whole.extendBy({vertex.position, vertex.position});
  SizeCounts counts{};
  for (const Face& face : m_faces)
    if (const float side = sideOf(face); side > 0)
      ++counts[size_t(std::clamp(std::ilogb(side), kLeastPower, kGreatestPower) - kLeastPower)];
  // Triangles that are so many powers of two smaller than all others are a thing that may stand on those: the
  // cube whose sides they cover. Fewer than a tetrahedron has are flaws of the mesh.
  constexpr size_t kGap = 8, kLeastOfThing = 4, kOfCube = 12;
  double least = whole.longestSide();
  size_t count = 0;
  for (size_t power = 0, before = 0; power < counts.size(); ++power) {
    if (counts[power] == 0) continue;
    if (count >= kLeastOfThing && power - before >= kGap)
      least = std::min(least, extentOfSmallest(counts, count) / std::sqrt(double(kOfCube)));
    count += counts[power];
    before = power;
  }
  return float(std::min(least, extentOfSmallest(counts, count)));
}

RTCGeometryTy* Mesh::makeLargeGeometry(RTCDeviceTy* device, float extent, bool whole) {
  m_large = {};
  m_isLarge.clear();
  const auto isLarger = [&](const Face& face) { return sideOf(face) > extent; };
  if (std::none_of(m_faces.begin(), m_faces.end(), isLarger)) return nullptr;
  m_isLarge.resize(m_faces.size());
  for (uint32_t i = 0; i < m_faces.size(); ++i) {
    m_isLarge[i] = whole || isLarger(m_faces[i]);
    if (m_isLarge[i]) m_large.add(i, corners(i));
  }
  return makeUserGeometry(device, m_large, m_large.count());
}

RTCGeometryTy* Mesh::makeGeometry(RTCDeviceTy* device) const {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, m_vertices.data(),
                             offsetof(Vertex, position), sizeof(Vertex), m_vertices.size());
  if (m_isLarge.empty()) {
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, m_faces.data(),
                               offsetof(Face, corners), sizeof(Face), m_faces.size());
  } else {
    // The others keep their numbers: in the place of a large one is one without area, which no ray meets.
    auto* triangles = static_cast<Triangle*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle), m_faces.size()));
    for (uint32_t i = 0; i < m_faces.size(); ++i) {
      triangles[i] = m_faces[i].corners;
      if (isLarge(i)) triangles[i].fill(m_faces[i].corners[0]);
    }
  }
  rtcCommitGeometry(geometry);
  return geometry;
}

SurfacePoint Mesh::surfacePoint(const Ray& ray, const RawHit& hit) const {
  SurfacePoint at = pointOn(hit.primitive, {hit.u, hit.v});
  if (isLarge(hit.primitive)) {
    // Barycentric coordinates are rounded, so the point is found again.
    const Ray inObject = toObject(ray, hit);
    const auto [a, b, c] = corners(hit.primitive);
    const Vec3d origin(inObject.origin), direction(inObject.direction), normal = areaVector(a, b, c);
    at.p = Vec3(origin + direction * ((Vec3d(a) - origin).dot(normal) / direction.dot(normal)));
  }
  toWorld(at, hit);
  return at;
}

SurfacePoint Mesh::placeOn(uint32_t triangle, const Vec2& barycentric) const {
  const Face& face = faceOf(triangle);
  const auto& [c0, c1, c2] = face.corners;
  const Vertex &v0 = m_vertices[c0], &v1 = m_vertices[c1], &v2 = m_vertices[c2];
  const float b1 = barycentric.x, b2 = barycentric.y, b0 = 1 - b1 - b2;

  SurfacePoint at;
  at.shape = this;
  at.primitive = triangle;
  at.barycentric = barycentric;
  at.p = pointOnTriangle(v0.position, v1.position, v2.position, barycentric);
  at.ng = face.normal;
  at.uv = m_hasUvs ? v0.uv * b0 + v1.uv * b1 + v2.uv * b2 : barycentric;
  at.shading.n = at.ng;
  if (m_hasNormals) {
    at.shading.n = normalizeOr(v0.normal * b0 + v1.normal * b1 + v2.normal * b2, at.ng);
    if (dot(at.shading.n, at.ng) < 0) at.ng = -at.ng;
  }
  return at;
}

SurfacePoint Mesh::pointOn(uint32_t triangle, const Vec2& barycentric) const {
  SurfacePoint at = placeOn(triangle, barycentric);
  const Face& face = faceOf(triangle);
  at.pError = isLarge(triangle) ? face.error * kPreciseShare : face.error;
  at.shading = CoordinateFrame(at.shading.n);
  if (tangents()) findTangents(at, face.corners);
  return at;
}

void Mesh::findTangents(SurfacePoint& at, const Triangle& corners) const {
  const auto& [c0, c1, c2] = corners;
  const Vertex &v0 = m_vertices[c0], &v1 = m_vertices[c1], &v2 = m_vertices[c2];
  const Vec3 e1 = v1.position - v0.position, e2 = v2.position - v0.position;
  at.dpdu = e1;
  at.dpdv = e2;
  if (m_hasUvs) {
    const Vec2 d1 = v1.uv - v0.uv, d2 = v2.uv - v0.uv;
    // In double precision the products are exact, so coordinates without area are found out.
    const auto inverse = float(1 / (double(d1.x) * d2.y - double(d1.y) * d2.x));
    if (std::isfinite(inverse)) {
      at.dpdu = (e1 * d2.y - e2 * d1.y) * inverse;
      at.dpdv = (e2 * d1.x - e1 * d2.x) * inverse;
    } else {
      const CoordinateFrame frame(at.ng);
      at.dpdu = frame.s;
      at.dpdv = frame.t;
    }
  }
  at.shading = CoordinateFrame::fromTangent(at.shading.n, at.dpdu);
}

uint32_t Mesh::drawTriangle(Vec2& u) const {
  // The first triangle whose end lies above u: those without area begin where they end, and are never found.
  // Ends of a few triangles are counted, as the branches of a search would be mispredicted.
  constexpr size_t kFew = 8;
  const std::span<const float> ends(m_cdf.begin() + 1, m_cdf.end() - 1);
  size_t triangle = 0;
  if (ends.size() < kFew)
    for (const float end : ends) triangle += size_t(end <= u.x);
  else
    triangle = size_t(std::upper_bound(ends.begin(), ends.end(), u.x) - ends.begin());
  assert(triangle < m_faces.size());
  const float begin = m_cdf[triangle];
  u.x = std::min((u.x - begin) / (m_cdf[triangle + 1] - begin), kOneMinusEpsilon);
  return uint32_t(triangle);
}

Mesh::Draw Mesh::drawOverArea(Vec2 u) const {
  const uint32_t triangle = drawTriangle(u);
  return {triangle, squareToTriangle(u)};
}

std::array<Vec3, 3> Mesh::corners(uint32_t triangle) const {
  const auto& [c0, c1, c2] = faceOf(triangle).corners;
  return {m_vertices[c0].position, m_vertices[c1].position, m_vertices[c2].position};
}

bool Mesh::isFlat() const {
  constexpr float kRounding = 1e-6f;  // radians
  const auto isFlat = [&](const Face& face) {
    const Vec3& first = m_vertices[face.corners[0]].normal;
    return m_vertices[face.corners[1]].normal == first && m_vertices[face.corners[2]].normal == first &&
           lengthSquared(cross(first, face.normal)) < sqr(kRounding);
  };
  return !m_hasNormals || std::all_of(m_faces.begin(), m_faces.end(), isFlat);
}

SurfacePoint Mesh::pointOverArea(const Vec2& u) const {
  if (!(m_area > 0)) return {};
  const auto [triangle, barycentric] = drawOverArea(u);
  return pointOn(triangle, barycentric);
}

ShapeSample Mesh::sample(const Vec3& ref, const Vec2& u) const {
  if (!(m_area > 0)) return {};
  const Draw draw = drawOverArea(u);
  return uniformAreaSample(
      ref, [&] { return placeOn(draw.triangle, draw.barycentric); }, m_area);
}

float Mesh::pdf(const Vec3& ref, const SurfacePoint& at) const {
  return uniformAreaPdf(ref, at, m_area);
}

PrimitiveExtent Mesh::extent(uint32_t triangle) const {
  PrimitiveExtent result;
  result.area = triangleArea(triangle);
  const Triangle& corners = faceOf(triangle).corners;
  result.min = result.max = m_vertices[corners[0]].position;
  for (const uint32_t vertex : corners)
    for (int i = 0; i < 3; ++i) {
      result.min[i] = std::min(result.min[i], m_vertices[vertex].position[i]);
      result.max[i] = std::max(result.max[i], m_vertices[vertex].position[i]);
    }
  // Between the corners the normals are combinations of theirs: a cone that holds these, and is narrower than
  // half of all directions, holds those.
  const Vec3 normals[3] = {placeOn(triangle, {0, 0}).shading.n, placeOn(triangle, {1, 0}).shading.n,
                           placeOn(triangle, {0, 1}).shading.n};
  result.axis = normalizeOr(Vec3d(normals[0]) + Vec3d(normals[1]) + Vec3d(normals[2]), normals[0]);
  result.theta = 0;
  for (const Vec3& n : normals)
    result.theta = std::max(result.theta, std::atan2(length(cross(result.axis, n)), dot(result.axis, n)));
  if (result.theta > kPi / 2) result.theta = kPi;
  return result;
}

ShapeSample Mesh::samplePrimitive(uint32_t triangle, const Vec3& ref, const Vec2& u) const {
  return uniformAreaSample(
      ref, [&] { return placeOn(triangle, squareToTriangle(u)); }, triangleArea(triangle));
}

float Mesh::primitivePdf(const Vec3& ref, const SurfacePoint& at) const {
  return uniformAreaPdf(ref, at, triangleArea(at.primitive));
}

const MeshAttribute* Mesh::findAttribute(const std::string& name) const {
  for (const MeshAttribute& attribute : m_attributes)
    if (attribute.name == name) return &attribute;
  return nullptr;
}

std::optional<Rgb> Mesh::attribute(const std::string& name, const SurfacePoint& at) const {
  const MeshAttribute* found = findAttribute(name);
  if (!found) return {};
  const auto valueOf = [&](uint32_t row) {
    const float* v = &found->values[size_t(row) * found->channels];
    return found->channels == 3 ? Rgb(v[0], v[1], v[2]) : Rgb(v[0]);
  };
  if (found->ofFaces()) return valueOf(at.primitive);
  const auto& [c0, c1, c2] = faceOf(at.primitive).corners;
  const Vec2& b = at.barycentric;
  return valueOf(c0) * (1 - b.x - b.y) + valueOf(c1) * b.x + valueOf(c2) * b.y;
}

std::optional<Vec2> Mesh::attributeRange(const std::string& name) const {
  const MeshAttribute* found = findAttribute(name);
  if (!found) return {};
  const auto [least, most] = std::minmax_element(found->values.begin(), found->values.end());
  return Vec2(*least, *most);
}

uint64_t Mesh::bytes() const {
  uint64_t attributes = 0;
  for (const MeshAttribute& attribute : m_attributes)
    attributes += attribute.values.capacity() * sizeof(float);
  return attributes + m_vertices.capacity() * sizeof(Vertex) + m_faces.capacity() * sizeof(Face) +
         m_cdf.capacity() * sizeof(float) + m_isLarge.capacity() / 8 + m_large.bytes();
}

}  // namespace odis::render
