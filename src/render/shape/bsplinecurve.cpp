// bsplinecurve: tubes along uniform cubic B-splines, without caps at their ends.
//
//   filename   string      of the control points: a text of a line x, y, z, radius each; blank lines part
//                          curves, which have at least four
//   to_world   transform   of the control points; radii stay as they are
//
// u runs about the curve, v along all pieces of the file (0 to 1). Curves don't emit.
#include "render/shape/curves.h"
#include "render/shape/factories.h"

namespace odis::render {

ShapePtr makeBsplineCurve(const Properties& node, Builder& builder) {
  const SourceLocation& location = node.placeOf("filename");
  const std::string path = builder.resolvePath(node.string("filename"), location);
  return std::make_shared<Curves>(readCurves(path, location, Matrix4(readToWorld(node)), 4),
                                  CurveBasis::bspline);
}

}  // namespace odis::render
