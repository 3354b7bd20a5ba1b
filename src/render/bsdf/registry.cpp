// Names of the BSDF plugins.
#include <utility>

#include "render/bsdf/factories.h"

namespace odis::render {

namespace {

constexpr std::pair<const char*, BsdfFactory> kFactories[] = {
    {"blendbsdf", makeBlend},
    {"bumpmap", makeBumpMap},
    {"conductor", makeConductor},
    {"dielectric", makeDielectric},
    {"diffuse", makeDiffuse},
    {"mask", makeMask},
    {"normalmap", makeNormalMap},
    {"null", makeNull},
    {"phong", makePhong},
    {"plastic", makePlastic},
    {"principled", makePrincipled},
    {"roughconductor", makeRoughConductor},
    {"roughdielectric", makeRoughDielectric},
    {"roughdiffuse", makeRoughDiffuse},
    {"roughplastic", makeRoughPlastic},
    {"thindielectric", makeThinDielectric},
    {"twosided", makeTwoSided},
};

}  // namespace

BsdfFactory findBsdfFactory(const std::string& type) {
  for (const auto& [name, factory] : kFactories)
    if (type == name) return factory;
  return nullptr;
}

std::vector<std::string> bsdfTypes() {
  std::vector<std::string> types;
  for (const auto& entry : kFactories) types.emplace_back(entry.first);
  return types;
}

}  // namespace odis::render
