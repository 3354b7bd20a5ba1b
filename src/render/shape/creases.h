// Shading normals of meshes that are smooth but for their creases.
#pragma once

#include "render/shape/mesh.h"

namespace odis::render {

// Every corner of a triangle becomes a vertex of its own, whose normal is the mean of those of the triangles
// at the same place that lean at most `maxAngle` (radians) from its own triangle, weighted by their angles
// there. Normals of the data are replaced. Where more than 256 triangles meet, they keep their own normals.
MeshData withCreases(const MeshData& data, float maxAngle);

}  // namespace odis::render
