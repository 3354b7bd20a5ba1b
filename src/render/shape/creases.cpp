#include "render/shape/creases.h"

#include <algorithm>
#include <numeric>

#include "render/shape/surface_math.h"

namespace odis::render {

namespace {

// Each is compared with all others.
constexpr size_t kMostTriangles = 256;

struct Corner {
  uint32_t triangle, vertex;  // the vertex is 0, 1 or 2
};

std::vector<Imath::V3d> faceNormals(const MeshData& data) {
  std::vector<Imath::V3d> normals;
  normals.reserve(data.triangles.size());
  for (const Triangle& t : data.triangles) {
    const Imath::V3d a(data.positions[t[0]]), b(data.positions[t[1]]), c(data.positions[t[2]]);
    normals.push_back((b - a).cross(c - a).normalized());  // zero if there is no area
  }
  return normals;
}

// The corners in an order in which those of one position follow each other.
std::vector<Corner> byPosition(const MeshData& data) {
  std::vector<Corner> corners;
  corners.reserve(3 * data.triangles.size());
  for (uint32_t t = 0; t < data.triangles.size(); ++t)
    for (uint32_t i = 0; i < 3; ++i) corners.push_back({t, i});
  const auto place = [&](const Corner& c) {
    const Vec3& p = data.positions[data.triangles[c.triangle][c.vertex]];
    return std::tuple(p.x, p.y, p.z, c.triangle, c.vertex);
  };
  std::sort(corners.begin(), corners.end(),
            [&](const Corner& a, const Corner& b) { return place(a) < place(b); });
  return corners;
}

double angleAt(const MeshData& data, const Corner& corner) {
  const Triangle& t = data.triangles[corner.triangle];
  const Vec3& p = data.positions[t[corner.vertex]];
  const Vec3 a = data.positions[t[(corner.vertex + 1) % 3]] - p,
             b = data.positions[t[(corner.vertex + 2) % 3]] - p;
  return std::atan2(length(cross(a, b)), dot(a, b));
}

// The vertices of the corners, one after another, without normals.
MeshData unshared(const MeshData& data) {
  MeshData result;
  for (const MeshAttribute& attribute : data.attributes)
    result.attributes.push_back(attribute.ofFaces() ? attribute
                                                    : MeshAttribute{attribute.name, attribute.channels, {}});
  for (uint32_t t = 0; t < data.triangles.size(); ++t) {
    for (const uint32_t vertex : data.triangles[t]) {
      result.positions.push_back(data.positions[vertex]);
      if (!data.uvs.empty()) result.uvs.push_back(data.uvs[vertex]);
      for (size_t i = 0; i < data.attributes.size(); ++i) {
        const MeshAttribute& from = data.attributes[i];
        if (from.ofFaces()) continue;
        const auto first = from.values.begin() + ptrdiff_t(vertex) * from.channels;
        result.attributes[i].values.insert(result.attributes[i].values.end(), first, first + from.channels);
      }
    }
    result.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return result;
}

}  // namespace

MeshData withCreases(const MeshData& data, float maxAngle) {
  MeshData result = unshared(data);
  result.normals.resize(result.positions.size());
  const std::vector<Imath::V3d> normals = faceNormals(data);
  const std::vector<Corner> corners = byPosition(data);
  const double least = std::cos(double(maxAngle)) - 1e-6;
  const auto position = [&](const Corner& c) { return data.positions[data.triangles[c.triangle][c.vertex]]; };
  for (auto first = corners.begin(); first != corners.end();) {
    const auto end =
        std::find_if(first, corners.end(), [&](const Corner& c) { return position(c) != position(*first); });
    const bool compared = size_t(end - first) <= kMostTriangles;
    for (auto own = first; own != end; ++own) {
      const Imath::V3d& normal = normals[own->triangle];
      Imath::V3d sum = compared ? Imath::V3d(0) : normal;
      for (auto other = first; compared && other != end; ++other)
        if (other->triangle == own->triangle || normals[other->triangle].dot(normal) >= least)
          sum += normals[other->triangle] * angleAt(data, *other);
      result.normals[3 * own->triangle + own->vertex] = normalizeOr(sum, Vec3(0, 0, 0));
    }
    first = end;
  }
  return result;
}

}  // namespace odis::render
