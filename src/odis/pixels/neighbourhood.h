// What the pilot's samples around a pixel tell of the light that arrives there: the input of the network
// that makes a map at a pixel (Bako, Meyer, DeRose and Sen 2019), and the histogram that it is compared with.
#pragma once

#include <span>

#include "odis/maps/histogram.h"
#include "odis/pixels/first_vertices.h"

namespace odis::core {

// The channels of a place's map. Of near and of far samples: energy (radiance / pdf), number and radiance.
enum PixelChannel {
  kNearEnergy,
  kNearCount,
  kNearRadiance,
  kFarEnergy,
  kFarCount,
  kFarRadiance,
  kCosine,    // between the texel and the place's normal
  kNearness,  // extent / (extent + distance), where the extent is how far the place lies from its neighbours
  kPixelChannels
};
inline constexpr int kPixelScalars = 12;

// A place that a map is made for, and the square of pixels around it that is near: those of a tile and of
// kNearMargin pixels around it; what is far goes kFarMargin pixels around the tile. The tile's own pixels
// are left out: a map must not depend on the pilot's samples of pixels that it guides, since a stratifying
// sampler draws their other samples from the same set of points.
struct PixelPlace {
  Float3 position, normal;
  float roughness = 1, albedo = 0;
  int x = 0, y = 0, size = 1;  // the tile: its first column and row, and its width
};
inline constexpr int kNearMargin = 4, kFarMargin = 12;

// What is put together of a neighbourhood. Directions are those from the place to where the samples' light
// came from, in world space.
struct Neighbourhood {
  // Sums over samples, each weighted by how much its surface is like the place's; those over kFarCount and
  // kNearness are of all samples, near ones too, kCosine is 0. Rows and columns of the octahedral square.
  alignas(64) float sums[kMapSize * kMapSize][kPixelChannels];
  float scalars[kPixelScalars];
};
void look(const FirstVertices& vertices, const PixelPlace& place, Neighbourhood& result);

// The input of the network: maps[(row * kMapSize + column) * kPixelChannels + channel], rows and columns of
// the octahedral square, and scalars. None has a unit: neither exposure nor scale matters.
void describe(const Neighbourhood& neighbourhood, const Float3& normal, std::span<float> maps,
              std::span<float> scalars);

// Radiance by the samples alone: near ones count as far as there are enough, else far ones, else all
// directions alike. Sums to 1.
Histogram histogramOf(const Neighbourhood& neighbourhood);

}  // namespace odis::core
