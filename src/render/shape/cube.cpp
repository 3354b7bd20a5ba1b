// cube: the box [-1, 1]^3, its normals pointing outwards; the uv coordinates run over [0, 1]^2 on each face.
//
//   to_world      transform
//   flip_normals  boolean, false   turn the surface inside out
#include "render/shape/factories.h"
#include "render/shape/plain_meshes.h"

namespace odis::render {

MeshData cubeMesh() {
  // Each face by its normal and the direction in which u grows; v grows along their cross product.
  struct Face {
    Vec3 normal, u;
  };
  static const Face faces[] = {{{1, 0, 0}, {0, 1, 0}},  {{-1, 0, 0}, {0, 1, 0}}, {{0, 1, 0}, {-1, 0, 0}},
                               {{0, -1, 0}, {0, 0, 1}}, {{0, 0, 1}, {0, 1, 0}},  {{0, 0, -1}, {0, -1, 0}}};
  MeshData data;
  for (const Face& face : faces) {
    const Vec3 v = cross(face.u, face.normal);
    const auto first = uint32_t(data.positions.size());
    for (const Vec2& uv : {Vec2(0, 0), Vec2(0, 1), Vec2(1, 1), Vec2(1, 0)}) {
      data.positions.push_back(face.normal + face.u * (2 * uv.x - 1) + v * (2 * uv.y - 1));
      data.normals.push_back(face.normal);
      data.uvs.push_back(uv);
    }
    data.triangles.push_back({first, first + 1, first + 2});
    data.triangles.push_back({first, first + 2, first + 3});
  }
  return data;
}

ShapePtr makeCube(const Properties& node, Builder& builder) {
  MeshOptions options;
  options.toWorld = Matrix4(readToWorld(node));
  options.flipNormals = node.boolean("flip_normals", false);
  return Mesh::make(cubeMesh(), options, node.location, builder.warnings());
}

}  // namespace odis::render
