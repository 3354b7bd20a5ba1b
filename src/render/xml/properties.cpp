#include "render/xml/properties.h"

#include "render/xml/names.h"

namespace odis::render {
namespace {

std::string describe(const PropertyValue& value) {
  static const char* const kinds[] = {"a boolean", "an integer", "a number",   "the string",
                                      "a point",   "a colour",   "a transform"};
  if (const std::string* text = std::get_if<std::string>(&value)) return "the string '" + *text + "'";
  return kinds[value.index()];
}

// The parameter, marked as queried; null if it is missing and may be.
const Properties::Parameter* find(const Properties& node, const std::string& name, bool mayBeMissing,
                                  const char* expected) {
  const auto found = node.parameters.find(name);
  if (found == node.parameters.end()) {
    if (mayBeMissing) return nullptr;
    std::vector<std::string> known;
    for (const auto& entry : node.parameters) known.push_back(entry.first);
    throw SceneError(node.location, "the " + node.tag + " '" + node.type + "' has no parameter '" + name +
                                        "'" + suggestion(name, known) + ", expected " + expected);
  }
  found->second.queried = true;
  return &found->second;
}

[[noreturn]] void throwWrongType(const Properties::Parameter& parameter, const std::string& name,
                                 const char* expected) {
  throw SceneError(parameter.location,
                   "found " + describe(parameter.value) + " for '" + name + "', expected " + expected);
}

// A getter for values that are stored as they are asked for.
template <class T>
T get(const Properties& node, const std::string& name, const T* fallback, const char* expected) {
  const Properties::Parameter* parameter = find(node, name, fallback != nullptr, expected);
  if (!parameter) return *fallback;
  if (const T* value = std::get_if<T>(&parameter->value)) return *value;
  throwWrongType(*parameter, name, expected);
}

template <class T>
const T* pointer(const std::optional<T>& value) {
  return value ? &*value : nullptr;
}

}  // namespace

float Properties::number(const std::string& name, std::optional<float> fallback) const {
  const Parameter* parameter = find(*this, name, fallback.has_value(), "a number");
  if (!parameter) return *fallback;
  if (const double* value = std::get_if<double>(&parameter->value)) return float(*value);
  if (const int64_t* value = std::get_if<int64_t>(&parameter->value)) return float(*value);
  throwWrongType(*parameter, name, "a number");
}

int64_t Properties::integer(const std::string& name, std::optional<int64_t> fallback) const {
  return get(*this, name, pointer(fallback), "an integer");
}

bool Properties::boolean(const std::string& name, std::optional<bool> fallback) const {
  return get(*this, name, pointer(fallback), "true or false");
}

std::string Properties::string(const std::string& name, std::optional<std::string> fallback) const {
  return get(*this, name, pointer(fallback), "a string");
}

Vec3 Properties::vector(const std::string& name, std::optional<Vec3> fallback) const {
  return get(*this, name, pointer(fallback), "a point or a vector");
}

Rgb Properties::color(const std::string& name, std::optional<Rgb> fallback) const {
  const Parameter* parameter = find(*this, name, fallback.has_value(), "a colour");
  if (!parameter) return *fallback;
  if (const Rgb* value = std::get_if<Rgb>(&parameter->value)) return *value;
  if (const double* value = std::get_if<double>(&parameter->value)) return Rgb(float(*value));
  if (const int64_t* value = std::get_if<int64_t>(&parameter->value)) return Rgb(float(*value));
  throwWrongType(*parameter, name, "a colour or a number");
}

Matrix4 Properties::transform(const std::string& name, const Matrix4& fallback) const {
  return get(*this, name, &fallback, "a transform");
}

const Properties* Properties::child(const std::string& tagName, const std::string& name) const {
  for (const Child& candidate : children) {
    if (candidate.node->tag != tagName || (!name.empty() && candidate.name != name)) continue;
    candidate.queried = true;
    return candidate.node.get();
  }
  return nullptr;
}

std::vector<std::pair<std::string, SourceLocation>> Properties::unqueried() const {
  std::vector<std::pair<std::string, SourceLocation>> result;
  for (const auto& [name, parameter] : parameters)
    if (!parameter.queried) result.emplace_back(name, parameter.location);
  for (const Child& candidate : children)
    if (!candidate.queried)
      result.emplace_back(
          candidate.name.empty() ? candidate.node->tag + " " + candidate.node->type : candidate.name,
          candidate.node->location);
  return result;
}

}  // namespace odis::render
