// The factories of volumes and phase functions; each is defined, and documented, in the file of its model.
#pragma once

#include "render/scene/builder.h"

namespace odis::render {

VolumePtr makeConstantVolume(const Properties& node, Builder& builder);
VolumePtr makeGridVolume(const Properties& node, Builder& builder);

PhaseFunctionPtr makeBlendPhase(const Properties& node, Builder& builder);
PhaseFunctionPtr makeHenyeyGreenstein(const Properties& node, Builder& builder);
PhaseFunctionPtr makeIsotropic(const Properties& node, Builder& builder);
PhaseFunctionPtr makeRayleigh(const Properties& node, Builder& builder);
PhaseFunctionPtr makeSggx(const Properties& node, Builder& builder);
PhaseFunctionPtr makeTabulated(const Properties& node, Builder& builder);

}  // namespace odis::render
