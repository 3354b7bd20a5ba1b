#include "render/xml/spectrum_object.h"

#include <algorithm>

#include "render/xml/element.h"

namespace odis::render {
namespace {

// Numbers that no colour is made of: normals and the like.
PropertyValue rawConstant(const Properties& node) {
  const auto value = node.parameters.find("value");
  if (value == node.parameters.end() || !std::holds_alternative<Imath::V3d>(value->second.value))
    return node.color("value", kAnyNumber);
  const Vec3 v = node.vector("value");
  return Rgb(v.x, v.y, v.z);
}

}  // namespace

bool isSpectrumType(const std::string& type) {
  constexpr const char* types[] = {"blackbody", "d65",  "irregular", "rawconstant",
                                   "regular",   "srgb", "uniform"};
  return std::find(std::begin(types), std::end(types), type) != std::end(types);
}

PropertyValue spectrumObject(const Properties& node, SpectrumUse use) {
  // What the colour is used for says what it may be.
  const NumberRange& any = kAnyNumber;
  const float scale = node.number("scale", any, 1.0f);
  if (node.type == "uniform") {
    // Its range of wavelengths changes nothing of a colour.
    for (const char* end : {"wavelength_min", "wavelength_max"}) node.optionalNumber(end, any);
    return double(node.number("value", any, 1.0f)) * scale;
  }
  if (node.type == "d65") return Rgb(node.color("color", any, node.color("value", any, Rgb(1.0f))) * scale);
  if (node.type == "srgb") return Rgb(node.color("color", any) * scale);
  if (node.type == "blackbody") return Rgb(blackbodyToRgb(node.number("temperature", kTemperatures)) * scale);
  if (node.type == "rawconstant") return rawConstant(node);
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
