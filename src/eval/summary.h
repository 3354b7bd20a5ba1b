// What a comparison says: medians over seeds, ratios to the first method, means over scenes.
#pragma once

#include <string>
#include <vector>

#include "eval/bootstrap.h"
#include "eval/measurement.h"
#include "eval/samples_needed.h"

namespace odis::eval {

// A method on a scene with a number of samples: medians over its seeds. Ratios are to the first method with
// the same `spp` on the same scene, denoised or not likewise; "error" there is the 0.1 %-trimmed relMSE,
// "time" that of the process on all cores.
struct ComparisonRow {
  std::string scene, method;
  int spp = 0;
  bool equalTime = false;
  bool denoised = false;
  int seeds = 0;
  ErrorMetrics error;
  double seconds = 0, cpuSeconds = 0, rays = 0, samples = 0;
  // The luminance of the image over that of the reference: the mean over seeds.
  Interval mean;
  // `untrimmedRatio` is of relMSE of all pixels, mean over seeds: it shows fireflies, which the others leave
  // out.
  Interval errorRatio, untrimmedRatio, errorTimeRatio, errorRaysRatio;
  double cpuSecondsRatio = 1, raysRatio = 1;
  SamplesNeeded needed;  // by the first method for the same error
  std::string image;     // of seed 0
  // At equal time: which row has the same images, as "4 spp" or "time of 4"; "" if none has.
  std::string sameAs;

  bool isMean() const { return scene == kAllScenes; }
  static constexpr const char* kAllScenes = "geometric mean";
};

// Rows in the order of the measurements, then those of scene "geometric mean" (ratios only) if there is more
// than one scene. The first method is that of the first measurement.
std::vector<ComparisonRow> summarize(const std::vector<Measurement>& measurements);

}  // namespace odis::eval
