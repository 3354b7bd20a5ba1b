// Reads the text files of linearcurve and bsplinecurve.
#include <fmt/format.h>

#include <cmath>

#include "render/shape/curves.h"
#include "render/shape/file_bytes.h"
#include "render/shape/text_cursor.h"

namespace odis::render {

CurveData readCurves(const std::string& path, const SourceLocation& at, const Matrix4& toWorld,
                     size_t fewest) {
  const FileBytes bytes(path, at);
  TextCursor cursor(bytes.view());
  CurveData data;
  bool within = false;  // a curve
  const auto end = [&] {
    const size_t count = within ? data.points.size() - data.starts.back() : fewest;
    if (count < fewest)
      throw SceneError(
          {path, cursor.line(), 0},
          fmt::format("a curve of {} control points ends here, expected at least {}", count, fewest));
    within = false;
  };
  for (; !cursor.atEnd(); cursor.nextLine()) {
    if (cursor.atLineEnd()) {
      end();
      continue;
    }
    if (!within) data.starts.push_back(uint32_t(data.points.size()));
    within = true;
    const int line = cursor.line();
    float values[4];
    for (float& value : values) {
      cursor.skipBlanks();
      const std::string found = cursor.found();
      if (!cursor.number(value) || !std::isfinite(value))
        throw SceneError({path, line, 0}, "found " + found +
                                              ", expected x, y, z and the radius of a control "
                                              "point as finite numbers");
    }
    const Vec3 p = transformPoint(toWorld, Vec3(values[0], values[1], values[2]));
    if (!isFinite(p) || values[3] < 0)
      throw SceneError({path, line, 0},
                       fmt::format("found a control point at {}, {}, {} of radius {}, expected finite "
                                   "coordinates and a radius of at least 0",
                                   p.x, p.y, p.z, values[3]));
    if (data.points.size() == UINT32_MAX)
      throw SceneError({path, line, 0}, "found more control points than can be counted in 32 bits");
    data.points.push_back({p.x, p.y, p.z, values[3]});
  }
  end();
  if (data.points.empty()) throw SceneError({path, 0, 0}, "the file holds no control points");
  return data;
}

}  // namespace odis::render
