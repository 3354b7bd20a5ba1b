// What the choice of the BSDF sampling fractions takes from path vertices.
#pragma once

#include <vector>

#include "odis/cells/batches.h"
#include "odis/files/fields.h"
#include "odis/path_vertex.h"
#include "odis/record/vertex_check.h"

namespace odis::core {

// A vertex that knows its contributions, in 120 bytes. Fields have the names and units of PathVertex's.
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
  uint32_t lightGroup;
  float lightGroupProbability;
  bool isFirst;   // of its path
  bool isUsable;  // by a cell; others count towards the image alone
  bool discrete, scattersBothSides;
};

template <class Body>
constexpr void forEachField(FieldsOf<FractionSample>, const Body& body) {
  body("position", &FractionSample::position);
  body("normal", &FractionSample::normal);
  body("wi", &FractionSample::wi);
  body("lightDirection", &FractionSample::lightDirection);
  body("distance", &FractionSample::distance);
  body("value", &FractionSample::value);
  body("pdf", &FractionSample::pdf);
  body("guidablePdf", &FractionSample::guidablePdf);
  body("guidableProbability", &FractionSample::guidableProbability);
  body("indirect", &FractionSample::indirect);
  body("emission", &FractionSample::emission);
  body("emissionLightPdf", &FractionSample::emissionLightPdf);
  body("light", &FractionSample::light);
  body("lightPdf", &FractionSample::lightPdf);
  body("lightBsdfPdf", &FractionSample::lightBsdfPdf);
  body("lightGuidablePdf", &FractionSample::lightGuidablePdf);
  body("roughness", &FractionSample::roughness);
  body("raysAfter", &FractionSample::raysAfter);
  body("pixel", &FractionSample::pixel);
  body("lightGroup", &FractionSample::lightGroup);
  body("lightGroupProbability", &FractionSample::lightGroupProbability);
  body("isFirst", &FractionSample::isFirst);
  body("isUsable", &FractionSample::isUsable);
  body("discrete", &FractionSample::discrete);
  body("scattersBothSides", &FractionSample::scattersBothSides);
}
static_assert(listedBytes<FractionSample>() == sizeof(FractionSample));

// Samples as they lie in memory.
using FractionParts = ArrayView<const ArrayView<const FractionSample>>;

FractionSample fractionSampleOf(const PathVertex& vertex, bool isUsable);

// The choice is made from a quarter of the vertices, within bounds: from one pixel in `stride`, all of its
// path. What is chosen among more vertices is a part of what is chosen among fewer.
uint32_t fractionStride(uint64_t vertices);
bool isForFractions(uint32_t pixel, uint32_t stride);

// Returns those of the chosen pixels whose contributions are known. They are checked against the rules;
// without rules all are usable.
std::vector<FractionSample> takeFractionSamples(const VertexBatch& vertices, uint32_t stride,
                                                const VertexRules* rules);

// Leaves those that `stride` chooses.
void narrow(std::vector<FractionSample>& samples, uint32_t stride);

// What is kept of all unguided vertices that came: 250,000 samples at most, and room for a quarter more.
struct FractionSamples {
  uint64_t seen = 0;  // vertices that they were chosen from
  std::vector<FractionSample> samples;

  void makeRoom(size_t more);
  // Lets go of samples, for so many more vertices were seen.
  void see(uint64_t vertices) {
    seen += vertices;
    narrow(samples, fractionStride(seen));
  }
  uint64_t bytes() const { return samples.capacity() * sizeof(FractionSample); }
};

}  // namespace odis::core
