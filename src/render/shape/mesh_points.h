// Where several rays met something: what Hit::surfacePoint() finds of each, on meshes side by side.
#pragma once

#include "render/math/vertex_columns.h"
#include "render/shape/mesh.h"

namespace odis::render {

class MeshPoints {
 public:
  // Whether the ray met a mesh that does not move.
  static bool knows(const Hit& hit) { return hit.shape->mesh() && !hit.motion; }
  bool full() const { return m_count == kLanes; }
  // `vertex` is to be filled in with the place that the ray met: by find() or, if it can't be found side by
  // side, at once.
  void add(const Hit& hit, const Ray& ray, Vertex& vertex);
  // Fills in the vertices, and lets go of them.
  void find();

 private:
  // What is computed, and of what.
  struct Columns : VertexColumns {
    Columns3 position[3], normal[3];  // of the corners
    Column u[3], v[3];
    Columns3 faceNormal;
    IntColumn hasUvs;
    Columns3 direction;      // of the ray
    IntColumn isDegenerate;  // whether interpolated normals need more precision
  };

  void gather();
  static void compute(size_t count, Columns& columns);

  size_t m_count = 0;
  const Mesh::Face* m_faces[kLanes];
  const Mesh::Vertex* m_corners[3][kLanes];
  const Hit* m_hits[kLanes];
  const Ray* m_rays[kLanes];
  Vertex* m_vertices[kLanes];
  Columns m_columns;
};

}  // namespace odis::render
