// The parameters that media share, those of Mitsuba 0.6 among them.
#include <algorithm>

#include "render/medium/constant_volume.h"
#include "render/medium/factories.h"
#include "render/medium/materials.h"

namespace odis::render {
namespace {

constexpr NumberRange kCoefficients = between(0, 1e15);
constexpr Declaration kExtinction{"volume, number or colour", kCoefficients},
    kAlbedo{"volume, number or colour", kUnit};
// What Mitsuba 0.6 multiplies the coefficients of its materials by.
constexpr float kMaterialUnit = 100;

bool isOldHomogeneous(const Properties& medium) {
  return medium.before2 && medium.type == "homogeneous";
}

bool isGiven(const Properties& medium, const char* name) {
  return medium.has(name) ||
         std::any_of(medium.children.begin(), medium.children.end(), [&](const Properties::Child& child) {
           return child.node->tag == "volume" && child.name == name;
         });
}

// The first of the parameters that is given; null if none is.
const char* firstOf(const Properties& medium, std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (isGiven(medium, name)) return name;
  return nullptr;
}

// Coefficients come in pairs that say the same: one of them is given.
void refuseMixtures(const Properties& medium) {
  const char* const given[] = {
      firstOf(medium, {"sigma_s", "sigma_a"}),
      firstOf(medium, {"sigma_t", "density", "albedo"}),
      firstOf(medium, {"material"}),
  };
  const char* first = nullptr;
  for (const char* name : given) {
    if (first && name)
      throw SceneError(medium.placeOf(name),
                       std::string("found '") + first + "' and '" + name + "' in the medium '" + medium.type +
                           "', expected 'sigma_t' and 'albedo', or 'sigma_s' and 'sigma_a', or a 'material'");
    if (name) first = name;
  }
  if (isGiven(medium, "sigma_t") && isGiven(medium, "density"))
    throw SceneError(medium.placeOf("density"), "found 'sigma_t' and 'density' in the medium '" +
                                                    medium.type +
                                                    "', expected one of them: they are the same");
  for (const char* name : {"sigma_s", "sigma_a"})
    if (const Properties* volume = medium.child("volume", name))
      throw SceneError(volume->location, std::string("found a volume for '") + name +
                                             "', expected a number or a colour ('sigma_t' and 'albedo' "
                                             "may be volumes)");
}

// The coefficients that a material or Mitsuba 0.6 names or, in a scene of that version, takes for granted.
MediumCoefficients startOf(const Properties& medium) {
  const bool isOld = isOldHomogeneous(medium);
  medium.declare("material", {.type = "string", .otherwise = "none"});
  const std::string name = medium.string("material", "skin1");
  MediumCoefficients start;
  if (isOld || medium.has("material")) start = measuredMedium(name, medium);
  start.scattering *= kMaterialUnit;
  start.absorption *= kMaterialUnit;
  return start;
}

Rgb ratio(const Rgb& part, const Rgb& all) {
  const auto of = [](float a, float b) { return b > 0 ? a / b : 0.0f; };
  return {of(part.x, all.x), of(part.y, all.y), of(part.z, all.z)};
}

// `g` of the medium itself, which Mitsuba 3 does not know.
void readMeanCosine(const Properties& medium, Builder& builder, Rgb& g) {
  if (!medium.has("g") || (medium.before2 && !isOldHomogeneous(medium))) return;
  const Rgb given = medium.color("g", {-1, 1, false, false}, Rgb(0.0f));
  if (medium.before2)
    g = given;
  else
    builder.warn(medium.placeOf("g"), "'g' of the medium '" + medium.type +
                                          "' is ignored, a <phase type=\"hg\"> nested in it has one");
}

void warnOfEmission(const Properties& medium, Builder& builder) {
  for (const char* name : {"emission", "radiance"}) {
    if (!isGiven(medium, name)) continue;
    medium.child("volume", name);
    if (const auto given = medium.parameters.find(name); given != medium.parameters.end())
      given->second.queried = true;
    builder.warn(medium.placeOf(name), std::string("'") + name + "' of the medium '" + medium.type +
                                           "' is left out: media that shine are not supported");
  }
}

// What Mitsuba 0.6 can't do without.
void requireVolumes(const Properties& medium) {
  if (!medium.before2 || medium.type != "heterogeneous") return;
  if (!isGiven(medium, "density") && !isGiven(medium, "sigma_t"))
    throw SceneError(medium.location, "the medium 'heterogeneous' has no 'density', expected a volume");
  if (!isGiven(medium, "albedo"))
    throw SceneError(medium.location, "the medium 'heterogeneous' has no 'albedo', expected a volume");
}

// In Mitsuba 0.6 the `g` of a medium leaves the phase function as it is, and lessens the scattering instead:
// the similarity relation (Wyman et al. 1989, "Similarity relations for the interaction parameters in
// radiation transport"). Volumes that vary it does not apply to.
void reduceScattering(const Rgb& g, MediumSettings& settings) {
  if (g == Rgb(0.0f) || !settings.extinction->isConstant() || !settings.albedo->isConstant()) return;
  const Rgb all = settings.extinction->greatest(), albedo = settings.albedo->greatest();
  const Rgb scattering = all * albedo * (Rgb(1.0f) - g);
  const Rgb extinction = scattering + all * (Rgb(1.0f) - albedo);
  settings.extinction = std::make_shared<ConstantVolume>(extinction);
  settings.albedo = std::make_shared<ConstantVolume>(ratio(scattering, extinction));
}

void readCoefficients(const Properties& medium, Builder& builder, MediumSettings& settings) {
  MediumCoefficients start = startOf(medium);
  readMeanCosine(medium, builder, start.g);
  const auto read = [&](const char* name, const Rgb& fallback) {
    medium.declare(name, {.type = "colour or number", .range = kCoefficients, .otherwise = "none"});
    return medium.color(name, kCoefficients, fallback);
  };
  const Rgb scattering = read("sigma_s", start.scattering), absorption = read("sigma_a", start.absorption);
  const bool areKnown =
      isOldHomogeneous(medium) || firstOf(medium, {"sigma_s", "sigma_a", "material"}) != nullptr;
  const Rgb extinction = areKnown ? scattering + absorption : Rgb(1.0f);
  const Rgb albedo = areKnown ? ratio(scattering, extinction) : Rgb(0.75f);
  if (medium.type == "heterogeneous")
    medium.declare("density", {.type = kExtinction.type, .range = kCoefficients, .otherwise = "sigma_t"});
  const char* name = isGiven(medium, "density") ? "density" : "sigma_t";
  settings.extinction = builder.volume(medium, name, kExtinction, extinction);
  settings.albedo = builder.volume(medium, "albedo", kAlbedo, albedo);
  reduceScattering(start.g, settings);
}

}  // namespace

MediumSettings readMedium(const Properties& properties, Builder& builder) {
  MediumSettings settings;
  refuseMixtures(properties);
  requireVolumes(properties);
  readCoefficients(properties, builder, settings);
  warnOfEmission(properties, builder);
  settings.scale = properties.number("scale", kCoefficients, 1);
  settings.phase = builder.nestedPhaseFunction(properties);
  settings.samplesEmitters = properties.boolean("sample_emitters", true);
  // It lets Mitsuba leave out work that grey media do not need.
  properties.boolean("has_spectral_extinction", true);
  return settings;
}

}  // namespace odis::render
