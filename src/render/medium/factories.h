// The factories of media, and the parameters that they share; volumes and phase functions have theirs in
// volume_factories.h.
#pragma once

#include "render/bsdf/parameter.h"
#include "render/medium/medium.h"
#include "render/medium/volume.h"
#include "render/scene/builder.h"

namespace odis::render {

struct MediumSettings {
  VolumePtr extinction, albedo;  // extinction without the scale, 1 / length
  float scale = 1;
  PhaseFunctionPtr phase;
  bool samplesEmitters = true;
};
// Reads what all media have. src/render/medium/settings.cpp
MediumSettings readMedium(const Properties& properties, Builder& builder);

MediumPtr makeHomogeneous(const Properties& properties, Builder& builder);
MediumPtr makeHeterogeneous(const Properties& properties, Builder& builder);

}  // namespace odis::render
