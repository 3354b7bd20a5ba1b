// Guide: its arrays, shown where they lie. Look-ups are in lookups.cpp.
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>

#include <odis/odis.hpp>

#include "arrays.h"
#include "calls.h"
#include "context.h"
#include "lookups.h"
#include "printing.h"
#include "saved_bytes.h"

namespace odis::python {

namespace {

using Self = nb::pointer_and_handle<Guide>;

constexpr int64_t kDecisionFloats = sizeof(CellDecisions) / sizeof(float);

// An array of the guide's, which keeps the guide alive. Without cells it may be anywhere.
template <class Result>
Result shown(const Self& self, typename Result::Scalar* data, std::initializer_list<size_t> shape,
             std::initializer_list<int64_t> strides = {}) {
  static typename Result::Scalar none{};
  return Result(data ? data : &none, shape, self.h, strides);
}

// One of the numbers, or vectors, of the decisions of all cells.
template <class Result>
Result shownDecision(const Self& self, size_t offset, size_t columns) {
  const GuideView view = self.p->view();
  const float* data =
      view.decisions ? reinterpret_cast<const float*>(view.decisions) + offset / sizeof(float) : nullptr;
  if (columns == 0) return shown<Result>(self, data, {view.cellCount}, {kDecisionFloats});
  return shown<Result>(self, data, {view.cellCount, columns}, {kDecisionFloats, 1});
}

using Floats = NumpyArray<const float, -1>;
using FloatRows = NumpyArray<const float, -1, 3>;

void bindMaps(nb::class_<Guide>& guide) {
  guide
      .def_prop_ro(
          "cell_keys",
          [](Self self) {
            const GuideView view = self.p->view();
            return shown<NumpyArray<const uint64_t, -1>>(self, view.keys, {view.cellCount});
          },
          "(cells,), uint64: where each cell lies: three coordinates of 19 bits from the lowest bit on, the\n"
          "axis of its normals from bit 57 on (6: in media), its level from bit 60 on. Far out, in rings of\n"
          "larger cells, 2048 >> level times the ring's number (in media level + 1) is added to the first\n"
          "coordinate (odis/cell_grid.h).")
      .def_prop_ro(
          "maps",
          [](Self self) {
            const GuideView view = self.p->view();
            return shown<NumpyArray<const uint16_t, -1, kMapTables, kBlockTexels>>(
                self, view.maps, {view.cellCount, size_t(kMapTables), size_t(kBlockTexels)});
          },
          "(cells, 17, 16), uint16: for each cell a table of how likely each block of texels is, and for "
          "each\n"
          "block one of how likely its texels are, in parts of 2^-15: at least 1, 2^15 in sum. The density\n"
          "over solid angle is 256 / (4 pi) times both probabilities (odis/sampling_map.h).")
      .def_prop_ro(
          "pixel_cells",
          [](Self self) {
            const auto pixels = self.p->view().pixels;
            return shown<NumpyArray<const uint32_t, -1>>(self, pixels.cells, {pixels.count});
          },
          "(pixels,), uint32: the cell of each pixel's own map, or NO_CELL; empty without such maps.");
}

void bindDecisions(nb::class_<Guide>& guide) {
  guide
      .def_prop_ro(
          "bsdf_fractions",
          [](Self self) { return shownDecision<FloatRows>(self, offsetof(CellDecisions, bsdfFraction), 3); },
          "(cells, 3), float32 in (0, 1]: BSDF sampling fractions of diffuse, rough and glossy vertices.")
      .def_prop_ro(
          "survival_factors",
          [](Self self) { return shownDecision<Floats>(self, offsetof(CellDecisions, survivalFactor), 0); },
          "(cells,), float32: times throughput over pixel value it is the probability that a path goes on;\n"
          "infinity: always.")
      .def_prop_ro(
          "outgoing_radiance",
          [](Self self) {
            return shownDecision<FloatRows>(self, offsetof(CellDecisions, outgoingRadiance), 3);
          },
          "(cells, 3), float32: mean radiance that a vertex scatters back, or nothing: what a path adds "
          "that\n"
          "roulette ends; one that survives with probability p adds (1 - 1 / p) times as much.")
      .def_prop_ro(
          "learned_light_fractions",
          [](Self self) {
            return shownDecision<Floats>(self, offsetof(CellDecisions, learnedLightFraction), 0);
          },
          "(cells,), float32 in [0, 1): fraction of the choices of a light that follow the cell's table.")
      .def_prop_ro(
          "light_tables",
          [](Self self) {
            const GuideView view = self.p->view();
            const size_t cells = view.lightGroups > 0 ? view.cellCount : 0;
            return shown<NumpyArray<const float, -1, -1>>(self, view.lightTables,
                                                          {cells, size_t(view.lightGroups) + 1});
          },
          "(cells, light_groups + 1), float32: cumulative probabilities of the groups of lights, from 0 to "
          "1,\n"
          "where the fraction is above 0; (0, 1) where nothing was learned about lights.")
      .def_prop_ro(
          "cached_radiance",
          [](Self self) {
            const GuideView view = self.p->view();
            constexpr size_t kFloats = sizeof(CachedRadiance) / sizeof(float);
            const auto* data = reinterpret_cast<const float*>(view.cached);
            return shown<NumpyArray<const float, -1, 2, kFloats>>(
                self, data, {data ? view.cellCount : 0, size_t(2), kFloats});
          },
          "(cells, 2, 4), float32: radiance (3) that a path of each half may end with in a cell, and its\n"
          "standard error; (0, 2, 4) without GuideOptions.cached_error.")
      .def_prop_ro(
          "cached_shares",
          [](Self self) {
            const GuideView view = self.p->view();
            return shown<Floats>(self, view.cachedShares, {size_t(view.cachedShareCount)});
          },
          "(count,), float32 in [0, 1]: what cached radiance is multiplied by where a path may be scattered\n"
          "so many times, here included; 1 beyond, 0: the path goes on. Empty without a max_depth.");
}

void bindRules(nb::module_& module) {
  nb::class_<GuideRules> rules(module, "GuideRules",
                               "The constants of a host's own look-ups (odis/guide_view.h).");
  rules
      .def_prop_ro(
          "roughness_bounds", [](const GuideRules& self) { return std::to_array(self.roughnessBounds); },
          "Lower bounds of the roughness of the classes: diffuse, rough, glossy.")
      .def_prop_ro(
          "least_survival", [](const GuideRules& self) { return self.leastSurvival; },
          "The least probability of survival.")
      .def_prop_ro(
          "full_shadow_ray_contribution",
          [](const GuideRules& self) { return self.fullShadowRayContribution; },
          "Light that adds less than this fraction of the pixel's value gets a shadow ray only sometimes.")
      .def_prop_ro(
          "least_shadow_ray_probability",
          [](const GuideRules& self) { return self.leastShadowRayProbability; },
          "And at least with this probability.")
      .def_prop_ro(
          "cached_error", [](const GuideRules& self) { return self.cachedError; },
          "A path may end with cached radiance whose standard error, times its throughput over the pixel's\n"
          "value, is below this; 0: never.")
      .def_prop_ro(
          "least_cached_footprint", [](const GuideRules& self) { return self.leastCachedFootprint; },
          "And whose footprint is at least this many times the cell's edge.");
  printAttributes(rules, {"roughness_bounds", "least_survival", "full_shadow_ray_contribution",
                          "least_shadow_ray_probability", "cached_error", "least_cached_footprint"});
}

// A guide's file as bytes, for pickle.
nb::bytes bytesOf(const Guide& guide) {
  const TemporaryFile file;
  withoutLock([&] { guide.save(file.path()); });
  return file.read();
}
void guideOfBytes(Guide& guide, const nb::bytes& bytes) {
  const TemporaryFile file;
  file.write(bytes);
  const Context& context = contextOrShared(nullptr);
  new (&guide) Guide(withoutLock([&] { return Guide::load(file.path(), context); }));
}

}  // namespace

void bindGuide(nb::module_& module) {
  bindRules(module);
  nb::class_<Guide> guide(
      module, "Guide", R"(What was learned: nested cells in world space, a sampling map and decisions in each.

Fixed once built, and safe to use by many threads; copies are the guide itself. It can be pickled, and comes
back in the shared context. Its arrays are read-only, lie in the guide's own memory,
and keep it alive. About 610 bytes a cell.)");
  guide
      .def(
          "__len__", [](const Guide& self) { return self.view().cellCount; }, "Number of cells.")
      .def_prop_ro("bytes", &Guide::bytes, "What it holds.")
      .def(
          "save", [](const Guide& self, const std::filesystem::path& path) { self.save(path.string()); },
          "path"_a, "Writes a file, which `odis inspect` shows. Raises Error (FILE).")
      .def_static(
          "load",
          [](const std::filesystem::path& path, const LoggingContext* context) {
            return Guide::load(path.string(), contextOrShared(context));
          },
          "path"_a, "context"_a = nb::none(), "The guide of a file. Raises Error (FILE).")
      .def("__getstate__", bytesOf)
      .def("__setstate__", guideOfBytes)
      .def("__copy__", [](nb::object self) { return self; })
      .def("__deepcopy__", [](nb::object self, const nb::handle&) { return self; })
      .def("__repr__",
           [](nb::handle self) {
             return "<odis.Guide: " + std::to_string(nb::len(self)) + " cells, " +
                    attributesOf(self, {"finest_edge", "light_groups", "predicted_variance_ratio", "bytes"}) +
                    ">";
           })
      .def_prop_ro("predicted_variance_ratio", &Guide::predictedVarianceRatio,
                   "The variance of a guided sample that the pilot predicts, as a ratio to an unguided one.")
      .def_prop_ro(
          "light_groups", [](const Guide& self) { return self.view().lightGroups; },
          "Number of groups of lights that it knows of.")
      .def_prop_ro(
          "finest_edge", [](const Guide& self) { return 1 / self.view().grid.inverseEdge; },
          "Edge of the finest cells, in world space, twice as long in media; those of the next levels are\n"
          "twice as long, each.")
      .def_prop_ro(
          "origin",
          [](const Guide& self) {
            const Float3 origin = self.view().grid.origin;
            return std::array<float, 3>{origin.x, origin.y, origin.z};
          },
          "Corner of the cells whose coordinates are 0, in world space.")
      .def_prop_ro(
          "rules", [](const Guide& self) { return self.view().rules; },
          "The constants of the rules that a host's own look-ups follow.");
  bindMaps(guide);
  bindDecisions(guide);
  bindLookups(guide);
}

}  // namespace odis::python
