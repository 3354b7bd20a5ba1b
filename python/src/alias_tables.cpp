// Alias tables of sampling maps, for kernels on SIMD units and GPUs: a direction is drawn, and its density
// found, by two look-ups of one word each, whatever the map.
#include <algorithm>
#include <cmath>
#include <odis/odis.hpp>
#include <thread>
#include <vector>

#include "arrays.h"
#include "calls.h"
#include "lookups.h"

namespace odis::python {

namespace {

constexpr int kEntries = 16;
// Probabilities are whole multiples of 1 / kWhole, so that what is drawn is what is evaluated, to the bit.
constexpr int kWhole = 1 << 15;
constexpr int kShare = kWhole / kEntries;

using Weights = float[kEntries];
using BlockTables = NumpyArray<uint32_t, -1, -1, kEntries>;
using TexelTables = NumpyArray<uint32_t, -1, kMapBlocks, kEntries>;

// Probabilities in proportion to the weights, as multiples of 1 / kWhole that add up to kWhole; equal ones
// where the weights are no distribution.
void quantize(const Weights& weights, int (&parts)[kEntries]) {
  float total = 0;
  for (const float weight : weights) total += weight;
  const float scale = kWhole / total;
  if (!(total > 0) || !std::isfinite(scale)) {
    std::fill_n(parts, kEntries, kShare);
    return;
  }
  float sum = 0;
  int before = 0;
  for (int i = 0; i < kEntries; ++i) {
    sum += weights[i];
    const int after = i + 1 < kEntries ? std::min(int(sum * scale + 0.5f), kWhole) : kWhole;
    parts[i] = after - before;
    before = after;
  }
}

// Walker's alias method, made in linear time (Vose 1991): each entry is drawn with probability 1 / 16, stands
// for itself with probability `own` / kShare, and for `alias` otherwise.
void makeAliasTable(const Weights& weights, uint32_t* entries) {
  int parts[kEntries], own[kEntries], alias[kEntries], small[kEntries], large[kEntries];
  quantize(weights, parts);
  int smalls = 0, larges = 0;
  for (int i = 0; i < kEntries; ++i) {
    own[i] = parts[i];
    alias[i] = i;
    if (own[i] < kShare)
      small[smalls++] = i;
    else
      large[larges++] = i;
  }
  while (smalls > 0) {
    const int entry = small[--smalls], giver = large[larges - 1];
    alias[entry] = giver;
    own[giver] -= kShare - own[entry];
    if (own[giver] < kShare) {
      --larges;
      small[smalls++] = giver;
    }
  }
  // What is left over stands for itself alone: its alias is itself.
  for (int i = 0; i < kEntries; ++i) {
    const uint32_t threshold = alias[i] == i ? 0 : uint32_t(own[i]);
    entries[i] = uint32_t(parts[i]) | threshold << 16 | uint32_t(alias[i]) << 27;
  }
}

int orientationOf(const GuideView& view, size_t cell) {
  return int(view.keys[cell] >> 57 & 7);
}

// Calls body(i) for all i below count, by as many threads as there are processors.
template <class Body>
void forEach(size_t count, const Body& body) {
  const size_t threads = std::clamp<size_t>(std::thread::hardware_concurrency(), 1, 1 + count / 256);
  std::vector<std::jthread> others;
  const auto part = [&](size_t t) {
    for (size_t i = count * t / threads; i < count * (t + 1) / threads; ++i) body(i);
  };
  for (size_t t = 1; t < threads; ++t) others.emplace_back(part, t);
  part(0);
}

// The tables of a cell's blocks for each normal: of the sums of texel times cosine.
void makeBlockTables(const GuideView& view, size_t cell, const Float3* normals, size_t slots, size_t sides,
                     uint32_t* out) {
  const float* sums = view.maps.sums + cell * 4 * kEntries;
  for (size_t side = 0; side < sides; ++side)
    for (size_t slot = 0; slot < slots; ++slot, out += kEntries) {
      const Float3 n = normals[slot];
      Weights weights;
      for (int i = 0; i < kEntries; ++i) {
        const float cosine = sums[i] * n.x + sums[kEntries + i] * n.y + sums[2 * kEntries + i] * n.z;
        weights[i] =
            (side ? std::abs(cosine) : std::max(cosine, 0.0f)) + view.maps.rim * sums[3 * kEntries + i];
      }
      makeAliasTable(weights, out);
    }
}

// What the texels of a cell are multiplied by, one table for all normals of its orientation: for the most
// part the cosine to its axis, as walls and floors have it, for the rest the mean of the cosines to all
// normals.
std::vector<float> texelCosines(const GuideView& view, size_t orientation, const Float3* normals,
                                size_t slots, bool bothSides) {
  constexpr float kAxisShare = 0.8f;
  std::vector<float> cosines(kMapTexels);
  const auto add = [&](const Float3& n, float weight) {
    const float* d = view.maps.directions;
    for (int i = 0; i < kMapTexels; ++i) {
      const float cosine = n.x * d[i] + n.y * d[kMapTexels + i] + n.z * d[2 * kMapTexels + i];
      cosines[i] += weight * ((bothSides ? std::abs(cosine) : std::max(cosine, 0.0f)) + view.maps.rim);
    }
  };
  float axis[3] = {};
  axis[orientation / 2] = orientation % 2 ? -1.0f : 1.0f;
  add({axis[0], axis[1], axis[2]}, kAxisShare);
  for (size_t slot = 0; slot < slots; ++slot) add(normals[slot], (1 - kAxisShare) / float(slots));
  return cosines;
}

// The tables of the texels of each of a cell's blocks.
void makeTexelTables(const uint16_t* texels, const float* cosines, uint32_t* out) {
  for (int texel = 0; texel < kMapTexels; texel += kEntries) {
    Weights weights;
    for (int i = 0; i < kEntries; ++i) weights[i] = float(texels[texel + i]) * cosines[texel + i];
    makeAliasTable(weights, out + texel);
  }
}

nb::tuple aliasTables(const Guide& guide, const Array& array, bool bothSides) {
  constexpr size_t kOrientations = 6;
  const Rows<float> rows(array, "normals", 3);
  if (rows.size() == 0 || rows.size() % kOrientations != 0)
    refuseArray("normals", "as many rows for each of 6 orientations", describe(array));
  std::vector<Float3> normals;
  for (size_t i = 0; i < rows.size(); ++i) normals.push_back(vectorAt(rows, i));
  for (const Float3& n : normals)
    if (!(n.x * n.x + n.y * n.y + n.z * n.z < 2)) refuseArray("normals", "unit vectors", "a longer one");
  const GuideView view = guide.view();
  const size_t cells = view.cellCount, slots = normals.size() / kOrientations, sides = bothSides ? 2 : 1;
  const BlockTables blocks = newArray<BlockTables>({cells, slots * sides, kEntries});
  const TexelTables texels = newArray<TexelTables>({cells * sides, kMapBlocks, kEntries});
  withoutLock([&] {
    std::vector<std::vector<float>> cosines;  // [side][orientation][texel]
    for (size_t i = 0; i < sides * kOrientations; ++i) {
      const size_t orientation = i % kOrientations;
      cosines.push_back(
          texelCosines(view, orientation, &normals[orientation * slots], slots, i >= kOrientations));
    }
    forEach(cells, [&](size_t cell) {
      const size_t orientation = view.keys[cell] >> 57 & 7;
      makeBlockTables(view, cell, &normals[orientation * slots], slots, sides,
                      blocks.data() + cell * slots * sides * kEntries);
      for (size_t side = 0; side < sides; ++side)
        makeTexelTables(view.maps.texels + cell * kMapTexels,
                        cosines[side * kOrientations + orientation].data(),
                        texels.data() + (side * cells + cell) * kMapTexels);
    });
  });
  return nb::make_tuple(blocks, texels);
}

}  // namespace

void bindAliasTables(nb::class_<Guide>& guide) {
  guide.def("alias_tables", &aliasTables, "normals"_a, "both_sides"_a = false,
            R"(Alias tables (Walker's method) of all sampling maps, for kernels of a host's own.

A direction is drawn from a table of 16 blocks and then from one of 16 texels. The density over solid angle
is 256 / (4 pi) times the probabilities of block and texel. It is near to that of Guide.pdf for the given
normals, and what is drawn follows it exactly.

normals: float32 (6 n, 3), unit: n for each orientation of cells, in the order +x, -x, +y, -y, +z, -z
both_sides: whether to make tables for surfaces that scatter to both sides as well

Returns two arrays of uint32:
blocks: (cells, n, 16), or (cells, 2 n, 16): tables for both sides come after those for one
texels: (cells, 16, 16), or (2 cells, 16, 16), likewise
Bits 0 to 15 of an entry are its own probability times 2^15, bits 16 to 26 the probability that drawing it
stands for itself times 2^11, and bits 27 to 30 the entry that it stands for otherwise.)");
}

}  // namespace odis::python
