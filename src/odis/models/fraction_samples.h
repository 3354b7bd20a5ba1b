// What the choice of the BSDF sampling fractions takes from path vertices.
#pragma once

#include <vector>

#include "odis/path_vertex.h"
#include "odis/record/vertex_check.h"

namespace odis::core {

// A vertex that knows its contributions, in 112 bytes. Fields have the names and units of PathVertex's.
struct FractionSample {
  Float3 position, normal, wi, lightDirection;
  float distance;
  float value;  // sampleValue()
  // For a discrete lobe, the guidable part is that of the surface's other lobes.
  float pdf, guidablePdf, guidableProbability;
  float indirect, emission, emissionLightPdf;
  float light, lightPdf, lightBsdfPdf, lightGuidablePdf;
  float roughness, raysAfter;
  uint32_t pixel;
  bool isFirst;   // of its path
  bool isUsable;  // by a cell; others count towards the image alone
  bool discrete, scattersBothSides;
};

// Samples as they lie in memory.
using FractionParts = ArrayView<const ArrayView<const FractionSample>>;

FractionSample fractionSampleOf(const PathVertex& vertex, bool isUsable);

// The choice is made from a quarter of the vertices, within bounds: from one pixel in `stride`, all of its
// path. What is chosen among more vertices is a part of what is chosen among fewer.
uint32_t fractionStride(uint64_t vertices);
bool isForFractions(uint32_t pixel, uint32_t stride);

// Returns those of the chosen pixels whose contributions are known. They are checked against the rules;
// without rules all are usable.
std::vector<FractionSample> takeFractionSamples(ArrayView<const PathVertex> vertices, uint32_t stride,
                                                const VertexRules* rules);

}  // namespace odis::core
