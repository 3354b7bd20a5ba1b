// Alias tables of sampling maps, for kernels on SIMD units and GPUs: a direction is drawn, and its density found, by two
// look-ups of one word each, whatever the map.
#include <algorithm>
#include <cmath>
#include <odis/odis.hpp>
#include <vector>

#include "arrays.h"
#include "lookups.h"

namespace odis::python {

namespace {

constexpr int kEntries = 16;
// Probabilities are whole multiples of 1 / kWhole, so that what is drawn and what is evaluated are equal to the bit.
constexpr int kWhole = 1 << 15;
constexpr int kShare = kWhole / kEntries;

using Weights = float[kEntries];
using Tables = NumpyArray<uint32_t, -1, -1, kEntries>;

// Probabilities in proportion to the weights, as multiples of 1 / kWhole that add up to kWhole; equal ones where the
// weights are no distribution.
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

// Walker's alias method, made in linear time (Vose 1991): each entry is drawn with probability 1 / 16, stands for
// itself with probability `own` / kShare, and for `alias` otherwise.
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

int orientationOf(const GuideView& view, size_t cell) { return int(view.keys[cell] >> 57 & 7); }

// A table of each cell's blocks for each normal: of the sums of texel times cosine.
Tables blockTables(const GuideView& view, const Rows<float>& normals, size_t slots, bool bothSides) {
  const size_t sides = bothSides ? 2 : 1;
  Tables tables = newArray<Tables>({view.cellCount, slots * sides, kEntries});
  uint32_t* out = tables.data();
  for (size_t cell = 0; cell < view.cellCount; ++cell) {
    const float* sums = view.maps.sums + cell * 4 * kEntries;
    for (size_t side = 0; side < sides; ++side)
      for (size_t slot = 0; slot < slots; ++slot, out += kEntries) {
        const Float3 n = vectorAt(normals, size_t(orientationOf(view, cell)) * slots + slot);
        Weights weights;
        for (int block = 0; block < kEntries; ++block) {
          const float cosine = sums[block] * n.x + sums[kEntries + block] * n.y + sums[2 * kEntries + block] * n.z;
          weights[block] = (side ? std::abs(cosine) : std::max(cosine, 0.0f)) +
                           view.maps.rim * sums[3 * kEntries + block];
        }
        makeAliasTable(weights, out);
      }
  }
  return tables;
}

// What texels are multiplied by in a table for all normals of an orientation: for the most part the cosine to its axis,
// as walls and floors have it, for the rest the mean of the cosines to all normals. [texel]
void addCosines(const GuideView& view, const Rows<float>& normals, size_t first, size_t slots, bool bothSides,
                float* cosines) {
  constexpr float kAxisShare = 0.8f;
  const auto add = [&](const Float3& n, float weight) {
    const float* d = view.maps.directions;
    for (int i = 0; i < kMapTexels; ++i) {
      const float cosine = n.x * d[i] + n.y * d[kMapTexels + i] + n.z * d[2 * kMapTexels + i];
      cosines[i] += weight * ((bothSides ? std::abs(cosine) : std::max(cosine, 0.0f)) + view.maps.rim);
    }
  };
  const size_t axis = first / slots;
  const float sign = axis % 2 ? -1.0f : 1.0f;
  add({axis / 2 == 0 ? sign : 0, axis / 2 == 1 ? sign : 0, axis / 2 == 2 ? sign : 0}, kAxisShare);
  for (size_t i = 0; i < slots; ++i) add(vectorAt(normals, first + i), (1 - kAxisShare) / float(slots));
}

// A table of each block's texels.
Tables texelTables(const GuideView& view, const Rows<float>& normals, size_t slots, bool bothSides) {
  const size_t orientations = normals.size() / slots, sides = bothSides ? 2 : 1;
  std::vector<float> cosines(sides * orientations * kMapTexels);
  for (size_t i = 0; i < sides * orientations; ++i)
    addCosines(view, normals, i % orientations * slots, slots, i >= orientations, &cosines[i * kMapTexels]);
  Tables tables = newArray<Tables>({sides * view.cellCount, size_t(kMapBlocks), kEntries});
  uint32_t* out = tables.data();
  for (size_t i = 0; i < sides * view.cellCount; ++i) {
    const size_t side = i / view.cellCount, cell = i % view.cellCount;
    const float* cosine = &cosines[(side * orientations + size_t(orientationOf(view, cell))) * kMapTexels];
    const uint16_t* texels = view.maps.texels + cell * kMapTexels;
    for (int texel = 0; texel < kMapTexels; texel += kEntries, out += kEntries) {
      Weights weights;
      for (int j = 0; j < kEntries; ++j) weights[j] = float(texels[texel + j]) * cosine[texel + j];
      makeAliasTable(weights, out);
    }
  }
  return tables;
}

}  // namespace

void bindAliasTables(nb::class_<Guide>& guide) {
  guide.def(
      "alias_tables",
      [](const Guide& self, const Array& normals, bool bothSides) {
        const Rows<float> rows(normals, "normals", 3);
        constexpr size_t kOrientations = 6;
        if (rows.size() == 0 || rows.size() % kOrientations != 0)
          refuseArray("normals", "as many rows for each of 6 orientations", describe(normals));
        const GuideView view = self.view();
        const size_t slots = rows.size() / kOrientations;
        return nb::make_tuple(blockTables(view, rows, slots, bothSides), texelTables(view, rows, slots, bothSides));
      },
      "normals"_a, "both_sides"_a = false,
      R"(Alias tables (Walker's method) of all sampling maps, for kernels of a host's own.

A direction is drawn from a table of 16 blocks and then from one of 16 texels. The density over solid angle is
256 / (4 pi) times the probabilities of block and texel. It is near to that of Guide.pdf for the given normals, and
what is drawn follows it exactly.

normals: float32 (6 n, 3), unit: n for each orientation of cells, in the order +x, -x, +y, -y, +z, -z
both_sides: whether to make tables for surfaces that scatter to both sides as well

Returns two arrays of uint32:
blocks: (cells, n, 16), or (cells, 2 n, 16): tables for both sides come after those for one
texels: (cells, 16, 16), or (2 cells, 16, 16), likewise
Bits 0 to 15 of an entry are its own probability times 2^15, bits 16 to 26 the probability that drawing it stands
for itself times 2^11, and bits 27 to 30 the entry that it stands for otherwise.)");
}

}  // namespace odis::python
