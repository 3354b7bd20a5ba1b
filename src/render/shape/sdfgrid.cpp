// sdfgrid: the surface where a grid of signed distances, interpolated trilinearly, is zero; positive
// distances are outside. The grid fills the unit cube.
//
//   filename   string               of a volume of one channel (".vol")
//   normals    "smooth" (default): shading normals continuous from cell to cell; "analytic": those of the
//              surface
//   to_world   transform
//
// There are no texture coordinates, and the surface doesn't emit.
#include "render/shape/factories.h"
#include "render/shape/sdf_grid.h"

namespace odis::render {

ShapePtr makeSdfGrid(const Properties& node, Builder& builder) {
  const SourceLocation& location = node.placeOf("filename");
  const std::string path = builder.resolvePath(node.string("filename"), location);
  const bool smooth = node.word("normals", "analytic|smooth", "smooth") == "smooth";
  auto shape = std::make_shared<SdfGrid>(readVolume(path, location), Matrix4(readToWorld(node)), smooth);
  if (shape->primitiveCount() > 0) return shape;
  builder.warn(location, "the volume is positive or negative everywhere, there is nothing to draw");
  return nullptr;
}

}  // namespace odis::render
