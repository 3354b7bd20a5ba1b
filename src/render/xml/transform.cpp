#include "render/xml/element.h"
#include "render/xml/names.h"

namespace odis::render {
namespace {

// Products are made in double precision: files chain many steps.
using Matrix = Imath::M44d;
using Vector = Imath::V3d;

Matrix parseMatrix(const XmlElement& element) {
  element.allow({"value"});
  const std::vector<double> v = parseNumbers(element.require("value"), "the matrix", element.at);
  if (v.size() != 16 && v.size() != 9)
    throw SceneError(element.at, "found " + std::to_string(v.size()) +
                                     " numbers in <matrix>, expected 16 (4x4) or 9 (3x3)");
  const int size = v.size() == 16 ? 4 : 3;
  Matrix result;
  // The file multiplies column vectors, this program row vectors.
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) result[column][row] = v[size_t(row * size + column)];
  return result;
}

Matrix parseRotation(const XmlElement& element, RotationAxis length) {
  element.allow({"x", "y", "z", "value", "angle"});
  const double angle = parseNumber(element.require("angle"), "the angle", element.at) * M_PI / 180;
  Vector axis = parseVector(element, 0, false);
  if (axis.length() == 0)
    throw SceneError(element.at, "found the rotation axis 0 0 0, expected an axis with a length");
  if (length == RotationAxis::normalized) axis.normalize();
  // Rodrigues' formula, transposed for row vectors.
  const double s = std::sin(angle), c = std::cos(angle);
  Matrix result;
  const double turn[3][3] = {{0, axis.z, -axis.y}, {-axis.z, 0, axis.x}, {axis.y, -axis.x, 0}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      result[i][j] = (i == j ? c : 0) + s * turn[i][j] + (1 - c) * axis[i] * axis[j];
  return result;
}

Matrix parseLookAt(const XmlElement& element) {
  element.allow({"origin", "target", "up"});
  const auto point = [&](const char* name) {
    const std::vector<double> v =
        parseNumbers(element.require(name), std::string("'") + name + "'", element.at);
    if (v.size() != 3)
      throw SceneError(element.at,
                       "found " + std::to_string(v.size()) + " numbers for '" + name + "', expected 3");
    return Vector(v[0], v[1], v[2]);
  };
  const Vector origin = point("origin");
  Vector direction = point("target") - origin;
  if (direction.length() == 0)
    throw SceneError(element.at,
                     "found the same origin and target in <" + element.tag + ">, expected two points");
  direction.normalize();
  // Without `up` any will do that is not along the direction.
  Vector up = std::abs(direction.y) < 0.9 ? Vector(0, 1, 0) : Vector(0, 0, 1);
  if (element.has("up")) up = point("up");
  Vector left = up.cross(direction);
  if (!(left.length() > 1e-9 * up.length()))
    throw SceneError(element.at, "found an 'up' along the viewing direction in <" + element.tag +
                                     ">, expected one that is not parallel to target - origin");
  left.normalize();
  const Vector rows[4] = {left, direction.cross(left), direction, origin};
  Matrix result;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 3; ++j) result[i][j] = rows[i][j];
  return result;
}

Matrix parseStep(const XmlElement& element, RotationAxis axis) {
  const std::string tag = lowerCase(element.tag);
  if (tag == "matrix") return parseMatrix(element);
  if (tag == "rotate") return parseRotation(element, axis);
  if (tag == "lookat") return parseLookAt(element);
  Matrix result;
  if (tag == "translate") {
    element.allow({"x", "y", "z", "value"});
    result.setTranslation(parseVector(element, 0, false));
  } else if (tag == "scale") {
    element.allow({"x", "y", "z", "value"});
    result.setScale(parseVector(element, 1, true));
  } else {
    throw SceneError(element.at, "found <" + element.tag +
                                     "> in a transform, expected matrix, translate, rotate, scale or lookat" +
                                     suggestion(tag, {"matrix", "translate", "rotate", "scale", "lookat"}));
  }
  return result;
}

}  // namespace

Matrix parseTransform(const std::vector<XmlElement>& steps, RotationAxis axis) {
  Matrix product;
  for (const XmlElement& step : steps) product = product * parseStep(step, axis);
  return product;
}

bool mirrors(const Matrix4& matrix) {
  return Matrix(matrix).determinant() < 0;
}

bool isInvertibleAffine(const Matrix4& matrix) {
  double volume = 1;
  const Matrix m(matrix);
  Vector rows[3];
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j)
      if (!std::isfinite(m[i][j])) return false;
    if (std::abs(m[i][3] - (i == 3)) > 1e-6) return false;
    if (i == 3) continue;
    rows[i] = {m[i][0], m[i][1], m[i][2]};
    volume *= rows[i].length();
  }
  // The determinant against the box of the same edges: how flat the basis is, whatever its scale.
  return volume > 0 && std::abs(rows[0].cross(rows[1]).dot(rows[2])) > 1e-9 * volume;
}

}  // namespace odis::render
