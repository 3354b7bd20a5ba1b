// The names of shapes in scene files.
#include <fmt/format.h>

#include "render/scene/factory_table.h"
#include "render/shape/factories.h"
#include "render/shape/mesh_files.h"

namespace odis::render {

namespace {

using ShapeFactory = ShapePtr (*)(const Properties&, Builder&);
constexpr std::pair<const char*, ShapeFactory> kFactories[] = {
    {"bsplinecurve", makeBsplineCurve},
    {"cube", makeCube},
    {"cylinder", makeCylinder},
    {"disk", makeDisk},
    {"linearcurve", makeLinearCurve},
    {"obj", makeObj},
    {"ply", makePly},
    {"rectangle", makeRectangle},
    {"sdfgrid", makeSdfGrid},
    {"serialized", makeSerialized},
    {"sphere", makeSphere},
};

}  // namespace

Imath::M44d readToWorld(const Properties& node) {
  const Imath::M44d matrix = node.preciseTransform("to_world");
  const Imath::V3d x(matrix[0][0], matrix[0][1], matrix[0][2]), y(matrix[1][0], matrix[1][1], matrix[1][2]),
      z(matrix[2][0], matrix[2][1], matrix[2][2]);
  // The volume of the transformed axes against that of a box with edges as long: zero if they lie in a plane.
  const double volume = std::abs(x.cross(y).dot(z)), box = std::sqrt(x.dot(x) * y.dot(y) * z.dot(z));
  const Vec3 origin(Matrix4(matrix).translation());
  if (!(volume > 1e-9 * box) || !std::isfinite(box) || !isFinite(origin)) {
    throw SceneError(
        node.placeOf("to_world"),
        "to_world cannot be inverted; expected a finite transform that keeps all three dimensions");
  }
  return matrix;
}

MeshReader meshReader(const Properties& shape) {
  if (shape.type == "obj") return readObj;
  if (shape.type == "ply") return readPly;
  if (shape.type != "serialized") return {};
  const int64_t index = shape.integer("shape_index", between(0, INT32_MAX), 0);
  return [index](const std::string& path, const SourceLocation& at, Warnings&) {
    return readSerialized(path, index, at);
  };
}

ShapePtr makeMeshOfFile(const Properties& node, Builder& builder, bool flipTexCoords) {
  const SourceLocation& at = node.placeOf("filename");
  const std::string path = builder.resolvePath(node.string("filename"), at);
  MeshOptions options;
  options.toWorld = Matrix4(readToWorld(node));
  options.faceNormals = node.boolean("face_normals", false);
  options.flipNormals = node.boolean("flip_normals", false);
  const bool flip = node.boolean("flip_tex_coords", flipTexCoords);
  if (const auto degrees = node.optionalNumber("max_smooth_angle", between(0, 180)))
    options.maxSmoothAngle = *degrees * (kPi / 180);

  MeshData data = builder.mesh(node, path, at);
  options.faceNormals |= data.faceNormals;
  if (flip)
    for (Vec2& uv : data.uvs) uv.y = 1 - uv.y;
  return Mesh::make(std::move(data), options, {path, 0, 0}, builder.warnings());
}

ShapePtr makeShape(const Properties& node, Builder& builder) {
  if (const ShapeFactory factory = findFactory(kFactories, node.type)) return factory(node, builder);
  throw SceneError(node.location, fmt::format("unknown shape \"{}\", expected one of: {}", node.type,
                                              fmt::join(shapeTypes(), ", ")));
}

std::vector<std::string> shapeTypes() {
  return typesIn(kFactories);
}

}  // namespace odis::render
