// The images that a rendering leaves.
#pragma once

#include <vector>

#include "render/math/vec.h"

namespace odis::render {

// Per-pixel images of the crop window, row 0 at the top.
struct RenderedImage {
  int x = 0, y = 0, width = 0, height = 0;  // the crop, in pixels of the full image
  std::vector<Rgb> color;
  std::vector<Rgb> noisy;     // the colour before it was denoised; empty unless it was
  std::vector<Rgb> variance;  // of the pixel's mean; empty unless asked for
  std::vector<Rgb> albedo;    // features at the first non-delta vertex; empty unless asked for
  std::vector<Vec3> normal, geometricNormal, position;
  std::vector<float> depth, roughness;
  // The share of the pixel in which the camera sees surfaces, lights or the surroundings; like Mitsuba's,
  // colours are multiplied by it already. Empty unless features are asked for.
  std::vector<float> alpha;
  // What the guide has decided at that vertex: BSDF sampling fraction, entropy of the map in bits,
  // survival, cell; and the number of the pixel's samples. Empty unless asked for.
  std::vector<float> guideBsdfFraction, guideEntropy, guideSurvival, guideCell, guideSamples;
};

}  // namespace odis::render
