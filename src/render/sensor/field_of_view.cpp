#include "render/sensor/field_of_view.h"

#include "render/xml/element.h"
#include "render/xml/names.h"

namespace odis::render {
namespace {

constexpr NumberRange kFieldOfViewRange{0, 180, false, false};  // degrees
constexpr NumberRange kFocalLengthRange = between(0.1, 1e6);    // mm

// The angle along the diagonal of 35 mm film.
double fromFocalLength(const Properties& node) {
  const std::string fallback = "50mm";
  node.declare("focal_length", {.type = "string", .range = kFocalLengthRange, .fallback = fallback});
  std::string text = node.string("focal_length", fallback);
  const std::string found = text;
  const size_t unit = text.find_last_not_of("0123456789.eE+- \t");
  if (unit != std::string::npos && unit >= 1 && text.compare(unit - 1, 2, "mm") == 0) text.resize(unit - 1);
  const double millimetres = parseNumber(text, "'focal_length'", node.placeOf("focal_length"));
  if (!kFocalLengthRange.contains(millimetres))
    node.refuse("focal_length", "'" + found + "'", kFocalLengthRange.text() + " mm");
  return 2 * std::atan(std::sqrt(36.0 * 36.0 + 24.0 * 24.0) / (2 * millimetres));
}

}  // namespace

double horizontalFieldOfView(const Properties& node, const Vec2i& resolution) {
  const double aspect = double(resolution.x) / resolution.y;
  const std::optional<float> degrees = node.optionalNumber("fov", kFieldOfViewRange);
  node.describeFallback("fov", "by focal_length");
  std::string axis = node.word("fov_axis", "x|y|diagonal|smaller|larger", "x");
  double angle = 0;
  if (degrees) {
    if (node.has("focal_length"))
      throw SceneError(node.placeOf("focal_length"),
                       "found both 'fov' and 'focal_length', expected one of them");
    angle = *degrees * M_PI / 180;
  } else {
    angle = fromFocalLength(node);
    axis = "diagonal";  // whatever the file says
  }
  if (axis == "smaller") axis = aspect > 1 ? "y" : "x";
  if (axis == "larger") axis = aspect > 1 ? "x" : "y";
  if (axis == "x") return angle;
  const double tangent = std::tan(angle / 2);
  if (axis == "y") return 2 * std::atan(tangent * aspect);
  return 2 * std::atan(tangent / std::sqrt(1 + 1 / (aspect * aspect)));
}

}  // namespace odis::render
