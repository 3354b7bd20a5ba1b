#include "render/path/features.h"

#include <cmath>
#include <span>

#include "render/path/path.h"

namespace odis::render {

FirstHit firstHitAt(const Vertex& vertex, float distance) {
  const SurfacePoint& at = vertex.at;
  const BsdfFeatures features = vertex.bsdf->features(at, vertex.wo);
  FirstHit first;
  first.valid = true;
  first.position = at.p;
  first.normal = facingNormal(vertex);
  first.geometricNormal = at.ng * signOfSide(vertex.wo.z < 0);
  first.albedo = features.albedo;
  first.depth = distance;
  first.roughness = features.roughness;
  return first;
}

namespace {

// Whether what the camera sees at a vertex is what a sampled direction leads to, as in a mirror. A coat that
// reflects less than what it covers is no mirror.
bool leadsOn(const Bsdf& bsdf, const Vertex& vertex, Lobe lobe) {
  return lobe == Lobe::null || (isDiscrete(lobe) && bsdf.guidableProbability(vertex.at, vertex.wo) < 0.5f);
}

}  // namespace

bool passesMirror(Path& path, const Vertex& vertex, int depth) {
  if (!vertex.bsdf) return false;
  const SurfacePoint& at = vertex.at;
  path.distance += length(at.p - path.ray.origin);
  const Bsdf& bsdf = *vertex.bsdf;
  const BsdfTraits& traits = bsdf.traits();
  BsdfSample next;
  if (!traits.evaluable || traits.choosesLobes) {  // others have no discrete lobe
    path.sampler.startVertex(depth);
    const float uLobe = path.sampler.get1D();
    next = bsdf.sample(at, vertex.wo, uLobe, path.sampler.get2D());
  }
  if (!leadsOn(bsdf, vertex, next.lobe)) {
    path.first = firstHitAt(vertex, path.distance);
    return false;
  }
  path.ray = Scene::spawn(at, at.shading.toWorld(next.wi));
  path.medium = at.shape->mediumBeyond(at, path.ray.direction, path.medium);
  return !isBlack(next.weight);
}

// docs/figures.md names them.
static_assert(sizeof(FeatureSums) == 68 && sizeof(GuideFeatureSums) == 20);

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
}

void GuideFeatureSums::add(const FirstHit& first) {
  if (!first.valid || first.cell == kNoCell) return;
  bsdfFraction += first.bsdfFraction;
  entropy += render::entropy(first.map);
  survival += first.survival;
  cell = first.cell;
  ++guided;
}

void appendFeatureChannels(const FirstHit& first, float sampleAlpha, std::vector<float>& channels) {
  FeatureSums s;
  s.add(first, sampleAlpha);
  const Vec3 &n = s.normal, &ng = s.geometricNormal, &p = s.position;
  const float all[] = {s.albedo.x, s.albedo.y, s.albedo.z,  n.x,     n.y,
                       n.z,        s.hits,     s.samples,   s.alpha,  // those that are filtered
                       ng.x,       ng.y,       ng.z,        p.x,     p.y,
                       p.z,        s.depth,    s.roughness, s.hits};
  static_assert(std::size(all) == size_t(kFeatureChannels.count));
  channels.insert(channels.end(), std::begin(all), std::end(all));
}

FeatureSums featureSumsOf(std::span<const float> c) {
  FeatureSums s;
  s.albedo = Rgb(c[0], c[1], c[2]);
  s.normal = Vec3(c[3], c[4], c[5]);
  s.hits = std::max(c[6], 0.0f);
  s.samples = c[7];
  s.alpha = c[8];
  // Means by absolute values, as sums over `hits` samples.
  const float scale = c[17] > 0 ? s.hits / c[17] : 0;
  s.geometricNormal = Vec3(c[9], c[10], c[11]) * scale;
  s.position = Vec3(c[12], c[13], c[14]) * scale;
  s.depth = c[15] * scale;
  s.roughness = c[16] * scale;
  return s;
}

float entropy(const SamplingMap<float>& map) {
  double sum = 0, sumOfLogs = 0;
  for (int t = 0; t < kMapTexels; ++t) {
    const double density = map.texelPdf(t);
    sum += density;
    sumOfLogs += density * std::log2(density);
  }
  return float(std::log2(sum) - sumOfLogs / sum);
}

void writeFeatures(const FeatureSums& s, RenderedImage& image) {
  const auto unit = [](const Vec3& v) { return lengthSquared(v) > 0 ? normalize(v) : Vec3(0, 0, 0); };
  const float scale = s.hits > 0 ? 1.0f / s.hits : 0.0f;
  // Filters with negative lobes would make more than all of it.
  const float coverage = s.samples > 0 ? std::min(s.hits / s.samples, 1.0f) : 0.0f;
  image.albedo.push_back(s.albedo * (scale * coverage));
  image.normal.push_back(unit(s.normal) * coverage);
  image.geometricNormal.push_back(unit(s.geometricNormal));
  image.position.push_back(s.position * scale);
  image.depth.push_back(s.depth * scale);
  image.roughness.push_back(s.roughness * scale);
  image.alpha.push_back(s.samples > 0 ? s.alpha / s.samples : 0.0f);
}

void writeGuideFeatures(const GuideFeatureSums& s, RenderedImage& image) {
  const auto mean = [&](float sum, float otherwise) {
    return s.guided > 0 ? sum / float(s.guided) : otherwise;
  };
  image.guideBsdfFraction.push_back(mean(s.bsdfFraction, 1));
  image.guideEntropy.push_back(mean(s.entropy, std::log2(float(kMapTexels))));
  image.guideSurvival.push_back(mean(s.survival, 1));
  image.guideCell.push_back(s.guided > 0 ? float(s.cell) : -1.0f);
}

}  // namespace odis::render
