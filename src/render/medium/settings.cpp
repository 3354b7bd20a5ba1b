// The parameters that media share.
#include "render/medium/constant_volume.h"
#include "render/medium/factories.h"

namespace odis::render {
namespace {

constexpr NumberRange kCoefficients = between(0, 1e15);
constexpr Declaration kExtinction{"volume, number or colour", kCoefficients},
    kAlbedo{"volume, number or colour", kUnit};

// Mitsuba 0.6 tells scattering and absorption apart; where it names extinction, what is not scattered is
// absorbed.
void readCoefficients(const Properties& properties, MediumSettings& settings) {
  const Rgb scattering = properties.color("sigma_s", kCoefficients, Rgb(0.0f));
  const Rgb absorption = properties.color("sigma_a", kCoefficients, Rgb(0.0f));
  const Rgb extinction = scattering + absorption;
  const auto share = [](float part, float all) { return all > 0 ? part / all : 0.0f; };
  settings.extinction = std::make_shared<ConstantVolume>(extinction);
  settings.albedo = std::make_shared<ConstantVolume>(Rgb(share(scattering.x, extinction.x),
                                                         share(scattering.y, extinction.y),
                                                         share(scattering.z, extinction.z)));
}

}  // namespace

MediumSettings readMedium(const Properties& properties, Builder& builder) {
  MediumSettings settings;
  if (properties.has("sigma_s") || properties.has("sigma_a")) {
    readCoefficients(properties, settings);
  } else {
    const char* extinction = properties.child("volume", "density") ? "density" : "sigma_t";
    settings.extinction = builder.volume(properties, extinction, kExtinction, Rgb(1.0f));
    settings.albedo = builder.volume(properties, "albedo", kAlbedo, Rgb(0.75f));
  }
  settings.scale = properties.number("scale", kCoefficients, 1);
  settings.phase = builder.nestedPhaseFunction(properties);
  settings.samplesEmitters = properties.boolean("sample_emitters", true);
  // It lets Mitsuba leave out work that grey media do not need.
  properties.boolean("has_spectral_extinction", true);
  return settings;
}

}  // namespace odis::render
