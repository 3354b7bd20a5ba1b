// What the random numbers of a path are for. Every purpose has a dimension of its own, so that the numbers
// for some can be drawn anew while all others stay as they are.
#pragma once

#include <algorithm>
#include <cstdint>

namespace odis::render {

// Each vertex of a path has so many dimensions; the camera is vertex 0.
inline constexpr uint32_t kDimensionsPerVertex = 8;

// What the numbers of a camera ray are for: their dimensions.
enum CameraNumber : uint32_t {
  kPixelNumber = 1,  // where in the pixel: two
  kLensNumber,       // through which point of the lens: two
  kTimeNumber,       // when
};

// What the numbers of a vertex are for, in the order of their dimensions.
enum VertexNumber : uint32_t {
  kFlightNumber = 0,       // how far the ray that leads there gets through a medium; and, independent ones,
  kStreamNumber = 0,       // all that media ask for beside it
  kLightChoiceNumber = 1,  // which light
  kLightPointNumber,       // which point or direction of it: two
  kLobeNumber,             // which lobe of the BSDF
  kDirectionNumber,        // whither the path goes on: two
  kSurvivalNumber,         // whether it does
  kShadowRayNumber,        // whether the light is asked for
};

// The dimension of a number at the vertex of this depth, which is 1 for the first vertex.
inline constexpr uint32_t dimensionOf(int depth, VertexNumber number) {
  return kDimensionsPerVertex * uint32_t(depth) + number;
}

// A set of purposes, a bit each. The camera and the first vertex have bits of their own, all later vertices
// share theirs.
using Purposes = uint32_t;

// Where in the pixel, through which point of the lens, and when.
inline constexpr Purposes kPixelAndLens = 1u << kPixelNumber | 1u << kLensNumber | 1u << kTimeNumber;
// Next-event estimation at the first vertex: which light, and which point or direction of it.
inline constexpr Purposes kFirstLightChoice = 1u << dimensionOf(1, kLightChoiceNumber);
inline constexpr Purposes kFirstLightPoint = 1u << dimensionOf(1, kLightPointNumber);
// Where the path goes on: which lobe, BSDF or map, whither.
inline constexpr Purposes kFirstDirection =
    1u << dimensionOf(1, kLobeNumber) | 1u << dimensionOf(1, kDirectionNumber);
// Whether it does, decided here or where it arrives; whether the light is asked for.
inline constexpr Purposes kFirstSurvival =
    1u << dimensionOf(1, kSurvivalNumber) | 1u << dimensionOf(1, kShadowRayNumber);
// The same at all vertices but the first.
inline constexpr Purposes kLaterLightChoice = kFirstLightChoice << kDimensionsPerVertex;
inline constexpr Purposes kLaterLightPoint = kFirstLightPoint << kDimensionsPerVertex;
inline constexpr Purposes kLaterDirection = kFirstDirection << kDimensionsPerVertex;
inline constexpr Purposes kLaterSurvival = kFirstSurvival << kDimensionsPerVertex;
inline constexpr Purposes kAllPurposes = ~0u;

// Whether the number of a dimension, which counts from 1, is for one of the purposes.
inline uint32_t isFor(Purposes purposes, uint32_t dimension) {
  constexpr uint32_t kLater = 2 * kDimensionsPerVertex;
  return purposes >> std::min(dimension, kLater | (dimension & (kDimensionsPerVertex - 1))) & 1u;
}

}  // namespace odis::render
