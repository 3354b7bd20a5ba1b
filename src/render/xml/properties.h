// One element of a scene file, as parsed: its parameters by name and its nested elements, defaults and
// `$variables` already filled in, references resolved. Names are lower snake_case whatever the age of the
// file ("toWorld" and "to_world" are both "to_world", "intIOR" is "int_ior").
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "render/math/vec.h"
#include "render/xml/error.h"

namespace odis::render {

// A spectrum given as wavelength:value pairs or as a file name is turned into linear RGB by the parser.
using PropertyValue = std::variant<bool, int64_t, double, std::string, Vec3, Rgb, Matrix4>;

class Properties {
 public:
  struct Parameter {
    PropertyValue value;
    SourceLocation location;
    mutable bool queried = false;
  };
  struct Child {
    std::string name;  // "" if the element has none
    std::shared_ptr<const Properties> node;
    mutable bool queried = false;
  };

  std::string tag;   // "bsdf", "shape", "texture", "emitter", "sensor", "film", "rfilter", ...
  std::string type;  // plugin name, lower case: "roughconductor"
  std::string id;    // "" if none
  SourceLocation location;
  std::map<std::string, Parameter> parameters;
  std::vector<Child> children;

  bool has(const std::string& name) const { return parameters.count(name) > 0; }

  // Each getter throws SceneError at the parameter's place if its type is not the one asked for (an integer
  // is accepted where a number is); without a fallback also if it is missing. Each marks the parameter as
  // queried.
  float number(const std::string& name, std::optional<float> fallback = {}) const;
  int64_t integer(const std::string& name, std::optional<int64_t> fallback = {}) const;
  bool boolean(const std::string& name, std::optional<bool> fallback = {}) const;
  std::string string(const std::string& name, std::optional<std::string> fallback = {}) const;
  Vec3 vector(const std::string& name, std::optional<Vec3> fallback = {}) const;   // point or vector
  Rgb color(const std::string& name, std::optional<Rgb> fallback = {}) const;      // a number is a grey
  Matrix4 transform(const std::string& name, const Matrix4& fallback = {}) const;  // rows multiply: p * M

  // The first nested element with this tag (and name, unless ""); null if there is none. Marks it as queried.
  const Properties* child(const std::string& tagName, const std::string& name = "") const;
  // The parameters and children that nobody asked for, as "name (file:line:column)"; for warnings.
  std::vector<std::pair<std::string, SourceLocation>> unqueried() const;
};

}  // namespace odis::render
