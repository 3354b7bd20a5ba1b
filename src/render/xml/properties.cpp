#include "render/xml/properties.h"

#include <sstream>

#include "render/xml/names.h"

namespace odis::render {
namespace {

std::string describe(const PropertyValue& value) {
  static const char* const kinds[] = {"a boolean", "an integer", "a number",    "the string",
                                      "a point",   "a colour",   "a transform", "an animation"};
  if (const std::string* text = std::get_if<std::string>(&value)) return "the string '" + *text + "'";
  return kinds[value.index()];
}

// "a number", "an integer", "true or false".
std::string withArticle(const std::string& type) {
  if (type == "boolean") return "true or false";
  return (type == "integer" ? "an " : "a ") + type;
}

// " ('alpa' may be meant to be it)" with a parameter that the element has in place of the one it has not.
std::string misspelt(const Properties& node, const std::string& name) {
  for (const auto& [given, parameter] : node.parameters)
    if (!suggestion(given, {name}).empty()) return " ('" + given + "' may be meant to be it)";
  return "";
}

// The parameter, declared and marked as queried; null if it is missing and may be.
const Properties::Parameter* find(const Properties& node, const std::string& name, bool mayBeMissing,
                                  const Declaration& declaration) {
  node.declare(name, declaration);
  const auto found = node.parameters.find(name);
  if (found == node.parameters.end()) {
    if (mayBeMissing) return nullptr;
    throw SceneError(node.location, "the " + node.tag + " '" + node.type + "' has no parameter '" + name +
                                        "'" + misspelt(node, name) + ", expected " +
                                        withArticle(declaration.type));
  }
  found->second.queried = true;
  return &found->second;
}

// A getter for values that are stored as they are asked for.
template <class T>
T get(const Properties& node, const std::string& name, const T* fallback, const char* type) {
  Declaration declaration{.type = type};
  if (fallback) declaration.fallback = *fallback;
  const Properties::Parameter* parameter = find(node, name, fallback != nullptr, declaration);
  if (!parameter) return *fallback;
  if (const T* value = std::get_if<T>(&parameter->value)) return *value;
  node.refuse(name, describe(parameter->value), withArticle(type));
}

// A number, be it stored as one or as an integer.
std::optional<double> numberIn(const PropertyValue& value) {
  if (const double* number = std::get_if<double>(&value)) return *number;
  if (const int64_t* integer = std::get_if<int64_t>(&value)) return double(*integer);
  return {};
}

template <class T>
const T* pointer(const std::optional<T>& value) {
  return value ? &*value : nullptr;
}

}  // namespace

std::string Declaration::text() const {
  const std::string limits = *words ? words : range.text();
  return type + (limits == "any" ? "" : ", " + limits) + (clamped ? ", clamped" : "");
}

std::string Declaration::fallbackText() const {
  if (*otherwise || !fallback) return *otherwise ? otherwise : "required";
  return std::visit(
      [](const auto& value) -> std::string {
        using T = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<T, double>) {
          return fmt::format("{}", float(value));
        } else if constexpr (std::is_same_v<T, Rgb>) {
          return value.x == value.y && value.y == value.z
                     ? fmt::format("{}", value.x)
                     : fmt::format("{}, {}, {}", value.x, value.y, value.z);
        } else if constexpr (std::is_same_v<T, Imath::V3d>) {
          return fmt::format("{}, {}, {}", value.x, value.y, value.z);
        } else if constexpr (std::is_same_v<T, Imath::M44d>) {
          return value == Imath::M44d() ? "identity" : "a transform";
        } else if constexpr (std::is_same_v<T, Animation>) {
          return "an animation";
        } else {
          return fmt::format("{}", value);
        }
      },
      *fallback);
}

float Properties::number(const std::string& name, const NumberRange& range,
                         std::optional<float> fallback) const {
  const Parameter* parameter =
      find(*this, name, fallback.has_value(), {.type = "number", .range = range, .fallback = fallback});
  if (!parameter) return *fallback;
  const std::optional<double> value = numberIn(parameter->value);
  if (!value) refuse(name, describe(parameter->value), "a number");
  if (!range.contains(*value)) refuse(name, fmt::format("{}", *value), range.text());
  return float(*value);
}

std::optional<float> Properties::optionalNumber(const std::string& name, const NumberRange& range) const {
  declare(name, {.type = "number", .range = range, .otherwise = "none"});
  const float value = number(name, range, 0.0f);
  return has(name) ? std::optional(value) : std::nullopt;
}

int64_t Properties::integer(const std::string& name, const NumberRange& range,
                            std::optional<int64_t> fallback) const {
  const Parameter* parameter =
      find(*this, name, fallback.has_value(), {.type = "integer", .range = range, .fallback = fallback});
  if (!parameter) return *fallback;
  const int64_t* value = std::get_if<int64_t>(&parameter->value);
  if (!value) refuse(name, describe(parameter->value), "an integer");
  if (!range.contains(double(*value))) refuse(name, std::to_string(*value), range.text());
  return *value;
}

bool Properties::boolean(const std::string& name, std::optional<bool> fallback) const {
  return get(*this, name, pointer(fallback), "boolean");
}

std::string Properties::string(const std::string& name, std::optional<std::string> fallback) const {
  return get(*this, name, pointer(fallback), "string");
}

std::string Properties::word(const std::string& name, const char* words, const std::string& fallback) const {
  declare(name, {.type = "string", .words = words, .fallback = fallback});
  if (!has(name)) return fallback;
  const std::string given = string(name), found = lowerCase(given);
  std::vector<std::string> known;
  std::istringstream stream(words);
  for (std::string word; std::getline(stream, word, '|');) {
    if (word == found) return word;
    known.push_back(word);
  }
  refuse(name, "'" + given + "'" + suggestion(found, known), std::string("one of ") + words);
}

Vec3 Properties::vector(const std::string& name, std::optional<Vec3> fallback) const {
  return Vec3(preciseVector(name, fallback ? std::optional(Imath::V3d(*fallback)) : std::nullopt));
}

Imath::V3d Properties::preciseVector(const std::string& name, std::optional<Imath::V3d> fallback) const {
  return get(*this, name, pointer(fallback), "point or vector");
}

Rgb Properties::color(const std::string& name, const NumberRange& range, std::optional<Rgb> fallback) const {
  const Parameter* parameter = find(*this, name, fallback.has_value(),
                                    {.type = "colour or number", .range = range, .fallback = fallback});
  if (!parameter) return *fallback;
  if (const std::optional<double> value = numberIn(parameter->value)) {
    if (!range.contains(*value)) refuse(name, fmt::format("{}", *value), range.text());
    return Rgb(float(*value));
  }
  const Rgb* value = std::get_if<Rgb>(&parameter->value);
  if (!value) refuse(name, describe(parameter->value), "a colour or a number");
  for (const float channel : {value->x, value->y, value->z})
    if (!range.contains(channel))
      refuse(name, fmt::format("{}, {}, {}", value->x, value->y, value->z),
             range.text() + " in each channel");
  return *value;
}

Matrix4 Properties::transform(const std::string& name, const Matrix4& fallback) const {
  return Matrix4(preciseTransform(name, Imath::M44d(fallback)));
}

Imath::M44d Properties::preciseTransform(const std::string& name, const Imath::M44d& fallback) const {
  return get(*this, name, &fallback, "transform");
}

const Animation* Properties::animation(const std::string& name) const {
  const auto found = parameters.find(name);
  return found == parameters.end() ? nullptr : std::get_if<Animation>(&found->second.value);
}

void Properties::declare(const std::string& name, const Declaration& declaration) const {
  m_declarations.emplace(name, declaration);
}

void Properties::describeFallback(const std::string& name, const char* words) const {
  m_declarations.at(name).otherwise = words;
}

std::string Properties::suggestionFor(const std::string& name) const {
  std::vector<std::string> known;
  for (const auto& entry : m_declarations) known.push_back(entry.first);
  return suggestion(name, known);
}

const SourceLocation& Properties::placeOf(const std::string& name) const {
  const auto found = parameters.find(name);
  return found == parameters.end() ? location : found->second.location;
}

void Properties::refuse(const std::string& name, const std::string& found,
                        const std::string& expected) const {
  throw SceneError(placeOf(name), "found " + found + " for '" + name + "', expected " + expected);
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

void warnOfMisspelt(const Properties& node, Warnings& warnings) {
  for (const auto& [name, location] : node.unqueried()) {
    const std::string what = "'" + name + "' of the " + node.tag + " '" + node.type + "'";
    const std::string meant = node.suggestionFor(name);
    if (meant.empty())
      warnings.add(location, what + " has no effect", Effect::none);
    else
      warnings.add(location, "unknown parameter " + what + " is ignored" + meant);
  }
}

}  // namespace odis::render
