// What a host pays at a vertex that traces one path at a time (odis::GuidedVertex).
#pragma once

#include "render/integrators/pilot_pass.h"

namespace odis::eval {

// Nanoseconds of a core, in the mean over the vertices of a pilot, path by path.
struct VertexCosts {
  double lookUp = 0;     // finding the cell
  double prepare = 0;    // of the map, where directions are guided
  double pdf = 0;        // of a direction
  double direction = 0;  // drawing one and asking for its density
  double guided = 0;     // share of the vertices where directions are guided
};

// Zeros if the pilot has no vertices to learn from.
VertexCosts vertexCosts(const render::PilotPass& pilot, int rounds);

}  // namespace odis::eval
