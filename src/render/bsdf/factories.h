// The factories of all BSDF plugins; each is defined, and documented, in the file of its model.
#pragma once

#include "render/scene/builder.h"

namespace odis::render {

BsdfPtr makeBlend(const Properties& properties, Builder& builder);
BsdfPtr makeBumpMap(const Properties& properties, Builder& builder);
BsdfPtr makeCircularPolarizer(const Properties& properties, Builder& builder);
BsdfPtr makeCoating(const Properties& properties, Builder& builder);
BsdfPtr makeConductor(const Properties& properties, Builder& builder);
BsdfPtr makeDielectric(const Properties& properties, Builder& builder);
BsdfPtr makeDiffuse(const Properties& properties, Builder& builder);
BsdfPtr makeHair(const Properties& properties, Builder& builder);
BsdfPtr makeMask(const Properties& properties, Builder& builder);
BsdfPtr makeMeasured(const Properties& properties, Builder& builder);
BsdfPtr makeMeasuredPolarized(const Properties& properties, Builder& builder);
BsdfPtr makeNormalMap(const Properties& properties, Builder& builder);
BsdfPtr makeNull(const Properties& properties, Builder& builder);
BsdfPtr makePhong(const Properties& properties, Builder& builder);
BsdfPtr makePlastic(const Properties& properties, Builder& builder);
BsdfPtr makePolarizedPlastic(const Properties& properties, Builder& builder);
BsdfPtr makePolarizer(const Properties& properties, Builder& builder);
BsdfPtr makePrincipled(const Properties& properties, Builder& builder);
BsdfPtr makePrincipledThin(const Properties& properties, Builder& builder);
BsdfPtr makeRetarder(const Properties& properties, Builder& builder);
BsdfPtr makeRoughCoating(const Properties& properties, Builder& builder);
BsdfPtr makeRoughConductor(const Properties& properties, Builder& builder);
BsdfPtr makeRoughDielectric(const Properties& properties, Builder& builder);
BsdfPtr makeRoughDiffuse(const Properties& properties, Builder& builder);
BsdfPtr makeRoughPlastic(const Properties& properties, Builder& builder);
BsdfPtr makeThinDielectric(const Properties& properties, Builder& builder);
BsdfPtr makeTwoSided(const Properties& properties, Builder& builder);
BsdfPtr makeWard(const Properties& properties, Builder& builder);

}  // namespace odis::render
