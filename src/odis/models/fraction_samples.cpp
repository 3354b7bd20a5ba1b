#include "odis/models/fraction_samples.h"

#include <algorithm>

#include "odis/cells/samples.h"

namespace odis::core {

FractionSample fractionSampleOf(const PathVertex& v, bool isUsable) {
  const GuidablePart guidable = guidablePartOf(v);
  return {.position = v.position,
          .normal = v.normal,
          .wi = v.wi,
          .lightDirection = v.lightDirection,
          .distance = v.distance,
          .value = sampleValue(v),
          .pdf = v.pdf,
          .guidablePdf = guidable.pdf,
          .guidableProbability = guidable.probability,
          .indirect = v.indirect,
          .emission = v.emission,
          .emissionLightPdf = v.emissionLightPdf,
          .light = v.light,
          .lightPdf = v.lightPdf,
          .lightBsdfPdf = v.lightBsdfPdf,
          .lightGuidablePdf = v.lightGuidablePdf,
          .roughness = v.roughness,
          .raysAfter = v.raysAfter,
          .pixel = v.pixel,
          .lightGroup = v.lightGroup,
          .lightGroupProbability = v.lightGroupProbability,
          .isFirst = v.depth == 1,
          .isUsable = isUsable,
          .discrete = v.discrete,
          .scattersBothSides = v.scattersBothSides};
}

uint32_t fractionStride(uint64_t vertices) {
  constexpr uint64_t kShare = 4, kFewest = 50000, kMost = 200000;
  return uint32_t(std::max<uint64_t>(1, vertices / std::clamp(vertices / kShare, kFewest, kMost)));
}

bool isForFractions(uint32_t pixel, uint32_t stride) {
  constexpr uint32_t kGolden = 0x9e3779b9u;  // 2^32 over the golden ratio spreads pixels evenly
  return uint64_t(pixel * kGolden) * stride < (uint64_t(1) << 32);
}

std::vector<FractionSample> takeFractionSamples(const VertexBatch& vertices, uint32_t stride,
                                                const VertexRules* rules) {
  const auto isUsable = [rules](const PathVertex& v) {
    return !rules || v.discrete || checkVertex(v, *rules) == VertexState::usable;
  };
  const auto isTaken = [stride](const PathVertex& v) {
    return isForFractions(v.pixel, stride) && knowsContributions(v);
  };
  size_t count = 0;
  for (const ArrayView<const PathVertex>& piece : vertices)
    count += size_t(std::count_if(piece.begin(), piece.end(), isTaken));
  std::vector<FractionSample> samples;
  samples.reserve(count);
  for (const ArrayView<const PathVertex>& piece : vertices)
    for (const PathVertex& v : piece)
      if (isTaken(v)) samples.push_back(fractionSampleOf(v, isUsable(v)));
  return samples;
}

void narrow(std::vector<FractionSample>& samples, uint32_t stride) {
  const auto isLeftOut = [stride](const FractionSample& v) { return !isForFractions(v.pixel, stride); };
  if (std::erase_if(samples, isLeftOut) > 0) samples.shrink_to_fit();
}

void FractionSamples::makeRoom(size_t more) {
  const size_t needed = samples.size() + more, room = samples.capacity();
  if (needed > room) samples.reserve(std::max(needed, room + room / 4));
}

}  // namespace odis::core
