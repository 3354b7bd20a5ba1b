#include "render/path/map_lanes.h"

#include <odis/instruction_sets.h>

namespace odis::render {

namespace {

ODIS_WIDE void findTexelsInLanes(MapLookUps& lookUps) {
  for (size_t i = 0, end = endOfLanes(lookUps.count); i < end; ++i)
    lookUps.texels[i] = texelOf(Float3{lookUps.wi.x[i], lookUps.wi.y[i], lookUps.wi.z[i]});
}

}  // namespace

ODIS_WIDE void chooseBlocks(MapSamples& samples) {
  for (size_t i = 0; i < samples.count; ++i) {
    samples.blocks[i] = samples.maps[i].chooseBlock(samples.u[i], samples.v[i]);
    samples.maps[i].prefetch(samples.blocks[i]);
  }
}

ODIS_WIDE void sampleWithinBlocks(MapSamples& samples) {
  // Each step for all vertices, so that compilers make vectors of the second one.
  int32_t texels[kLanes];
  for (size_t i = 0; i < samples.count; ++i)
    texels[i] = samples.maps[i].chooseTexel(samples.blocks[i], samples.u[i], samples.v[i], samples.pdf[i]);
  for (size_t i = 0, end = endOfLanes(samples.count); i < end; ++i) {
    const Float3 wi = squareToDirection(pointOfTexel<float>(texels[i], {samples.u[i], samples.v[i]}));
    samples.wi.x[i] = wi.x;
    samples.wi.y[i] = wi.y;
    samples.wi.z[i] = wi.z;
  }
}

void MapLookUps::add(const SamplingMap<float>& map, const Vec3& direction) {
  assert(count < kLanes);
  maps[count] = map;
  wi.set(count++, direction);
}

void MapLookUps::add(const SamplingMap<float>& map, int32_t texel) {
  assert(count < kLanes);
  maps[count] = map;
  texels[count++] = texel;
}

void findTexels(MapLookUps& lookUps) {
  if (lookUps.count == 0) return;
  findTexelsInLanes(lookUps);
  for (size_t i = 0; i < lookUps.count; ++i) lookUps.maps[i].prefetch(lookUps.texels[i] / kBlockTexels);
}

void findPdfs(MapLookUps& lookUps) {
  for (size_t i = 0; i < lookUps.count; ++i) lookUps.pdf[i] = lookUps.maps[i].texelPdf(lookUps.texels[i]);
}

}  // namespace odis::render
