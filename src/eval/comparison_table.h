// What a comparison says: medians over seeds, ratios to the first method, means over scenes.
#pragma once

#include <string>
#include <vector>

#include "eval/compare.h"

namespace odis::eval {

// A method on a scene: medians over its seeds. Ratios are to the first method on the same scene.
struct ComparisonRow {
  std::string scene, method;
  int seeds = 0;
  double error = 0;  // 0.1 %-trimmed relMSE
  double seconds = 0, rays = 0, spp = 0;
  double errorRatio = 1, raysRatio = 1, secondsRatio = 1;
  std::string image;
};

// Rows in the order of the measurements, then one a method for scene "geometric mean" (ratios only) if there
// is more than one scene. The first method is that of the first measurement.
std::vector<ComparisonRow> summarize(const std::vector<Measurement>& measurements);

std::string markdownTable(const std::vector<ComparisonRow>& rows);
std::string jsonText(const std::vector<ComparisonRow>& rows, const std::vector<Measurement>& measurements);

}  // namespace odis::eval
