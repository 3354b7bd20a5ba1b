// The media, volumes and phase functions that scenes may name.
#include "render/medium/factories.h"
#include "render/medium/volume_factories.h"
#include "render/scene/factory_table.h"

namespace odis::render {

namespace {

constexpr std::pair<const char*, MediumFactory> kMedia[] = {
    {"heterogeneous", makeHeterogeneous},
    {"homogeneous", makeHomogeneous},
};

constexpr std::pair<const char*, VolumeFactory> kVolumes[] = {
    {"constvolume", makeConstantVolume},
    {"gridvolume", makeGridVolume},
};

constexpr std::pair<const char*, PhaseFunctionFactory> kPhaseFunctions[] = {
    {"blendphase", makeBlendPhase}, {"hg", makeHenyeyGreenstein}, {"isotropic", makeIsotropic},
    {"rayleigh", makeRayleigh},     {"sggx", makeSggx},           {"tabphase", makeTabulated},
};

}  // namespace

MediumFactory findMediumFactory(const std::string& type) {
  return findFactory(kMedia, type);
}
VolumeFactory findVolumeFactory(const std::string& type) {
  return findFactory(kVolumes, type);
}
PhaseFunctionFactory findPhaseFunctionFactory(const std::string& type) {
  return findFactory(kPhaseFunctions, type);
}
std::vector<std::string> mediumTypes() {
  return typesIn(kMedia);
}
std::vector<std::string> volumeTypes() {
  return typesIn(kVolumes);
}
std::vector<std::string> phaseFunctionTypes() {
  return typesIn(kPhaseFunctions);
}

}  // namespace odis::render
