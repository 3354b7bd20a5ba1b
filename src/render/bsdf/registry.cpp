// Names of the BSDF plugins.
#include "render/bsdf/factories.h"
#include "render/scene/factory_table.h"

namespace odis::render {

namespace {

constexpr std::pair<const char*, BsdfFactory> kFactories[] = {
    {"blendbsdf", makeBlend},
    {"bumpmap", makeBumpMap},
    {"circular", makeCircularPolarizer},
    {"coating", makeCoating},
    {"conductor", makeConductor},
    {"dielectric", makeDielectric},
    {"diffuse", makeDiffuse},
    {"hair", makeHair},
    {"mask", makeMask},
    {"measured", makeMeasured},
    {"measured_polarized", makeMeasuredPolarized},
    {"normalmap", makeNormalMap},
    {"null", makeNull},
    {"phong", makePhong},
    {"plastic", makePlastic},
    {"polarizer", makePolarizer},
    {"pplastic", makePolarizedPlastic},
    {"principled", makePrincipled},
    {"principledthin", makePrincipledThin},
    {"retarder", makeRetarder},
    {"roughcoating", makeRoughCoating},
    {"roughconductor", makeRoughConductor},
    {"roughdielectric", makeRoughDielectric},
    {"roughdiffuse", makeRoughDiffuse},
    {"roughplastic", makeRoughPlastic},
    {"thindielectric", makeThinDielectric},
    {"twosided", makeTwoSided},
    {"ward", makeWard},
};

}  // namespace

BsdfFactory findBsdfFactory(const std::string& type) {
  return findFactory(kFactories, type);
}
std::vector<std::string> bsdfTypes() {
  return typesIn(kFactories);
}

}  // namespace odis::render
