// Spatial resampling of indirect light within a frame: ReSTIR GI (Ouyang, Liu, Kettunen, Pharr and Pantaleoni
// 2021, "ReSTIR GI: Path Resampling for Real-Time Path Tracing") in its unbiased form, with the pairwise MIS
// weights of Lin et al. 2022, "Generalized Resampled Importance Sampling" (after Bitterli 2022).
#pragma once

#include <functional>

#include "render/path/pass.h"
#include "render/rivals/restir_options.h"

namespace odis::render {

struct RestirSetting {
  const Pass& pass;
  const RestirOptions& options;
  std::vector<PixelSums>& image;  // that frames are added to
  SplatFilm* film;                // likewise; null unless it splats
};

// Renders one frame: sample number `sample` of every pixel. Nothing is added if `stop` answers true
// before it is done. Returns the rays traced.
RayCounts renderRestirFrame(const RestirSetting& setting, uint32_t sample, Progress& progress,
                            const std::function<bool()>& stop);

}  // namespace odis::render
