#include "lookups.h"

#include <nanobind/stl/pair.h>
#include <nanobind/stl/variant.h>

#include <algorithm>
#include <cmath>

#include "calls.h"
#include "numbers.h"

namespace odis::python {

namespace {

using Cells = NumpyArray<uint32_t, -1>;
using Numbers = NumpyArray<float, -1>;
using Vectors = NumpyArray<float, -1, 3>;

// Random numbers, two for each of `count` rows; raises ValueError for one outside of [0, 1).
Rows<float> randomNumbers(const Array& uv, size_t count) {
  const Rows<float> rows(uv, "uv", 2, count);
  for (size_t i = 0; i < count; ++i)
    for (const int column : {0, 1})
      if (const float u = rows(i, column); !(u >= 0 && u < 1))
        refuseArray("uv", "numbers in [0, 1)", std::to_string(u));
  return rows;
}

// A guide as all of this looks it up: numbers that are no cell's are answered as vertices without a cell.
class Lookup {
 public:
  explicit Lookup(const Guide& guide) : m_view(guide.view()) {}

  bool isCell(uint32_t cell) const { return cell < m_view.cellCount; }
  SamplingMap<float> map(uint32_t cell) const { return {m_view.maps, int32_t(cell)}; }
  float bsdfFraction(uint32_t cell, float roughness) const {
    return isCell(cell) ? odis::bsdfFraction(m_view, int32_t(cell), roughness) : 1;
  }
  float survivalProbability(uint32_t cell, float throughput, uint32_t depth) const {
    const float factor = isCell(cell) ? m_view.decisions[cell].survivalFactor : INFINITY;
    return odis::survivalProbability(m_view.rules, factor, throughput, depth);
  }
  float shadowRayProbability(float contribution) const {
    return odis::shadowRayProbability(m_view.rules, contribution);
  }

 private:
  GuideView m_view;
};

Cells findCells(const Guide& guide, const Array& positions, const Array& normals) {
  const Rows<float> at(positions, "positions", 3), normal(normals, "normals", 3, at.size());
  const Cells result = newArray<Cells>({at.size()});
  withoutLock([&] {
    const GuideView view = guide.view();
    constexpr size_t kChunk = 128;
    Place places[kChunk];
    for (size_t begin = 0; begin < at.size(); begin += kChunk) {
      const size_t count = std::min(kChunk, at.size() - begin);
      for (size_t i = 0; i < count; ++i) places[i] = {vectorAt(at, begin + i), vectorAt(normal, begin + i)};
      odis::findCells(view, places, count, result.data() + begin);
    }
  });
  return result;
}

std::pair<Vectors, Numbers> sample(const Guide& guide, const Array& cells, const Array& uv) {
  const Rows<uint32_t> cell(cells, "cells");
  const size_t count = cell.size();
  const Rows<float> random = randomNumbers(uv, count);
  const Vectors directions = newArray<Vectors>({count, 3});
  const Numbers pdfs = newArray<Numbers>({count});
  withoutLock([&] {
    const Lookup lookup(guide);
    for (size_t i = 0; i < count; ++i) {
      SamplingMap<float>::Sample drawn;
      if (lookup.isCell(cell(i))) drawn = lookup.map(cell(i)).sample(random(i, 0), random(i, 1));
      std::memcpy(directions.data() + 3 * i, &drawn.wi, sizeof drawn.wi);
      pdfs.data()[i] = drawn.pdf;
    }
  });
  return {directions, pdfs};
}

Numbers pdf(const Guide& guide, const Array& cells, const Array& directions) {
  const Rows<uint32_t> cell(cells, "cells");
  const size_t count = cell.size();
  const Rows<float> direction(directions, "directions", 3, count);
  const Numbers result = newArray<Numbers>({count});
  withoutLock([&] {
    const Lookup lookup(guide);
    for (size_t i = 0; i < count; ++i) {
      const Float3 wi = vectorAt(direction, i);
      const bool finite = std::isfinite(wi.x) && std::isfinite(wi.y) && std::isfinite(wi.z);
      result.data()[i] = finite && lookup.isCell(cell(i)) ? lookup.map(cell(i)).pdf(wi) : 0;
    }
  });
  return result;
}

Numbers bsdfFraction(const Guide& guide, const Array& cells, const Given<float>& roughness) {
  const Rows<uint32_t> cell(cells, "cells");
  const Each<float> alpha(roughness, "roughness", cell.size());
  const Numbers result = newArray<Numbers>({cell.size()});
  withoutLock([&] {
    const Lookup lookup(guide);
    for (size_t i = 0; i < cell.size(); ++i) result.data()[i] = lookup.bsdfFraction(cell(i), alpha(i));
  });
  return result;
}

Numbers survivalProbability(const Guide& guide, const Array& cells, const Given<float>& throughput,
                            const Given<uint32_t>& depths) {
  const Rows<uint32_t> cell(cells, "cells");
  const Each<float> relative(throughput, "throughput", cell.size());
  const Each<uint32_t> depth(depths, "depth", cell.size());
  const Numbers result = newArray<Numbers>({cell.size()});
  withoutLock([&] {
    const Lookup lookup(guide);
    for (size_t i = 0; i < cell.size(); ++i)
      result.data()[i] = lookup.survivalProbability(cell(i), relative(i), depth(i));
  });
  return result;
}

Numbers shadowRayProbability(const Guide& guide, const Array& contribution) {
  const Rows<float> relative(contribution, "contribution");
  const Numbers result = newArray<Numbers>({relative.size()});
  withoutLock([&] {
    const Lookup lookup(guide);
    for (size_t i = 0; i < relative.size(); ++i) result.data()[i] = lookup.shadowRayProbability(relative(i));
  });
  return result;
}

}  // namespace

void bindLookups(nb::class_<Guide>& guide) {
  guide
      .def("find_cells", findCells, "positions"_a, "normals"_a,
           R"(The finest cell that there is for each vertex: (count,), uint32; NO_CELL where there is none.

positions, normals: float32 of shape (count, 3); shading normals, unit, on wo's side, zero in media.)")
      .def("sample", sample, "cells"_a, "uv"_a,
           R"(Samples the cells' maps: directions (count, 3), densities (count,), float32.

cells: uint32 of shape (count,); numbers that are no cell's are as NO_CELL. uv: float32 of shape (count, 2),
uniform in [0, 1). Densities are with respect to solid angle; 0, with the direction 0, without a cell.)")
      .def("pdf", pdf, "cells"_a, "directions"_a,
           R"(The densities of `sample`, with respect to solid angle: (count,), float32; 0 without a cell.

directions: float32 of shape (count, 3), unit; 0 also where they are not finite.)")
      .def("bsdf_fraction", bsdfFraction, "cells"_a, "roughness"_a,
           R"(Probabilities that draws that may be guided stay with the BSDF: (count,), float32 in (0, 1].

roughness: a number, or float32 of shape (count,): alpha of a microfacet distribution, 1 for diffuse.
1 without a cell.)")
      .def("survival_probability", survivalProbability, "cells"_a, "throughput"_a, "depth"_a = 1u,
           R"(Probabilities with which paths should go on: (count,), float32 in (0, 1].

throughput: a number, or float32 of shape (count,): of the path over the pixel's value, both as luminance.
depth: an int, or uint32 of shape (count,): of the vertices, 1 for the first. From 32 on at most .95 is
answered, without a cell as well, so that every path ends.)")
      .def("shadow_ray_probability", shadowRayProbability, "contribution"_a,
           R"(Probabilities with which shadow rays should be traced: (count,), float32 in (0, 1].

contribution: float32 of shape (count,): what the light adds to the pixel if nothing hides it, over the
pixel's value, as luminance.)");
}

}  // namespace odis::python
