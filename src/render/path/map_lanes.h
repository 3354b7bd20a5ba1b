// Sampling maps of several vertices, asked side by side, so that none waits for memory: to the same bits as
// SamplingMap answers one by one.
#pragma once

#include <odis/sampling_map.h>

#include "render/math/columns.h"

namespace odis::render {

// Samples that are drawn from maps in two steps.
struct MapSamples {
  size_t count = 0;
  SamplingMap<float> maps[kLanes];
  Column u, v;             // uniform in [0, 1)
  int32_t blocks[kLanes];  // of the maps
  Columns3 wi;             // unit vectors, world space
  Column pdf;              // with respect to solid angle

  void add(const SamplingMap<float>& map, const Vec2& numbers, int32_t block = 0) {
    addIf(true, map, numbers, block);
  }
  // Without a branch, which would often be mispredicted.
  void addIf(bool drawn, const SamplingMap<float>& map, const Vec2& numbers, int32_t block = 0) {
    assert(count < kLanes);
    maps[count] = map;
    u[count] = numbers.x;
    v[count] = numbers.y;
    blocks[count] = block;
    count += drawn;
  }
};
// SamplingMap::chooseBlock(): finds `blocks`, stretches u and v to sample within them, and fetches
// what that reads.
void chooseBlocks(MapSamples& samples);
// SamplingMap::sampleWithin(): finds `wi` and `pdf`. Stretches u and v again.
void sampleWithinBlocks(MapSamples& samples);

// Directions whose densities are looked up in maps.
struct MapLookUps {
  size_t count = 0;
  SamplingMap<float> maps[kLanes];
  Columns3 wi;             // unit vectors, world space
  int32_t texels[kLanes];  // that they fall into
  Column pdf;              // with respect to solid angle

  void add(const SamplingMap<float>& map, const Vec3& direction);
  void add(const SamplingMap<float>& map, int32_t texel);
};
// texelOf(), and fetches what findPdfs() reads.
void findTexels(MapLookUps& lookUps);
// SamplingMap::texelPdf(): needs the texels.
void findPdfs(MapLookUps& lookUps);

}  // namespace odis::render
