// The first vertex of each pixel's pilot path that may be guided: what maps at pixels are made from.
#pragma once

#include <vector>

#include "odis/path_vertex.h"

namespace odis::core {

// Which light a map at a pixel tells of: all that arrives, or what next-event estimation does not cover
// (emission counts with the weight that MIS leaves it).
enum class IncidentRadiance : uint8_t { full, withoutDirect };

// 64 bytes.
struct FirstVertex {
  Float3 position, normal;    // unit shading normal, on the side of the outgoing direction
  Float3 wi;                  // the direction that the path went on in
  float distance = INFINITY;  // to the next vertex; infinity if the ray left the scene
  float radiance = 0;         // luminance that arrives from wi
  float pdf = 0;              // density of wi, times the survival probability; 0: nothing is known of wi
  float roughness = 1;        // alpha of a microfacet distribution, 1 for diffuse
  float albedo = 0;           // an estimate by one sample: f cos / pdf, as luminance, at most 1
  bool there = false;         // whether the path has such a vertex at all
};

// Whether paths are guided at a vertex, if at all: some of its lobes may be.
bool mayBeGuided(const PathVertex& vertex);

// What a first vertex tells.
FirstVertex describeFirst(const PathVertex& vertex, IncidentRadiance kind);

// The first vertices of a rectangle of pixels, row by row.
class FirstVertices {
 public:
  FirstVertices(int width, int height) : m_width(width), m_height(height), m_pixels(size_t(width) * height) {}

  int width() const { return m_width; }
  int height() const { return m_height; }
  const FirstVertex& at(int x, int y) const { return m_pixels[size_t(y) * size_t(m_width) + size_t(x)]; }
  FirstVertex& at(int x, int y) { return m_pixels[size_t(y) * size_t(m_width) + size_t(x)]; }

  // Takes the first vertices of a frame's paths, if they are on surfaces; vertices follow each other path by
  // path, from the camera on.
  // Where a pixel has several samples, the first counts.
  // Thread-safe for different pixels.
  void add(ArrayView<const PathVertex> vertices, IncidentRadiance kind);

  const std::vector<FirstVertex>& pixels() const { return m_pixels; }
  void restore(std::vector<FirstVertex> pixels) { m_pixels = std::move(pixels); }
  uint64_t bytes() const { return m_pixels.size() * sizeof(FirstVertex); }

 private:
  int m_width, m_height;
  std::vector<FirstVertex> m_pixels;
};

}  // namespace odis::core
