// Triangle meshes: what files and the shapes made of triangles become.
#pragma once

#include <array>
#include <cassert>
#include <optional>
#include <string>
#include <vector>

#include "render/shape/large_triangles.h"
#include "render/shape/shape.h"
#include "render/xml/error.h"

namespace odis::render {

using Triangle = std::array<uint32_t, 3>;

// Numbers that a file gives vertices or faces, looked up by the texture mesh_attribute.
struct MeshAttribute {
  std::string name;           // begins with vertex_ or face_
  uint32_t channels = 1;      // 1 or 3
  std::vector<float> values;  // channel by channel of each vertex or triangle

  bool ofFaces() const { return name.starts_with("face_"); }
};

// A mesh in object space. `normals` and `uvs` are empty or have one element a position.
struct MeshData {
  std::vector<Vec3> positions, normals;
  std::vector<Vec2> uvs;
  std::vector<Triangle> triangles;
  std::vector<MeshAttribute> attributes;
  bool faceNormals = false;  // whether the file asks to be shaded by them
};

struct MeshOptions {
  Matrix4 toWorld;
  bool faceNormals = false;  // shade with the normal of the triangle
  bool flipNormals = false;
  // Radians: smooth but for edges that bend more, whatever normals the data have; see creases.h.
  std::optional<float> maxSmoothAngle;
};

// Without normals in `data`, smooth ones are computed unless face normals are asked for. The side of the
// shading normal is the outside, even where the winding disagrees.
class Mesh final : public Shape {
 public:
  // Null, with a warning, if there is nothing to draw. Triangles with non-finite vertices are dropped with a
  // warning. Throws SceneError if a triangle names a vertex that does not exist.
  static std::shared_ptr<Mesh> make(MeshData data, const MeshOptions& options, const SourceLocation& at,
                                    Warnings& warnings);

  // Of the mesh as a whole or, for those of many parts, what triangles as large as half of it are cover; or
  // the same of its smallest triangles, if all others are far larger: of a thing on a ground in one mesh.
  float detail() const override;
  RTCGeometryTy* makeLargeGeometry(RTCDeviceTy* device, float extent, bool whole) override;
  RTCGeometryTy* makeGeometry(RTCDeviceTy* device) const override;
  SurfacePoint surfacePoint(const Ray& ray, const RawHit& hit) const override;
  float area() const override { return m_area; }
  ShapeSample sample(const Vec3& ref, const Vec2& u) const override;  // uniform by area
  float pdf(const Vec3& ref, const SurfacePoint& at) const override;
  uint64_t primitiveCount() const override { return m_faces.size(); }
  SurfacePoint pointOverArea(const Vec2& u) const override;
  float areaWeight(const Vec2&) const override { return 1; }
  PrimitiveExtent extent(uint32_t triangle) const override;
  ShapeSample samplePrimitive(uint32_t triangle, const Vec3& ref, const Vec2& u) const override;  // by area
  float primitivePdf(const Vec3& ref, const SurfacePoint& at) const override;
  std::optional<Rgb> attribute(const std::string& name, const SurfacePoint& at) const override;
  std::optional<Vec2> attributeRange(const std::string& name) const override;
  std::vector<Vec3> openings() const override;
  uint64_t bytes() const override;

  // Draws a triangle by area, of a mesh that has any; u.x is stretched to [0, 1) again.
  uint32_t drawTriangle(Vec2& u) const;
  std::array<Vec3, 3> corners(uint32_t triangle) const;
  // Whether a triangle is one of those in makeLargeGeometry().
  bool isLarge(uint32_t triangle) const { return !m_isLarge.empty() && m_isLarge[triangle]; }
  // Whether all over each triangle the shading normal is the geometric one, but for rounding.
  bool isFlat() const;
  float triangleArea(uint32_t triangle) const { return faceOf(triangle).area; }
  // The point with barycentric coordinates (b1, b2) on a triangle, in the space of the mesh. dpdu
  // and dpdv stay zero, and the shading frame is any about its normal, if the BSDF does not ask for more.
  SurfacePoint pointOn(uint32_t triangle, const Vec2& barycentric) const;
  // The same, as far as lights ask: no position error, no tangents, of the shading frame the normal alone.
  SurfacePoint placeOn(uint32_t triangle, const Vec2& barycentric) const;

 private:
  friend class MeshPoints;
  // All that is known of a vertex, in one piece: a hit touches three of these and one triangle.
  struct alignas(32) Vertex {
    Vec3 position, normal{0, 0, 0};
    Vec2 uv{0, 0};
  };
  // What is known of a triangle, likewise.
  struct alignas(32) Face {
    Triangle corners;
    Vec3 normal;  // unit
    float area;
    float error;  // how far off itself Embree may find it
  };
  // A point drawn by area.
  struct Draw {
    uint32_t triangle;
    Vec2 barycentric;
  };

  Mesh(MeshData data, const MeshOptions& options);
  const Face& faceOf(uint32_t triangle) const {
    assert(triangle < m_faces.size());
    return m_faces[triangle];
  }
  const MeshAttribute* findAttribute(const std::string& name) const;
  Draw drawOverArea(Vec2 u) const;  // as drawTriangle()
  // The longest side of a triangle's box.
  float sideOf(const Face& face) const;
  void findTangents(SurfacePoint& at, const Triangle& corners) const;

  std::vector<Vertex> m_vertices;
  std::vector<Face> m_faces;
  std::vector<MeshAttribute> m_attributes;
  std::vector<bool> m_isLarge;  // of each triangle; empty if none is
  LargeTriangles m_large;
  bool m_hasNormals = false;  // else face normals
  bool m_hasUvs = false;      // else barycentric coordinates stand in for them
  std::vector<float> m_cdf;   // of the triangles by area, size n + 1
  float m_area = 0;
};

}  // namespace odis::render
