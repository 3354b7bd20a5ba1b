// path: plain path tracing with next-event estimation, multiple importance sampling and Russian roulette by
// throughput. What every other integrator is compared with.
#include "render/integrators/frame_integrator.h"

namespace odis::render {

std::unique_ptr<Integrator> makePathIntegrator(RenderJob& job) {
  return std::make_unique<FrameIntegrator>(job, frameOptions(job).set("guided=off"));
}

}  // namespace odis::render
