// Indices of refraction at 589 nm and 0 to 20 degrees Celsius; Hecht, "Optics", 4th edition.
#include "render/bsdf/ior.h"

#include "render/xml/names.h"

namespace odis::render {
namespace {

struct NamedDielectric {
  const char* name;
  float ior;
};
constexpr NamedDielectric kNamedDielectrics[] = {
    {"vacuum", 1.0f},      {"helium", 1.000036f},        {"hydrogen", 1.000132f},
    {"air", 1.000277f},    {"carbon dioxide", 1.00045f}, {"water", 1.3330f},
    {"acetone", 1.36f},    {"ethanol", 1.361f},          {"carbon tetrachloride", 1.461f},
    {"glycerol", 1.4729f}, {"benzene", 1.501f},          {"silicone oil", 1.52045f},
    {"bromine", 1.661f},   {"water ice", 1.31f},         {"fused quartz", 1.458f},
    {"pyrex", 1.470f},     {"acrylic glass", 1.49f},     {"polypropylene", 1.49f},
    {"bk7", 1.5046f},      {"sodium chloride", 1.544f},  {"amber", 1.55f},
    {"pet", 1.5750f},      {"diamond", 2.419f},
};

}  // namespace

float readIor(const Properties& properties, const std::string& name, const std::string& fallback) {
  properties.declare(name, {.type = "number or material", .range = kIndexRange, .fallback = fallback});
  const auto found = properties.parameters.find(name);
  const bool given = found != properties.parameters.end();
  if (given && !std::holds_alternative<std::string>(found->second.value))
    return properties.number(name, kIndexRange);
  const std::string material = lowerCase(properties.string(name, fallback));
  std::string known;
  for (const NamedDielectric& candidate : kNamedDielectrics) {
    if (material == candidate.name) return candidate.ior;
    known += std::string(known.empty() ? "\"" : ", \"") + candidate.name + "\"";
  }
  properties.refuse(name, "the unknown material '" + material + "'", "a number or one of " + known);
}

}  // namespace odis::render
