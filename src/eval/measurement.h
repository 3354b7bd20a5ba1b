// One rendering of a comparison, measured.
#pragma once

#include <cstdint>
#include <string>

#include "eval/metrics.h"

namespace odis::eval {

struct Measurement {
  std::string scene, method;
  int spp = 0;             // samples per pixel asked for; at equal time: those of the first method
  bool equalTime = false;  // as many samples as fitted in the time that the first method took for `spp`
  bool denoised = false;   // what was rendered, after the denoiser
  uint64_t seed = 0;
  std::string key;  // hash of everything that the result depends on
  ErrorMetrics error;
  double seconds = 0;     // of the wall clock: pilot, building the guide, guided samples, denoising
  double cpuSeconds = 0;  // of the process on all cores
  double samples = 0;     // per pixel, really taken
  uint64_t rays = 0;      // shadow rays included
  std::string image;      // the EXR in the comparison's folder, "" if none was written
};

}  // namespace odis::eval
