#include "render/path/features.h"

#include <cmath>
#include <span>

#include "render/path/path.h"

namespace odis::render {

FirstHit firstHitAt(const Vertex& vertex, float distance) {
  const auto& [at, wo] = vertex;
  const BsdfFeatures features = at.shape->bsdf().features(at, wo);
  const float side = wo.z < 0 ? -1.0f : 1.0f;
  FirstHit first;
  first.valid = true;
  first.position = at.p;
  first.normal = at.shading.n * side;
  first.geometricNormal = at.ng * side;
  first.albedo = features.albedo;
  first.depth = distance;
  first.roughness = features.roughness;
  return first;
}

// docs/figures.md names it.
static_assert(sizeof(FeatureSums) == 88);

void FeatureSums::add(const FirstHit& first, float sampleAlpha) {
  alpha += sampleAlpha;
  ++samples;
  if (!first.valid) return;
  albedo += first.albedo;
  normal += first.normal;
  geometricNormal += first.geometricNormal;
  position += first.position;
  depth += first.depth;
  roughness += first.roughness;
  ++hits;
  if (first.cell == kNoCell) return;
  bsdfFraction += first.bsdfFraction;
  entropy += render::entropy(first.texels);
  survival += first.survival;
  cell = first.cell;
  ++guided;
}

float entropy(const uint16_t* texels) {
  double sum = 0, sumOfLogs = 0;
  for (const uint16_t texel : std::span(texels, kMapTexels)) {
    sum += texel;
    if (texel > 0) sumOfLogs += texel * std::log2(double(texel));
  }
  return float(std::log2(sum) - sumOfLogs / sum);
}

void writeFeatures(const std::vector<FeatureSums>& sums, bool guide, RenderedImage& image) {
  const auto unit = [](const Vec3& v) { return lengthSquared(v) > 0 ? normalize(v) : Vec3(0, 0, 0); };
  for (const FeatureSums& s : sums) {
    const float scale = s.hits > 0 ? 1.0f / float(s.hits) : 0.0f;
    const float coverage = s.samples > 0 ? float(s.hits) / float(s.samples) : 0.0f;
    image.albedo.push_back(s.albedo * (scale * coverage));
    image.normal.push_back(unit(s.normal) * coverage);
    image.geometricNormal.push_back(unit(s.geometricNormal));
    image.position.push_back(s.position * scale);
    image.depth.push_back(s.depth * scale);
    image.roughness.push_back(s.roughness * scale);
    image.alpha.push_back(s.samples > 0 ? s.alpha / float(s.samples) : 0.0f);
    if (!guide) continue;
    const auto mean = [&](float sum, float otherwise) {
      return s.guided > 0 ? sum / float(s.guided) : otherwise;
    };
    image.guideBsdfFraction.push_back(mean(s.bsdfFraction, 1));
    image.guideEntropy.push_back(mean(s.entropy, std::log2(float(kMapTexels))));
    image.guideSurvival.push_back(mean(s.survival, 1));
    image.guideCell.push_back(s.guided > 0 ? float(s.cell) : -1.0f);
  }
}

}  // namespace odis::render
