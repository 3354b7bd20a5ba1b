// The integrator and the sampler of scene files.
#pragma once

#include "render/scene/scene.h"
#include "render/xml/properties.h"

namespace odis::render {

// Path depths of an integrator of any type and the number of samples of any sampler; each may be null.
IntegratorSettings loadIntegrator(const Properties* integrator, const Properties* sampler,
                                  Warnings& warnings);

}  // namespace odis::render
