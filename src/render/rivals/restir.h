// Spatial resampling of indirect light within a frame: ReSTIR GI (Ouyang, Liu, Kettunen, Pharr and Pantaleoni
// 2021, "ReSTIR GI: Path Resampling for Real-Time Path Tracing") in its unbiased form, with the pairwise MIS
// weights of Lin et al. 2022, "Generalized Resampled Importance Sampling" (after Bitterli 2022).
#pragma once

#include <functional>

#include "render/integrator/pass.h"
#include "render/rivals/restir_options.h"

namespace odis::render {

// One frame: sample number `sample` of every pixel, added to `image`. Nothing is added if `stop` answers true
// before it is done. Returns the rays traced.
RayCounts renderRestirFrame(const Pass& pass, const RestirOptions& options, uint32_t sample,
                            Progress& progress, const std::function<bool()>& stop);

}  // namespace odis::render
