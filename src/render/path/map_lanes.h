// Maps of several vertices, asked side by side: to the same bits as VertexMap answers one by one.
#pragma once

#include <odis/sampling_map.h>

#include "render/math/columns.h"

namespace odis::render {

// Maps to be prepared.
struct MapPreparations {
  size_t count = 0;
  VertexMap<float>* maps[kLanes];
  int32_t cells[kLanes];
  Vec3 normals[kLanes];
  float belowSigns[kLanes];

  void add(VertexMap<float>& map, int32_t cell, const Vec3& normal, float belowSign);
};
// VertexMap::prepare() for each.
void prepareMaps(const MapArrays& arrays, MapPreparations& maps);

// Samples that are drawn from maps in two steps.
struct MapSamples {
  size_t count = 0;
  const VertexMap<float>* maps[kLanes];
  Column u, v;             // uniform in [0, 1)
  int32_t blocks[kLanes];  // of the maps
  Columns3 wi;             // unit vectors, world space
  Column pdf;              // with respect to solid angle

  void add(const VertexMap<float>& map, const Vec2& numbers, int32_t block = 0) {
    addIf(true, map, numbers, block);
  }
  // Without a branch, which would often be mispredicted.
  void addIf(bool drawn, const VertexMap<float>& map, const Vec2& numbers, int32_t block = 0) {
    assert(count < kLanes);
    maps[count] = &map;
    u[count] = numbers.x;
    v[count] = numbers.y;
    blocks[count] = block;
    count += drawn;
  }
};
// VertexMap::chooseBlock(): finds `blocks`, and stretches u and v to sample within them.
void chooseBlocks(MapSamples& samples);
// VertexMap::sampleWithin(): finds `wi` and `pdf`. Overwrites u and v.
void sampleWithinBlocks(MapSamples& samples);

// Directions whose densities are looked up in maps.
struct MapLookUps {
  size_t count = 0;
  const VertexMap<float>* maps[kLanes];
  Columns3 wi;             // unit vectors, world space
  int32_t texels[kLanes];  // that they fall into
  Column pdf;              // with respect to solid angle

  void add(const VertexMap<float>& map, const Vec3& direction);
  void add(const VertexMap<float>& map, int32_t texel);
};
// texelOf(), and fetches what findPdfs() reads.
void findTexels(MapLookUps& lookUps);
// VertexMap::texelPdf(): needs the texels.
void findPdfs(MapLookUps& lookUps);

}  // namespace odis::render
