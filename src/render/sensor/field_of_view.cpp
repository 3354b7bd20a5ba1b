#include "render/sensor/field_of_view.h"

#include "render/xml/element.h"
#include "render/xml/names.h"

namespace odis::render {
namespace {

// The angle along the diagonal of 35 mm film.
double fromFocalLength(std::string text, const SourceLocation& at) {
  const std::string found = text;
  const size_t unit = text.find_last_not_of("0123456789.eE+- \t");
  if (unit != std::string::npos && unit >= 1 && text.compare(unit - 1, 2, "mm") == 0) text.resize(unit - 1);
  const double millimetres = parseNumber(text, "'focal_length'", at);
  if (millimetres <= 0)
    throw SceneError(at, "found the focal length '" + found + "', expected more than 0 mm");
  return 2 * std::atan(std::sqrt(36.0 * 36.0 + 24.0 * 24.0) / (2 * millimetres));
}

}  // namespace

double horizontalFieldOfView(const Properties& node, const Vec2i& resolution) {
  const double aspect = double(resolution.x) / resolution.y;
  SourceLocation at = node.location;
  double angle = 0;
  std::string axis = "diagonal";
  if (node.has("fov")) {
    at = node.parameters.at("fov").location;
    const double degrees = node.number("fov");
    if (!(degrees > 0 && degrees < 180))
      throw SceneError(at, "found the field of view " + std::to_string(degrees) +
                               ", expected more than 0 and less than 180 degrees");
    if (node.has("focal_length"))
      throw SceneError(node.parameters.at("focal_length").location,
                       "found both 'fov' and 'focal_length', expected one of them");
    angle = degrees * M_PI / 180;
    axis = lowerCase(node.string("fov_axis", "x"));
  } else {
    if (node.has("focal_length")) at = node.parameters.at("focal_length").location;
    node.string("fov_axis", "x");  // has no meaning for focal lengths
    angle = fromFocalLength(node.string("focal_length", "50mm"), at);
  }
  if (axis == "smaller") axis = aspect > 1 ? "y" : "x";
  if (axis == "larger") axis = aspect > 1 ? "x" : "y";
  if (axis == "x") return angle;
  const double tangent = std::tan(angle / 2);
  if (axis == "y") return 2 * std::atan(tangent * aspect);
  if (axis == "diagonal") return 2 * std::atan(tangent / std::sqrt(1 + 1 / (aspect * aspect)));
  throw SceneError(node.parameters.at("fov_axis").location,
                   "found '" + axis + "' for 'fov_axis', expected x, y, diagonal, smaller or larger");
}

}  // namespace odis::render
