#include "render/path/map_lanes.h"

#include <odis/instruction_sets.h>

namespace odis::render {

namespace {

// Four weights of each lane.
struct Weights {
  Column of[kBlockSize];

  // row(lane) says where the four of a lane lie.
  template <class Row>
  void gather(size_t count, const Row& row) {
    for (size_t first = 0; first < count; first += 4)
      toColumns(
          first, [&](size_t lane) { return row(std::min(lane, count - 1)); }, of[0].of, of[1].of, of[2].of,
          of[3].of);
  }
};

// Does what VertexMap::pick() does in every lane: finds which of four weights the number u falls into.
// `picked` is the index of that weight, `weight` the weight itself; u becomes its place within the weight.
ODIS_WIDE void pickLanes(size_t count, const Weights& weights, Column& u, int32_t* picked, Column& weight) {
  const auto& [w0, w1, w2, w3] = weights.of;
  for (size_t i = 0, end = endOfLanes(count); i < end; ++i) {
    const float begin1 = w0[i], begin2 = w0[i] + w1[i], begin3 = w0[i] + w1[i] + w2[i];
    const float target = u[i] * (begin3 + w3[i]);
    // Each piece that is reached replaces the one before.
    float begin = 0, width = w0[i];
    int32_t piece = 0;
    begin = target >= begin1 ? begin1 : begin;
    width = target >= begin1 ? w1[i] : width;
    piece = target >= begin1 ? 1 : piece;
    begin = target >= begin2 ? begin2 : begin;
    width = target >= begin2 ? w2[i] : width;
    piece = target >= begin2 ? 2 : piece;
    begin = target >= begin3 ? begin3 : begin;
    width = target >= begin3 ? w3[i] : width;
    piece = target >= begin3 ? 3 : piece;
    u[i] = odis::max(odis::min((target - begin) / width, 0x1.fffffep-1f), 0.0f);
    picked[i] = piece;
    weight[i] = width;
  }
}

// The directions of the points u, v of texels, in [0, 1]^2 each.
ODIS_WIDE void findDirections(MapSamples& samples, const int32_t* texels) {
  for (size_t i = 0, end = endOfLanes(samples.count); i < end; ++i) {
    const Float3 wi = squareToDirection(pointOfTexel<float>(texels[i], {samples.u[i], samples.v[i]}));
    samples.wi.x[i] = wi.x;
    samples.wi.y[i] = wi.y;
    samples.wi.z[i] = wi.z;
  }
}

ODIS_WIDE void weighBlocks(const MapSamples& samples, VertexMap<float>::Block* weights) {
  for (size_t i = 0; i < samples.count; ++i) samples.maps[i]->weigh(samples.blocks[i], weights[i]);
}

ODIS_WIDE void findTexelsInLanes(MapLookUps& lookUps) {
  for (size_t i = 0, end = endOfLanes(lookUps.count); i < end; ++i)
    lookUps.texels[i] = texelOf(Float3{lookUps.wi.x[i], lookUps.wi.y[i], lookUps.wi.z[i]});
}

}  // namespace

void MapPreparations::add(VertexMap<float>& map, int32_t cell, const Vec3& normal, float belowSign) {
  assert(count < kLanes);
  maps[count] = &map;
  cells[count] = cell;
  normals[count] = normal;
  belowSigns[count++] = belowSign;
}

ODIS_WIDE void prepareMaps(const MapArrays& arrays, MapPreparations& maps) {
  for (size_t i = 0; i < maps.count; ++i) {
    const Vec3& n = maps.normals[i];
    maps.maps[i]->prepare(arrays, maps.cells[i], Float3{n.x, n.y, n.z}, maps.belowSigns[i]);
  }
}

void chooseBlocks(MapSamples& samples) {
  if (samples.count == 0) return;
  Weights weights;
  Column ignored;
  int32_t columns[kLanes];
  weights.gather(samples.count, [&](size_t i) { return samples.maps[i]->rows(); });
  pickLanes(samples.count, weights, samples.v, samples.blocks, ignored);
  weights.gather(samples.count,
                 [&](size_t i) { return samples.maps[i]->blocks() + kBlockSize * samples.blocks[i]; });
  pickLanes(samples.count, weights, samples.u, columns, ignored);
  for (size_t i = 0; i < samples.count; ++i) samples.blocks[i] = samples.blocks[i] * kBlockSize + columns[i];
}

void sampleWithinBlocks(MapSamples& samples) {
  if (samples.count == 0) return;
  VertexMap<float>::Block blocks[kLanes];
  weighBlocks(samples, blocks);
  Weights weights;
  Column picked;
  int32_t rows[kLanes], columns[kLanes], texels[kLanes];
  weights.gather(samples.count, [&](size_t i) { return blocks[i].rows; });
  pickLanes(samples.count, weights, samples.v, rows, picked);
  weights.gather(samples.count, [&](size_t i) { return blocks[i].texels + kBlockSize * rows[i]; });
  pickLanes(samples.count, weights, samples.u, columns, picked);
  for (size_t i = 0; i < samples.count; ++i) {
    texels[i] = samples.blocks[i] * kBlockTexels + rows[i] * kBlockSize + columns[i];
    samples.pdf[i] = picked[i] * blocks[i].toPdf;
  }
  findDirections(samples, texels);
}

void MapLookUps::add(const VertexMap<float>& map, const Vec3& direction) {
  assert(count < kLanes);
  maps[count] = &map;
  wi.set(count++, direction);
}

void MapLookUps::add(const VertexMap<float>& map, int32_t texel) {
  assert(count < kLanes);
  maps[count] = &map;
  texels[count++] = texel;
}

void findTexels(MapLookUps& lookUps) {
  if (lookUps.count == 0) return;
  findTexelsInLanes(lookUps);
  for (size_t i = 0; i < lookUps.count; ++i) lookUps.maps[i]->prefetch(lookUps.texels[i] / kBlockTexels);
}

ODIS_WIDE void findPdfs(MapLookUps& lookUps) {
  for (size_t i = 0; i < lookUps.count; ++i) lookUps.pdf[i] = lookUps.maps[i]->texelPdf(lookUps.texels[i]);
}

}  // namespace odis::render
