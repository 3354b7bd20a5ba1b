// Images with all their layers, and what one does with several of them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "eval/image_file.h"
#include "render/image/write.h"

namespace odis::eval {

using LayeredImage = render::ExrFile;

// What a channel holds; extremes and mean are of its finite values.
struct ChannelSummary {
  double least = 0, most = 0, mean = 0;
  uint64_t nonFinite = 0;
};
ChannelSummary summarizeChannel(const std::vector<float>& values);

// R, G and B of the layer, "" for the one without a name; a single channel (Y, Z or the like) as grey, X Y
// Z as it is. Throws ImageError that lists the layers there are.
ColorImage layerColor(const LayeredImage& image, const std::string& layer);
// The names of layers, "" first if there is one without a name.
std::vector<std::string> layerNames(const LayeredImage& image);

// The mean of each channel that all images have. variance.* and stderr.*, which belong to the mean of a
// pixel, become those of the mean of independent images. The metadata is the first one's. Throws ImageError
// if sizes or crops differ, std::invalid_argument if there are none.
LayeredImage average(const std::vector<LayeredImage>& images);

// All channels in one image; those of an image with a name get it in front: "odis" and "R" make "odis.R". The
// metadata is the first one's. Throws ImageError if sizes or crops differ, or if a channel comes twice.
LayeredImage merge(const std::vector<std::pair<std::string, LayeredImage>>& images);

// Throws WriteError.
void writeLayered(const std::string& path, const LayeredImage& image);

}  // namespace odis::eval
