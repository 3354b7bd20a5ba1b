// rectangle: the square [-1, 1]^2 in the plane z = 0, facing +z; its uv coordinates run over [0, 1]^2.
//
//   to_world      transform
//   flip_normals  boolean, false   turn the surface inside out
#include "render/shape/factories.h"
#include "render/shape/plain_meshes.h"

namespace odis::render {

MeshData rectangleMesh() {
  MeshData data;
  data.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  data.normals.assign(4, Vec3(0, 0, 1));
  data.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  data.triangles = {{0, 1, 2}, {0, 2, 3}};
  return data;
}

ShapePtr makeRectangle(const Properties& node, Builder& builder) {
  MeshOptions options;
  options.toWorld = Matrix4(readToWorld(node));
  options.flipNormals = node.boolean("flip_normals", false);
  return Mesh::make(rectangleMesh(), options, node.location, builder.warnings());
}

}  // namespace odis::render
