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

#include "render/math/interval.h"
#include "render/math/motion.h"
#include "render/math/vec.h"
#include "render/xml/error.h"

namespace odis::render {

// A spectrum given as wavelength:value pairs or as a file name is turned into linear RGB by the parser.
// Points and transforms are as precise as the file has them: what is large may touch what is small.
using PropertyValue =
    std::variant<bool, int64_t, double, std::string, Imath::V3d, Rgb, Imath::M44d, Animation>;

// What a parameter may be, as the getter that read it has said. The manual's table is checked against these.
struct Declaration {
  const char* type;                // "number", "integer", "boolean", "point", ...
  NumberRange range = kAnyNumber;  // of a number, or of each channel of a colour
  const char* words = "";          // of a string that is one of several: "x|y|diagonal"
  bool clamped = false;            // into the range, with a warning, instead of refused
  // What counts where it is not given: a value, or words if that hangs on other things. Neither: it has to be
  // given.
  std::optional<PropertyValue> fallback = {};
  const char* otherwise = "";

  // "number, 0 to 1".
  std::string text() const;
  // "0.5", "bk7", "required".
  std::string fallbackText() const;
};

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
  bool before2 = false;  // whether the scene says that it is one of Mitsuba 0.5 or 0.6
  std::map<std::string, Parameter> parameters;
  std::vector<Child> children;

  bool has(const std::string& name) const { return parameters.count(name) > 0; }

  // Each getter declares what the parameter may be, marks it as queried, and throws SceneError at its place
  // if it is something else (an integer is accepted where a number is); without a fallback also if it is
  // missing.
  float number(const std::string& name, const NumberRange& range, std::optional<float> fallback = {}) const;
  int64_t integer(const std::string& name, const NumberRange& range,
                  std::optional<int64_t> fallback = {}) const;
  bool boolean(const std::string& name, std::optional<bool> fallback = {}) const;
  std::string string(const std::string& name, std::optional<std::string> fallback = {}) const;
  // One of `words`, "a|b|c", in lower case.
  std::string word(const std::string& name, const char* words, const std::string& fallback) const;
  Vec3 vector(const std::string& name, std::optional<Vec3> fallback = {}) const;  // point or vector
  Imath::V3d preciseVector(const std::string& name, std::optional<Imath::V3d> fallback = {}) const;
  // A number is a grey.
  Rgb color(const std::string& name, const NumberRange& range, std::optional<Rgb> fallback = {}) const;
  Matrix4 transform(const std::string& name, const Matrix4& fallback = {}) const;  // rows multiply: p * M
  Imath::M44d preciseTransform(const std::string& name, const Imath::M44d& fallback = {}) const;
  // The key frames of a transform that moves; null if it doesn't. Does not mark it as queried.
  const Animation* animation(const std::string& name) const;
  // A number that may be absent.
  std::optional<float> optionalNumber(const std::string& name, const NumberRange& range) const;

  // The first nested element with this tag (and name, unless ""); null if there is none. Marks it as queried.
  const Properties* child(const std::string& tagName, const std::string& name = "") const;
  // The parameters and children that nobody asked for; for warnings.
  std::vector<std::pair<std::string, SourceLocation>> unqueried() const;
  // What has been asked for, given or not.
  const std::map<std::string, Declaration>& declarations() const { return m_declarations; }
  // " (did you mean 'a'?)" with a parameter that has been asked for.
  std::string suggestionFor(const std::string& name) const;
  // Says what a parameter may be; the getters do so themselves. The first to say it counts.
  void declare(const std::string& name, const Declaration& declaration) const;
  // Says in words what counts where a parameter that has been asked for is not given.
  void describeFallback(const std::string& name, const char* words) const;
  // Where the parameter stands; the element itself if it has none of this name.
  const SourceLocation& placeOf(const std::string& name) const;
  // Throws SceneError: "found 2 for 'alpha', expected 0 to 1".
  [[noreturn]] void refuse(const std::string& name, const std::string& found,
                           const std::string& expected) const;

 private:
  mutable std::map<std::string, Declaration> m_declarations;
};

// For elements of which only a part is read, as the picture depends on no more: warns of parameters that
// nobody asked for if they resemble one that somebody did; the others change nothing.
void warnOfMisspelt(const Properties& node, Warnings& warnings);

}  // namespace odis::render
