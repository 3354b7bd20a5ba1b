// Which channels of an image file are the colours, albedo and normals that a denoiser takes: renderers name them
// differently.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/layers.h"

namespace odis::eval {

// The names of layers, "" for the one without a name.
struct DenoiserLayers {
  std::string color;
  std::optional<std::string> albedo, normal;
};

// Finds them by their names, whatever their case and whatever view layer stands before them:
//   colour   noisy (ODIS), Noisy Image (Cycles), the one without a name, Combined (Blender)
//   albedo   Denoising Albedo (Cycles), albedo (ODIS, Mitsuba's `aov`, pbrt)
//   normal   Denoising Normal (Cycles), Ns (pbrt), sh_normal, nn (Mitsuba's manual), normal, N (ODIS, Blender)
// The first of each list that is there is taken. Throws ImageError where there is no colour.
DenoiserLayers findDenoiserLayers(const LayeredImage& image);

// The layer of the albedo or of the normals alone, for files that hold only that: as above, else the one without a
// name. Throws ImageError.
std::string findAlbedoLayer(const LayeredImage& image);
std::string findNormalLayer(const LayeredImage& image);

// Whether two images cover the same pixels; the text says how they differ, "" if they don't.
std::string windowDifference(const LayeredImage& a, const LayeredImage& b);

}  // namespace odis::eval
