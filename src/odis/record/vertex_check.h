// Counts path vertices by what can be learned from them, and says what stands in for optional fields that
// the host left out.
#pragma once

#include "odis/path_vertex.h"

namespace odis::core {

// What vertices are checked against beside their own numbers.
struct VertexRules {
  uint32_t lightGroups = 0;  // that there are; 0: groups are not looked at
  bool unguided = false;     // whether all directions were drawn from the BSDF alone
};
using odis::checkNumbers;
using odis::checkVertex;
// The state of a vertex, of whichever lobe `wi` is, and the same for one that directions are learned from.
VertexState checkNumbers(const PathVertex& vertex, const VertexRules& rules);
VertexState checkVertex(const PathVertex& vertex, const VertexRules& rules);

void countVertex(VertexCounts& counts, const PathVertex& vertex, VertexState state);
void addCounts(VertexCounts& counts, const VertexCounts& other);

// |cos| between wi and the normal; 1 in media.
float cosineOf(const PathVertex& vertex);

// The part of the vertex's pdf that comes from lobes that may be guided, and how often the BSDF draws from
// them.
struct GuidablePart {
  float pdf, probability;
};
GuidablePart guidablePartOf(const PathVertex& vertex);

// Whether it is known what the vertex adds to its pixel, and for how many rays.
bool knowsContributions(const PathVertex& vertex);

}  // namespace odis::core
