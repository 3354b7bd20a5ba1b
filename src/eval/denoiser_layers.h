// Finds the layers of an image file that hold its colours, and the albedo and normals that a denoiser takes:
// renderers name them differently.
#pragma once

#include <optional>
#include <string>

#include "eval/layers.h"

namespace odis::eval {

// Found by their names, whatever their case and whatever view layer stands before them. The first of a list
// that is there is taken; nothing if none is.

// The image as it is to be seen: the layer without a name, Combined (Blender), or the only one with R, G and
// B.
std::optional<std::string> findImageLayer(const LayeredImage& image);
// What a denoiser takes: noisy (ODIS), Noisy Image (Cycles), the one without a name, Combined (Blender).
std::optional<std::string> findColorLayer(const LayeredImage& image);
// Denoising Albedo (Cycles), albedo (ODIS, Mitsuba's `aov`, pbrt).
std::optional<std::string> findAlbedoLayer(const LayeredImage& image);
// Denoising Normal (Cycles), Ns (pbrt), sh_normal, nn (Mitsuba's manual), normal (Blender), N (ODIS).
std::optional<std::string> findNormalLayer(const LayeredImage& image);

// Where the denoised colours of a layer go, in names of the file's part.
struct DenoisedPlace {
  size_t part = 0;
  std::string layer;  // "" or "ViewLayer.Combined.": the one that viewers and compositors show
  std::string kept;   // "noisy.": the one that takes the colours as they were; empty where they have one
};

// In place of the layer's own colours; those of a layer that is called noisy go where they are shown, beside
// it.
DenoisedPlace findDenoisedPlace(const LayeredImage& image, const std::string& layer);

}  // namespace odis::eval
