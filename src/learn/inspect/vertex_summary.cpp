#include <algorithm>

#include "learn/inspect/summaries.h"
#include "odis/record/vertex_check.h"

namespace odis::learn {

VertexSummary summarizeVertices(VertexParts parts) {
  VertexSummary result;
  std::vector<float> distances, radiances, densities;
  for (const ArrayView<const PathVertex>& part : parts)
    for (const PathVertex& v : part) {
      ++result.count;
      const VertexState state = checkVertex(v);
      core::countVertex(result.counts, v, state);
      if (v.depth > 0) ++result.depth[std::min<size_t>(v.depth, VertexSummary::kDepths) - 1];
      result.discrete += v.discrete;
      result.scattersBothSides += v.scattersBothSides;
      if (state != VertexState::usable) continue;
      extend(result.bounds, v.position);
      result.firstPixel = std::min(result.firstPixel, v.pixel);
      result.lastPixel = std::max(result.lastPixel, v.pixel);
      result.firstSample = std::min(result.firstSample, v.sample);
      result.lastSample = std::max(result.lastSample, v.sample);
      distances.push_back(v.distance);
      radiances.push_back(luminance(v.radiance));
      densities.push_back(v.pdf);
    }
  result.distance = quantilesOf(std::move(distances));
  result.radiance = quantilesOf(std::move(radiances));
  result.pdf = quantilesOf(std::move(densities));
  return result;
}

}  // namespace odis::learn
