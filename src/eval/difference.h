// Where two images differ, as an image and in false colours.
#pragma once

#include <optional>

#include "eval/image_file.h"

namespace odis::eval {

enum class DifferenceKind {
  signedColor,  // A - B
  absolute,     // |A - B|
  // (A - B)^2 / (B^2 + 0.01), both over B's mean luminance, mean of the channels: the summands of relMSE.
  relative,
  flip  // as `flip` in metrics.h
};

// The difference of two images of one size; the last two kinds are grey. Throws std::invalid_argument if
// the sizes differ.
ColorImage difference(const ColorImage& a, const ColorImage& b, DifferenceKind kind);

// How many pixels of two images of one size have other values.
size_t differingPixels(const ColorImage& a, const ColorImage& b);

// The mean of the channels in false colours, linear, to be written without a tone curve: signed ones red
// above zero and blue below, others from black over violet and orange to pale yellow (magma). `full` is
// where the colours end.
ColorImage heatMap(const ColorImage& difference, bool isSigned, double full);

// A good end for the colours: the magnitude that 99 % of the pixels stay below; 1 if that is 0.
double heatMapEnd(const ColorImage& difference);

}  // namespace odis::eval
