// The elements that hold a value: <float>, <rgb>, <transform>, <spectrum> and their like.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "render/xml/names.h"
#include "render/xml/parser.h"
#include "render/xml/spectrum.h"
#include "render/xml/spectrum_object.h"

namespace odis::render {
namespace {

float decodeSrgb(float x) {
  return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

// What the spectrum of an element is used for, within an emitter or not.
SpectrumUse useOf(bool inEmitter, const XmlElement& e) {
  if (inEmitter) return SpectrumUse::emission;
  const std::string name = snakeCase(e.require("name"));
  static const std::set<std::string> unbounded = {"alpha",   "alpha_u", "alpha_v", "delta",   "eta",
                                                  "ext_ior", "int_ior", "k",       "sigma_a", "theta"};
  return unbounded.count(name) > 0 ? SpectrumUse::unbounded : SpectrumUse::reflectance;
}

// "5000" or "5000K".
double parseTemperature(std::string text, const SourceLocation& at) {
  if (!text.empty() && (text.back() == 'K' || text.back() == 'k')) text.pop_back();
  const double kelvin = parseNumber(text, "the temperature", at);
  if (!kTemperatures.contains(kelvin))
    throw SceneError(at,
                     "found the temperature '" + text + "', expected " + kTemperatures.text() + " kelvin");
  return kelvin;
}

// Whether an element says where its owner is.
bool isPlace(const XmlElement& e, const Properties& owner) {
  const bool hasPlace = owner.tag == "shape" || owner.tag == "sensor" || owner.tag == "emitter";
  return hasPlace && snakeCase(e.require("name")) == "to_world";
}

void rejectSingular(const Matrix4& matrix, const SourceLocation& at, const Properties& owner) {
  if (isInvertibleAffine(matrix)) return;
  throw SceneError(at,
                   "found a transform 'to_world' that has no inverse or is not affine, expected one that "
                   "keeps the volume of the " +
                       owner.tag);
}

// Whether an element may be given a place that changes with time.
bool canMove(const Properties& owner) {
  if (owner.tag == "shape") return owner.type != "shapegroup" && owner.type != "merge";
  if (owner.tag == "sensor") return true;
  static const std::set<std::string> emitters = {"directional", "envmap", "point", "projector", "spot"};
  return owner.tag == "emitter" && emitters.count(owner.type) > 0;
}

// D65 that lights a texture is the texture in RGB, and Mitsuba 3 does without its scale.
void becomeItsTexture(Properties& d65, Warnings& warnings) {
  const auto scale = d65.parameters.find("scale");
  if (scale != d65.parameters.end()) {
    warnings.add(scale->second.location,
                 "'scale' of the spectrum 'd65' has no effect beside a texture, as in Mitsuba 3",
                 Effect::same);
    d65.parameters.erase(scale);
  }
  d65.type = "scale";
}

void warnOfUnknown(const Properties& spectrum, Warnings& warnings) {
  for (const auto& [name, location] : spectrum.unqueried())
    warnings.add(location, "unknown parameter '" + name + "' of the spectrum '" + spectrum.type +
                               "' is ignored" + spectrum.suggestionFor(name));
}

}  // namespace

bool XmlParser::parseNestedValue(const Place& place, const pugi::xml_node& node, const XmlElement& e,
                                 Properties& owner) {
  const std::string& tag = e.tag;
  if (tag == "transform") {
    e.allow({"name"});
    const Imath::M44d matrix = parseTransformSteps(place, node);
    if (isPlace(e, owner)) rejectSingular(Matrix4(matrix), e.at, owner);
    addParameter(owner, e, matrix);
    return true;
  }
  if (tag == "animation") {
    parseAnimation(place, node, e, owner);
    return true;
  }
  return false;
}

void XmlParser::parseAnimation(const Place& place, const pugi::xml_node& node, const XmlElement& e,
                               Properties& owner) {
  e.allow({"name"});
  place.file.rejectText(node);
  Animation animation;
  std::set<double> times;
  for (const pugi::xml_node& child : node.children()) {
    if (child.type() != pugi::node_element) continue;
    const XmlElement key = element(place, child);
    if (key.tag != "transform")
      throw SceneError(key.at, "found <" + key.tag + "> in <animation>, expected <transform time=\"...\">");
    key.allow({"time"});
    const double time = parseNumber(key.require("time"), "the time", key.at);
    if (!times.insert(time).second)
      throw SceneError(
          key.at,
          fmt::format("found the time {} in <animation> again, expected each transform at another", time));
    const Matrix4 matrix(parseTransformSteps(place, child));
    if (isPlace(e, owner)) rejectSingular(matrix, key.at, owner);
    if (!animation.empty() && mirrors(matrix) != mirrors(animation.back().toWorld))
      throw SceneError(key.at,
                       "found a transform that mirrors beside one that doesn't in <animation>, expected one "
                       "that can be reached without flattening the " +
                           owner.tag);
    animation.push_back({time, matrix});
  }
  if (animation.empty()) throw SceneError(e.at, "found no <transform> in <animation>, expected one or more");
  std::sort(animation.begin(), animation.end(),
            [](const KeyFrame& a, const KeyFrame& b) { return a.time < b.time; });
  if (animation.size() > 1 && isPlace(e, owner) && canMove(owner)) {
    addParameter(owner, e, std::move(animation));
    return;
  }
  // What has one transform stands still.
  if (animation.size() > 1)
    m_warnings.add(e.at, "'" + e.require("name") + "' of the " + owner.tag + " '" + owner.type +
                             "' can't move, the first transform of the animation is used");
  addParameter(owner, e, Imath::M44d(animation.front().toWorld));
}

bool XmlParser::parseValue(const Place& place, const pugi::xml_node& node, const XmlElement& e,
                           Properties& owner) {
  if (parseNestedValue(place, node, e, owner)) return true;
  const std::string& tag = e.tag;
  PropertyValue value;
  const auto text = [&]() -> const std::string& { return e.require("value"); };
  const auto what = [&] { return e.has("name") ? "'" + e.require("name") + "'" : "<" + tag + ">"; };
  if (tag == "float" || tag == "integer" || tag == "boolean" || tag == "string" || tag == "rgb" ||
      tag == "srgb") {
    e.allow({"name", "value"});
    if (tag == "float") value = parseNumber(text(), what(), e.at);
    if (tag == "integer") value = parseInteger(text(), what(), e.at);
    if (tag == "boolean") value = parseBoolean(text(), what(), e.at);
    if (tag == "string") value = text();
    if (tag == "rgb") value = parseRgb(text(), what(), e.at);
    if (tag == "srgb") {
      const Rgb c = parseRgb(text(), what(), e.at);
      value = Rgb(decodeSrgb(c.x), decodeSrgb(c.y), decodeSrgb(c.z));
    }
  } else if (tag == "point" || tag == "vector") {
    e.allow({"name", "value", "x", "y", "z"});
    value = parseVector(e, 0, false);
  } else if (tag == "spectrum") {
    e.allow({"name", "value", "filename", "intent"});
    value = parseSpectrumValue(place, e);
  } else if (tag == "blackbody") {
    e.allow({"name", "temperature", "scale"});
    const double scale = e.has("scale") ? parseNumber(e.require("scale"), "the scale", e.at) : 1;
    value = Rgb(blackbodyToRgb(parseTemperature(e.require("temperature"), e.at)) * float(scale));
  } else {
    return false;
  }
  if (node.first_child())
    throw SceneError(e.at,
                     "found something inside <" + tag + ">, expected an empty element <" + tag + " .../>");
  addParameter(owner, e, std::move(value));
  return true;
}

Imath::M44d XmlParser::parseTransformSteps(const Place& place, const pugi::xml_node& node) {
  place.file.rejectText(node);
  std::vector<XmlElement> steps;
  for (const pugi::xml_node& child : node.children())
    if (child.type() == pugi::node_element) steps.push_back(element(place, child));
  const Imath::M44d matrix =
      parseTransform(steps, m_before2 ? RotationAxis::normalized : RotationAxis::asGiven);
  for (const XmlElement& step : steps) noteStretchingAxis(step);
  for (int i = 0; i < 16; ++i)
    if (!std::isfinite(float(matrix[i / 4][i % 4])))
      throw SceneError(place.file.locate(node),
                       "the product of the transform is not finite, expected finite numbers");
  return matrix;
}

void XmlParser::noteStretchingAxis(const XmlElement& step) {
  if (m_before2 || lowerCase(step.tag) != "rotate") return;
  if (std::abs(parseVector(step, 0, false).length() - 1) < 1e-3) return;
  m_warnings.add(
      step.at, "the axis of <rotate> isn't of unit length, which stretches as well, as it does in Mitsuba 3",
      Effect::same);
}

bool XmlParser::parseSpectrumObject(const Place& place, const pugi::xml_node& node, const XmlElement& e,
                                    Properties& owner) {
  if ((e.tag != "spectrum" && e.tag != "texture") || !e.has("type")) return false;
  const bool isColor = isSpectrumType(lowerCase(e.require("type"))) && (e.tag == "spectrum" || !e.has("id"));
  if (e.tag == "texture" && !isColor) return false;
  e.allow({"name", "type", "id"});
  const std::shared_ptr<Properties> object = parseObject(place, node, e);
  if (object->type == "d65" && !object->children.empty()) becomeItsTexture(*object, m_warnings);
  if (isSpectrumType(object->type)) {
    if (!object->children.empty())
      throw SceneError(e.at, "found an element inside of the spectrum '" + object->type +
                                 "', expected nothing but its parameters");
    addParameter(owner, e, spectrumObject(*object, useOf(place.emitter, e)));
    warnOfUnknown(*object, m_warnings);
  } else {
    addObject(owner, e, object, "texture");
  }
  return true;
}

PropertyValue XmlParser::parseSpectrumValue(const Place& place, const XmlElement& e) {
  const SpectrumUse use = useOf(place.emitter, e);
  if (e.has("filename")) {
    const std::optional<std::string> path = findInput(e.require("filename"), e.at);
    return path ? spectrumToRgb(readSpectrumFile(*path, e.at), use) : Rgb(0);
  }
  const std::string& text = e.require("value");
  if (text.find(':') != std::string::npos) return spectrumToRgb(parseSpectrum(text, e.at), use);
  const std::vector<double> v = parseNumbers(text, "'" + e.require("name") + "'", e.at);
  if (v.size() == 3) return Rgb(float(v[0]), float(v[1]), float(v[2]));
  if (v.size() != 1)
    throw SceneError(e.at,
                     "found '" + text + "' in <spectrum>, expected one number or wavelength:value pairs");
  if (place.emitter) return uniformEmission(v[0]);
  return v[0];
}

}  // namespace odis::render
