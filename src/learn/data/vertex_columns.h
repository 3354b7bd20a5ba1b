// Pilot vertices as columns of 16 bits where that is enough: about 75 bytes a vertex, some 40 compressed,
// instead of 176.
#pragma once

#include <odis/path_vertex.h>

#include <array>
#include <span>
#include <string>
#include <vector>

#include "learn/data/shard_file.h"
#include "render/math/vec.h"

namespace odis::learn {

// What the columns of a view are relative to.
struct ViewFrame {
  Float3 origin;   // of the grid of cells
  float edge = 1;  // of its finest cells
  float unit = 1;  // of radiance: the mean luminance of the view
};

// Positions are in steps of the finest cells' edge over this.
inline constexpr int kStepsPerCell = 1024;

// One sample of every pixel of a view.
struct Pilot {
  std::vector<PathVertex> vertices;  // pixel by pixel, along each path
  std::vector<uint8_t> lengths;      // vertices of each pixel's path
  std::vector<float> sampleWeight;   // of each pixel's path (reconstruction filter)
  std::vector<render::Rgb> image;    // what each pixel's path brought, that weight included
};

// A position in steps from the frame's origin, rounded down; back comes the middle of the step.
using PositionSteps = std::array<int32_t, 3>;
PositionSteps stepsOf(const Float3& position, const ViewFrame& frame);
Float3 positionOf(const PositionSteps& steps, const ViewFrame& frame);

// Adds the pilot's arrays, their names beginning with `prefix`.
void addColumns(ShardWriter& writer, const std::string& prefix, const Pilot& pilot, const ViewFrame& frame);
// The pilot of these arrays. Every vertex is as close to what it was as its columns are precise. Throws
// ShardError.
Pilot readColumns(const ShardReader& reader, const std::string& prefix, const ViewFrame& frame);

// A number in 16 bits: as far as a half reaches, infinity and what is not a number as they are.
Half toHalf(float value);
// A unit direction as a point of the equal-area octahedral square, 16 bits either way: to 7e-5.
struct PackedDirection {
  uint16_t x = 0, y = 0;
};
PackedDirection packed(const Float3& direction);
Float3 unpacked(const PackedDirection& direction);

}  // namespace odis::learn
