// Splitting the variance of several methods on a scene.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/compare.h"
#include "eval/variance_split.h"

namespace odis::eval {

struct AnalyzeSettings {
  std::vector<Method> methods;  // ratios are to the first
  int samples = 16;             // of each pixel and cause
  int imageSpp = 4;             // of the image whose last sample is looked at: how much its guide has learned
  int referenceSpp = 128;       // of the image that variances are relative to
  std::optional<int> maxDepth, rrDepth;  // replace the scene's
  uint64_t seed = 0;
  render::LoadOptions load;
};

struct SceneAnalysis {
  std::string name;
  int width = 0, height = 0;          // of the crop
  std::vector<VarianceSplit> splits;  // of each method; empty if progress was cancelled
};

// All methods draw the same numbers, as far as their paths use the same; the reference is a guided
// rendering of numbers of its own. Throws SceneError, OptionError.
SceneAnalysis analyzeScene(const AnalyzeSettings& settings, const std::string& path,
                           render::Warnings& warnings, render::Progress& progress);

}  // namespace odis::eval
