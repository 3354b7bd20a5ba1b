// sdfgrid: the surface where a grid of signed distances, interpolated trilinearly, is zero; positive
// distances are outside. The grid fills the unit cube.
//
//   filename   string               of a volume of one channel (".vol")
//   normals    "smooth" (default): shading normals continuous from cell to cell; "analytic": those of the
//              surface
//   to_world   transform
//
// There are no texture coordinates, and the surface doesn't emit.
#include <fmt/format.h>

#include "render/medium/volume_file.h"
#include "render/shape/factories.h"
#include "render/shape/sdf_grid.h"

namespace odis::render {

DistanceGrid readDistanceGrid(const std::string& path, const SourceLocation& at) {
  const VolumeFile file = readVolumeFile(path, at);
  const SourceLocation here{path, 0, 0};
  if (file.channels != 1) throw SceneError(here, fmt::format("found {} channels, expected 1", file.channels));
  DistanceGrid grid;
  for (size_t axis = 0; axis < 3; ++axis) {
    if (file.size[axis] < 2)
      throw SceneError(here,
                       fmt::format("found a grid of {} x {} x {} values, expected at least 2 along each axis",
                                   file.size[0], file.size[1], file.size[2]));
    grid.size[axis] = uint32_t(file.size[axis]);
  }
  std::visit(
      [&](const auto& values) {
        grid.values.reserve(values.size());
        for (const auto value : values) grid.values.push_back(volumeNumber(value));
      },
      file.values);
  return grid;
}

ShapePtr makeSdfGrid(const Properties& node, Builder& builder) {
  const SourceLocation& location = node.placeOf("filename");
  const std::string path = builder.resolvePath(node.string("filename"), location);
  const bool smooth = node.word("normals", "analytic|smooth", "smooth") == "smooth";
  auto shape =
      std::make_shared<SdfGrid>(readDistanceGrid(path, location), Matrix4(readToWorld(node)), smooth);
  if (shape->primitiveCount() > 0) return shape;
  builder.warn(location, "the volume is positive or negative everywhere, there is nothing to draw");
  return nullptr;
}

}  // namespace odis::render
