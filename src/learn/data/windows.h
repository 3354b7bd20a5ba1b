// Windows: small squares of an image where every pixel has pilots, and some pixels have targets. What a data
// set of incident radiance is made of.
#pragma once

#include "learn/data/targets.h"

namespace odis::learn {

struct WindowSettings {
  int count = 0;   // of windows; 0: the data set is one of cells
  int size = 32;   // pixels a side
  int middle = 8;  // targets lie in a square of so many pixels a side in the middle
  int leastPixels = 57600, mostPixels = 921600;  // of the image that they are cut out of
};

struct Window {
  int x = 0, y = 0;  // first column and row
};

// Where windows lie in an image, rarely over each other; fewer than asked for where the image is too small.
std::vector<Window> placeWindows(int width, int height, const WindowSettings& settings, uint64_t seed);

// All of a view that is cut out of an image.
struct WindowView {
  std::vector<Window> windows;
  std::vector<Pilot> pilots;
  ViewFrame frame;
  std::vector<Target> targets;     // whose maps have kWindowMapTexels texels
  std::vector<uint16_t> windowOf;  // [target]
  // [target]: the standard error of the map of all that arrives, over the map, as norms of vectors of texels.
  std::vector<float> noise;
  // Means and variances over the pilots' samples, which features are free of noise in: [window][row][column].
  struct Pixel {
    render::Rgb albedo{0, 0, 0}, albedoVariance{0, 0, 0};
    render::Vec3 normal{0, 0, 0}, normalVariance{0, 0, 0};
    float depth = 0, depthVariance = 0, roughness = 0, roughnessVariance = 0;
    uint8_t hits = 0;  // samples that met a surface
  };
  std::vector<Pixel> pixels;
};
WindowView traceWindows(const render::Scene& scene, const render::LightSampler& lights,
                        const WindowSettings& windows, const TargetSettings& targets, int pilots,
                        uint64_t seed);

// Folds maps of kTargetSize texels a side to kWindowMapSize: means over all samples of the texels.
void foldMaps(Target& target);

// Adds all arrays of a view, whose number it is.
void addColumns(ShardWriter& writer, size_t view, const WindowView& content, int size);
// What the names of a view's arrays of windows begin with.
std::string windowPrefix(size_t view);

}  // namespace odis::learn
