// Sampling maps at pixels, or at tiles of pixels: for the first vertex of each path that may be guided.
#pragma once

#include "odis/pixels/pixel_model.h"
#include "odis/work/progress.h"
#include "odis/work/tasks.h"

namespace odis::core {

// Of a pixel that has no map.
inline constexpr uint32_t kNoMap = ~0u;

// 540 bytes a map and 4 a pixel.
struct PixelMaps {
  // Where a map was made.
  struct Place {
    Float3 position, normal;
  };
  std::vector<Place> places;
  std::vector<uint16_t> texels;   // [map][texel]: relative radiance, at least 1, of 65,535 for the brightest
  std::vector<uint32_t> ofPixel;  // [pixel]: its map, or kNoMap

  size_t size() const { return places.size(); }
  bool empty() const { return places.empty(); }
  // Sets the radiance of a map, and returns it, relative.
  void setRadiance(size_t map, const Histogram& radiance);
  Histogram radiance(size_t map) const;
  uint64_t bytes() const {
    return places.size() * sizeof(Place) + texels.size() * sizeof(uint16_t) +
           ofPixel.size() * sizeof(uint32_t);
  }
};

// Makes a map in each tile of `tile` x `tile` pixels where a path has a first vertex: that of the pixel
// nearest to the tile's middle. A pixel's map is the one of its tile and of the eight tiles around whose
// surface is most like its own.
PixelMaps makePixelMaps(const FirstVertices& vertices, int tile, const PixelModel& model, const Tasks& tasks,
                        const Progress& progress);

// What converged maps would be: histograms of each pixel's own samples. A kilobyte a pixel.
class PixelOracle {
 public:
  PixelOracle(int width, int height, IncidentRadiance radiance)
      : m_width(width), m_height(height), m_radiance(radiance), m_pixels(size_t(width) * size_t(height)) {}

  // What is kept of a pixel.
  struct Pixel {
    Histogram energy{};
    Float3 position, normal;
    float count = 0;
  };

  // Vertices follow each other path by path, those of a path at once. Thread-safe for different pixels.
  void add(ArrayView<const PathVertex> vertices);
  PixelMaps maps(const Tasks& tasks) const;

  const std::vector<Pixel>& pixels() const { return m_pixels; }
  void restore(std::vector<Pixel> pixels) { m_pixels = std::move(pixels); }
  uint64_t bytes() const { return m_pixels.size() * sizeof(Pixel); }

 private:
  int m_width, m_height;
  IncidentRadiance m_radiance;
  std::vector<Pixel> m_pixels;
};

}  // namespace odis::core
