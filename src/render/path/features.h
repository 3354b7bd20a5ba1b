// What images tell of a scene and of its guide beside colour: features at the first vertex that is no mirror.
#pragma once

#include <odis/guide_view.h>

#include <vector>

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
  const uint16_t* texels = nullptr;  // of the cell's map
  float bsdfFraction = 1;            // BSDF sampling fraction, 1 where nothing is guided
  float survival = 1;                // that learned roulette would give a path with this throughput
};

struct Vertex;

// The features of a vertex, `distance` from the camera along the path.
FirstHit firstHitAt(const Vertex& vertex, float distance);

// Sums of features over the samples that met a surface, and of alpha over all. 88 bytes a pixel.
struct FeatureSums {
  Rgb albedo{0, 0, 0};
  Vec3 normal{0, 0, 0}, geometricNormal{0, 0, 0}, position{0, 0, 0};
  float depth = 0, roughness = 0;
  uint32_t samples = 0, hits = 0;  // number of samples, and of those that met a surface
  float bsdfFraction = 0, entropy = 0, survival = 0;
  uint32_t guided = 0;      // number of samples that found a cell
  uint32_t cell = kNoCell;  // that the last of them found
  float alpha = 0;          // filter weights of the samples that saw anything, over their survival

  // Adds a sample, and its alpha times its filter weight.
  void add(const FirstHit& first, float sampleAlpha);
};

// The entropy of a map's texels in bits: 8 for an even map, 0 if all light comes through one texel.
float entropy(const uint16_t* texels);

// Fills the image's features and its alpha with their means, features over the samples that met a surface,
// normals made as long as 1. Albedo and normal are then scaled by the share of these samples, so that an edge
// against the sky is as smooth as that of the colours. Where no sample found a cell the BSDF sampling
// fraction and the survival are 1, the map has the entropy of an even one, and the cell's index is -1.
void writeFeatures(const std::vector<FeatureSums>& sums, bool guide, RenderedImage& image);

}  // namespace odis::render
