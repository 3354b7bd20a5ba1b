// Where the variance of one sample per pixel comes from: its split by the random decisions of a path.
//
// A path is a function f of independent random numbers, each with a purpose. With f_S the same path but for
// the numbers of a set S of purposes, which are drawn anew, the total index of S is
//   T_S = E[(f - f_S)^2] / 2 = E[Var(f | all numbers but those of S)],
// the part of the variance V that goes away if S is integrated perfectly and all else stays (Jansen 1999,
// "Analysis of variance designs for model output"; Sobol' 1993, "Sensitivity estimates for nonlinear
// mathematical models"; Saltelli et al. 2010, "Variance based sensitivity analysis of model output").
// Shares T_S / V add up to more than one where causes act together.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "eval/image_file.h"
#include "render/integrators/render.h"
#include "render/sampler/purposes.h"

namespace odis::eval {

// A reason for variance, or several of them together.
struct Cause {
  std::string name, column;  // in full, and as short as a table needs
  render::Purposes purposes = 0;
  bool emission = false;  // only what of the sample the camera ray met directly
};
const std::vector<Cause>& causes();

// An estimate and its standard error.
struct Estimated {
  double value = 0, error = 0;
};

// Everything in units of relMSE (metrics.h): per pixel and channel over R^2 + epsilon, images scaled as
// there, summed over the pixels but for those 0.1 % that have the largest of any figure here.
struct VarianceSplit {
  Estimated variance;             // V of one sample per pixel, by numbers that were all drawn anew
  std::vector<Estimated> shares;  // T_S / V in the order of causes(); zero where there is no variance
  double raysPerSample = 0;       // shadow rays included
  // Estimates for each pixel, all of them: V, and T_S in the order of causes().
  std::vector<float> varianceMap;
  std::vector<std::vector<float>> maps;
};

// Splits the variance of the last sample of `options`, as render::renderSamples takes it. It is estimated
// from `samples` samples of each pixel and as many more for each cause. Standard errors are jackknifed over
// samples (for this guide and these pixels). Empty if progress is cancelled. Throws OptionError,
// std::invalid_argument.
VarianceSplit splitVariance(const render::Scene& scene, const render::RenderOptions& options,
                            const ColorImage& reference, int samples, render::Progress& progress);

// How large one estimate is relative to another that is independent of it.
Estimated ratio(const Estimated& a, const Estimated& b);

}  // namespace odis::eval
