// Writing images: multi-layer EXR with metadata, and PNG for a look.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "render/math/vec.h"

namespace odis::render {

// One channel of an EXR file: "R", "albedo.R", "depth.Z", ... `data` has width * height floats, row 0 at the
// top.
struct ImageChannel {
  std::string name;
  const float* data;
  bool half = false;  // store 16 bits
};

// The part of the full image that the data covers (the crop), in pixels.
struct ImageWindow {
  int fullWidth = 0, fullHeight = 0;
  int x = 0, y = 0, width = 0, height = 0;
};

// Writes one single-part EXR (zip) under a temporary name and renames it, so nothing half-written is left
// behind. Throws WriteError (replace_file.h) with path and reason.
void writeExr(const std::string& path, const ImageWindow& window, const std::vector<ImageChannel>& channels,
              const std::map<std::string, std::string>& metadata);
// Writes an 8-bit sRGB PNG of linear `pixels` (width * height) scaled by 2^exposure, highlights rolled off by
// a filmic curve or clamped. Same guarantees.
enum class ToneMap { clamp, filmic };
void writePng(const std::string& path, int width, int height, const Rgb* pixels, float exposure = 0.0f,
              ToneMap toneMap = ToneMap::filmic);

// A PNG file in memory of 8-bit samples, `channels` (1 to 4) a pixel. Throws std::runtime_error.
std::string encodePng(int width, int height, int channels, const uint8_t* samples);

// Where a channel is in a file: its part and its name there.
struct ExrPlace {
  size_t part = 0;
  std::string name;
};

// Every channel of an EXR as floats. Channels of parts that follow the first have the part's name in front,
// "albedo.R", if they don't have it anyway; parts of another size than the first are left out, and so are
// those with deep pixels. Throws std::runtime_error with path and reason.
struct ExrFile {
  ImageWindow window;
  std::map<std::string, std::vector<float>> channels;
  std::map<std::string, ExrPlace> places;       // of the channels that come from a file
  std::map<std::string, std::string> metadata;  // string attributes of the first part
};
ExrFile readExr(const std::string& path);

}  // namespace odis::render
