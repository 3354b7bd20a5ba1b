// What images tell of a scene and of its guide beside colour: features at the first vertex that is no mirror.
#pragma once

#include <odis/guide_view.h>

#include <span>
#include <vector>

#include "render/film/splat_film.h"
#include "render/path/rendered_image.h"

namespace odis::render {

// Features at the first vertex whose sampled lobe is not discrete.
struct FirstHit {
  bool valid = false;
  Vec3 position, normal, geometricNormal;
  Rgb albedo;
  float depth = 0;  // distance from the camera along the path
  float roughness = 0;

  // What the guide has decided there, if asked for; no cell: nothing.
  uint32_t cell = kNoCell;
  SamplingMap<float> map;  // of the cell
  float bsdfFraction = 1;  // BSDF sampling fraction, 1 where nothing is guided
  float survival = 1;      // that learned roulette would give a path with this throughput
};

struct Path;
struct Vertex;

// The features of a vertex, `distance` from the camera along the path.
FirstHit firstHitAt(const Vertex& vertex, float distance);
// Takes a path that has met a vertex on through a mirror or glass to its next ray; elsewhere notes the
// features of the vertex and returns false. `depth` counts the vertices, from 1.
bool passesMirror(Path& path, const Vertex& vertex, int depth);

// Sums of features over the samples that met a surface, and of alpha over all. 68 bytes a pixel.
struct FeatureSums {
  Rgb albedo{0, 0, 0};
  Vec3 normal{0, 0, 0}, geometricNormal{0, 0, 0}, position{0, 0, 0};
  float depth = 0, roughness = 0;
  float samples = 0, hits = 0;  // number of samples, and of those that met a surface
  float alpha = 0;              // filter weights of the samples that saw anything, over their survival

  // Adds a sample, and its alpha times its filter weight.
  void add(const FirstHit& first, float sampleAlpha);
};

// Sums of what the guide has decided. 20 bytes a pixel.
struct GuideFeatureSums {
  float bsdfFraction = 0, entropy = 0, survival = 0;
  uint32_t guided = 0;      // number of samples that found a cell
  uint32_t cell = kNoCell;  // that the last of them found

  void add(const FirstHit& first);
};

// What a film that splats adds of features. Means over the samples that met a surface are made with absolute
// values of the filter; albedo and normal, which fade where only some did, and alpha are filtered as colours.
inline constexpr SplatChannels kFeatureChannels{18, 9};
// Appends the channels of a sample.
void appendFeatureChannels(const FirstHit& first, float sampleAlpha, std::vector<float>& channels);
// The sums of a pixel, of numbers of samples and of hits as well, by the channels that it has on the film.
FeatureSums featureSumsOf(std::span<const float> channels);

// The entropy of a map's texels in bits: 8 for an even map, 0 if all light comes through one texel.
float entropy(const SamplingMap<float>& map);

// Appends a pixel to the image's features and its alpha: means, features over the samples that met a surface,
// normals made as long as 1. Albedo and normal are then scaled by the share of these samples, so that an edge
// against the sky is as smooth as that of the colours.
void writeFeatures(const FeatureSums& sums, RenderedImage& image);
// Likewise for what the guide decided. Where no sample found a cell the BSDF sampling fraction and the
// survival are 1, the map has the entropy of an even one, and the cell's index is -1.
void writeGuideFeatures(const GuideFeatureSums& sums, RenderedImage& image);

}  // namespace odis::render
