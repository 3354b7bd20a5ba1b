#include "render/integrator/features.h"

#include <cmath>

namespace odis::render {

void FeatureSums::add(const FirstHit& first) {
  if (!first.valid) return;
  albedo += first.albedo;
  normal += first.normal;
  geometricNormal += first.geometricNormal;
  position += first.position;
  depth += first.depth;
  roughness += first.roughness;
  ++hits;
  if (!first.cell) return;
  bsdfShare += first.bsdfShare;
  entropy += render::entropy(first.cell->map);
  survival += first.survival;
  cellIndex = first.cellIndex;
  ++guided;
}

float entropy(const SamplingMap& map) {
  double sum = 0, sumOfLogs = 0;
  for (const uint16_t texel : map.texels) {
    sum += texel;
    if (texel > 0) sumOfLogs += texel * std::log2(double(texel));
  }
  return float(std::log2(sum) - sumOfLogs / sum);
}

void writeFeatures(const std::vector<FeatureSums>& sums, bool guide, Frame2D& frame) {
  const auto unit = [](const Vec3& v) { return lengthSquared(v) > 0 ? normalize(v) : Vec3(0, 0, 0); };
  for (const FeatureSums& s : sums) {
    const float scale = s.hits > 0 ? 1.0f / float(s.hits) : 0.0f;
    frame.albedo.push_back(s.albedo * scale);
    frame.normal.push_back(unit(s.normal));
    frame.geometricNormal.push_back(unit(s.geometricNormal));
    frame.position.push_back(s.position * scale);
    frame.depth.push_back(s.depth * scale);
    frame.roughness.push_back(s.roughness * scale);
    if (!guide) continue;
    const auto mean = [&](float sum, float otherwise) {
      return s.guided > 0 ? sum / float(s.guided) : otherwise;
    };
    frame.guideAlpha.push_back(mean(s.bsdfShare, 1));
    frame.guideEntropy.push_back(mean(s.entropy, std::log2(float(kMapTexels))));
    frame.guideSurvival.push_back(mean(s.survival, 1));
    frame.guideCell.push_back(s.guided > 0 ? float(s.cellIndex) : -1.0f);
  }
}

}  // namespace odis::render
