// One XML element as the parsers of values see it: its attributes, variables filled in, and its place.
#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <vector>

#include "render/math/vec.h"
#include "render/xml/error.h"

namespace odis::render {

struct XmlElement {
  std::string tag;
  SourceLocation at;
  std::map<std::string, std::string> attributes;

  bool has(const std::string& name) const { return attributes.count(name) > 0; }
  // Throws SceneError if there is no such attribute.
  const std::string& require(const std::string& name) const;
  // Throws SceneError if there is an attribute that is not in the list.
  void allow(std::initializer_list<const char*> names) const;
};

// Values in the text of an attribute. `what` says in errors what stands there ("the angle"). All throw
// SceneError; numbers are finite and fit into a float.
double parseNumber(const std::string& text, const std::string& what, const SourceLocation& at);
// Numbers separated by commas or white space.
std::vector<double> parseNumbers(const std::string& text, const std::string& what, const SourceLocation& at);
int64_t parseInteger(const std::string& text, const std::string& what, const SourceLocation& at);
bool parseBoolean(const std::string& text, const std::string& what, const SourceLocation& at);
// Three numbers, one that counts for all, or #rrggbb (scaled to [0, 1], not decoded).
Rgb parseRgb(const std::string& text, const std::string& what, const SourceLocation& at);
// value="x y z" (or one number for all three where `allowSingle`), or attributes x, y, z where absent ones
// are `missing`.
Imath::V3d parseVector(const XmlElement& element, double missing, bool allowSingle);
// What <rotate> makes of an axis that isn't of unit length.
enum class RotationAxis {
  normalized,  // turns about its direction: Mitsuba 0.6
  asGiven      // Rodrigues' formula as it stands, which stretches as well: Mitsuba 3
};
// The product of <matrix>, <translate>, <rotate>, <scale>, <lookat>; the first listed is applied first.
Imath::M44d parseTransform(const std::vector<XmlElement>& steps, RotationAxis axis);

// Whether the matrix is affine and has an inverse, as the place of a shape or a sensor must.
bool isInvertibleAffine(const Matrix4& matrix);
// Whether it turns right hands into left ones.
bool mirrors(const Matrix4& matrix);

}  // namespace odis::render
