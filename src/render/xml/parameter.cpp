// The elements that hold a value: <float>, <rgb>, <transform>, <spectrum> and their like.
#include <cmath>

#include "render/xml/names.h"
#include "render/xml/parser.h"
#include "render/xml/spectrum.h"

namespace odis::render {
namespace {

float decodeSrgb(float x) {
  return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

// In kelvin; hotter than any star.
constexpr NumberRange kTemperatures{0, 1e6, false};

// "5000" or "5000K".
double parseTemperature(std::string text, const SourceLocation& at) {
  if (!text.empty() && (text.back() == 'K' || text.back() == 'k')) text.pop_back();
  const double kelvin = parseNumber(text, "the temperature", at);
  if (!kTemperatures.contains(kelvin))
    throw SceneError(at,
                     "found the temperature '" + text + "', expected " + kTemperatures.text() + " kelvin");
  return kelvin;
}

}  // namespace

bool XmlParser::parseNestedValue(const Place& place, const pugi::xml_node& node, const XmlElement& e,
                                 Properties& owner) {
  const std::string& tag = e.tag;
  if (tag == "transform") {
    e.allow({"name"});
    const Matrix4 matrix = parseTransformSteps(place, node);
    const bool places = owner.tag == "shape" || owner.tag == "sensor" || owner.tag == "emitter";
    if (places && snakeCase(e.require("name")) == "to_world" && !isInvertibleAffine(matrix))
      throw SceneError(e.at,
                       "found a transform 'to_world' that has no inverse or is not affine, expected one that "
                       "keeps the volume of the " +
                           owner.tag);
    addParameter(owner, e, matrix);
    return true;
  }
  if (tag == "animation") {
    e.allow({"name"});
    const pugi::xml_node first = node.child("transform");
    if (!first) throw SceneError(e.at, "found no <transform> in <animation>, expected at least one");
    m_warnings.add(e.at, "motion is not supported, the first transform of the animation is used");
    addParameter(owner, e, parseTransformSteps(place, first));
    return true;
  }
  if (tag == "spectrum" && e.has("type")) {
    e.allow({"name", "type", "id"});
    addParameter(owner, e, parseSpectrumObject(place, *parseObject(place, node, e)));
    return true;
  }
  return false;
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

Matrix4 XmlParser::parseTransformSteps(const Place& place, const pugi::xml_node& node) {
  place.file.rejectText(node);
  std::vector<XmlElement> steps;
  for (const pugi::xml_node& child : node.children())
    if (child.type() == pugi::node_element) steps.push_back(element(place, child));
  const Matrix4 matrix = parseTransform(steps);
  for (int i = 0; i < 16; ++i)
    if (!std::isfinite(matrix[i / 4][i % 4]))
      throw SceneError(place.file.locate(node),
                       "the product of the transform is not finite, expected finite numbers");
  return matrix;
}

PropertyValue XmlParser::parseSpectrumValue(const Place& place, const XmlElement& e) {
  const std::string name = snakeCase(e.require("name"));
  const bool index = name == "eta" || name == "k" || name == "int_ior" || name == "ext_ior";
  const SpectrumUse use = place.emitter ? SpectrumUse::emission
                          : index       ? SpectrumUse::index
                                        : SpectrumUse::reflectance;
  if (e.has("filename"))
    return spectrumToRgb(readSpectrumFile(findFile(place, e.require("filename"), e.at), e.at), use);
  const std::string& text = e.require("value");
  if (text.find(':') != std::string::npos) return spectrumToRgb(parseSpectrum(text, e.at), use);
  const std::vector<double> v = parseNumbers(text, "'" + e.require("name") + "'", e.at);
  if (v.size() == 3) return Rgb(float(v[0]), float(v[1]), float(v[2]));
  if (v.size() != 1)
    throw SceneError(e.at,
                     "found '" + text + "' in <spectrum>, expected one number or wavelength:value pairs");
  // Light that is the same at all wavelengths is not the white of RGB images; Mitsuba 3 shows it as it is,
  // too.
  if (place.emitter) return Rgb(spectrumToRgb({{360, 1}, {830, 1}}, use) * float(v[0]));
  return v[0];
}

PropertyValue XmlParser::parseSpectrumObject(const Place& place, const Properties& node) {
  const SpectrumUse use = place.emitter ? SpectrumUse::emission : SpectrumUse::reflectance;
  // What the colour is used for says what it may be.
  const NumberRange& any = kAnyNumber;
  const float scale = node.number("scale", any, 1.0f);
  if (node.type == "uniform") return double(node.number("value", any, 1.0f)) * scale;
  if (node.type == "d65") return Rgb(node.color("color", any, node.color("value", any, Rgb(1.0f))) * scale);
  if (node.type == "srgb") return Rgb(node.color("color", any) * scale);
  if (node.type == "blackbody") return Rgb(blackbodyToRgb(node.number("temperature", kTemperatures)) * scale);
  if (node.type != "regular" && node.type != "irregular")
    throw SceneError(node.location, "found the spectrum '" + node.type +
                                        "', expected uniform, d65, srgb, blackbody, regular or irregular");
  const std::vector<double> values = parseNumbers(node.string("values"), "'values'", node.location);
  std::vector<double> wavelengths;
  if (node.type == "irregular") {
    wavelengths = parseNumbers(node.string("wavelengths"), "'wavelengths'", node.location);
  } else {
    constexpr NumberRange nanometres{0, 1e6, false};
    const double low = node.number("wavelength_min", nanometres),
                 high = node.number("wavelength_max", nanometres);
    for (size_t i = 0; i < values.size(); ++i)
      wavelengths.push_back(low + (high - low) * double(i) / std::max<double>(1, double(values.size()) - 1));
  }
  if (wavelengths.size() != values.size())
    throw SceneError(node.location, "found " + std::to_string(wavelengths.size()) + " wavelengths and " +
                                        std::to_string(values.size()) + " values, expected as many of each");
  std::vector<SpectrumSample> samples;
  for (size_t i = 0; i < values.size(); ++i) samples.push_back({wavelengths[i], values[i] * scale});
  checkSpectrum(samples, node.location);
  return spectrumToRgb(samples, use);
}

}  // namespace odis::render
