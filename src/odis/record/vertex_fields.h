// The fields of OdisPathVertex and OdisPathVertices, by name.
#pragma once

#include "odis/files/fields.h"
#include "odis/path_vertex.h"

// Calls FIELD(name) for each of them, in the order in which they lie in memory.
// clang-format off
#define ODIS_VERTEX_FIELDS(FIELD)                                                                   \
  FIELD(position) FIELD(normal) FIELD(wo) FIELD(wi) FIELD(radiance) FIELD(weight) FIELD(direct)     \
  FIELD(pdf) FIELD(survival) FIELD(guidablePdf) FIELD(guidableProbability) FIELD(distance)          \
  FIELD(roughness) FIELD(cosine) FIELD(indirect) FIELD(emission) FIELD(emissionLightPdf)            \
  FIELD(light) FIELD(lightDirection) FIELD(lightPdf) FIELD(lightBsdfPdf) FIELD(lightGuidablePdf)    \
  FIELD(raysAfter) FIELD(lightGroupProbability) FIELD(lightGroup) FIELD(lightableGroups)            \
  FIELD(sampleWeight) FIELD(time) FIELD(pixel) FIELD(sample) FIELD(depth) FIELD(discrete)           \
  FIELD(scattersBothSides)
// clang-format on

namespace odis::core {

template <class Body>
constexpr void forEachField(FieldsOf<PathVertex>, const Body& body) {
#define ODIS_FIELD(NAME) body(#NAME, &PathVertex::NAME);
  ODIS_VERTEX_FIELDS(ODIS_FIELD)
#undef ODIS_FIELD
}
static_assert(listedBytes<PathVertex>() == sizeof(PathVertex));

template <class Body>
constexpr void forEachField(FieldsOf<VertexCounts>, const Body& body) {
  body("accepted", &VertexCounts::accepted);
  body("discrete", &VertexCounts::discrete);
  body("notFinite", &VertexCounts::notFinite);
  body("noDensity", &VertexCounts::noDensity);
  body("notUnit", &VertexCounts::notUnit);
  body("noDepth", &VertexCounts::noDepth);
  body("outsideFrame", &VertexCounts::outsideFrame);
  body("wrongSide", &VertexCounts::wrongSide);
  body("outOfRange", &VertexCounts::outOfRange);
  body("guidableAbovePdf", &VertexCounts::guidableAbovePdf);
  body("unknownLights", &VertexCounts::unknownLights);
  body("twice", &VertexCounts::twice);
  body("inMedia", &VertexCounts::inMedia);
}
static_assert(listedBytes<VertexCounts>() + sizeof(VertexCounts::size) == sizeof(VertexCounts));

}  // namespace odis::core
