// A volume of values on a grid; see gridvolume.cpp for its parameters.
#pragma once

#include "render/medium/volume.h"
#include "render/medium/volume_file.h"
#include "render/texture/wrap_mode.h"

namespace odis::render {

struct GridOptions {
  WrapMode wrap = WrapMode::clamp;  // repeat, clamp or mirror
  bool nearest = false;             // else trilinear
  // Whether the first and the last value along an axis lie on the border of the unit cube, as in Mitsuba 0.6;
  // else the cube is cut into voxels, and values lie at their centres.
  bool onBorder = false;
  Imath::M44d toUnitCube;  // from world space
};

// Keeps the values in the precision of the file.
VolumePtr makeGrid(VolumeFile file, const GridOptions& options);

}  // namespace odis::render
