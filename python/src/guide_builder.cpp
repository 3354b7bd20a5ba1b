#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include "guide_builder.h"

namespace odis::python {

namespace {

void bindLearning(nb::class_<Builder>& builder) {
  builder
      .def("add", &Builder::add, "vertices"_a, "guided"_a = false,
           R"(Adds vertices: PathVertices, or a dict of its fields.

The first call fixes the extent of the cells, so it should hold at least one pass over the image.
guided: whether a guide helped to sample these paths, their pdf being the mixture's; BSDF sampling fractions
    are chosen by those of unguided paths alone.
Ctrl-C raises KeyboardInterrupt where a guide is built, not here.)")
      .def("build", &Builder::build, "pixel_values"_a = nb::none(),
           R"(Builds a guide from all that was added.

pixel_values: float32 of shape (pixels,), indexed by the vertices' `pixel`: luminances that their
    contributions are divided by. None: by those of an even image with the mean of all paths.
    Raises Error (INVALID_ARGUMENT) where a vertex has a pixel beyond them.)")
      .def("rebuild", &Builder::rebuild, "previous"_a,
           R"(Builds a guide from all that was added by now, with the BSDF sampling fractions of `previous`.

previous: a Guide whose cells have the same extent as this builder's. Cells that are new have their parents'
    fractions.)")
      .def("fade", &Builder::fade, "weight"_a,
           R"(Lets what was added count `weight` times from now on, in [0, 1].

Between two frames of an animation that learn into this builder. Cells that are left with next to nothing are
forgotten, so memory follows what the last frames saw. Give each frame a seed of its own.)")
      .def("forget", &Builder::forget, "Forgets all that was added and merged, and the extent of the cells.")
      .def("set_bounds", &Builder::setBounds, "lower"_a, "upper"_a,
           R"(Fixes the extent of the cells in place of what the first vertices span.

lower, upper: three floats each, corners of a box in world space. What cells have seen moves with them, to the
cell around the mean of its vertices' positions.)");
}

}  // namespace

void bindGuideBuilder(nb::module_& module) {
  nb::class_<Builder> builder(module, "GuideBuilder", R"(Gathers path vertices and builds guides from them.

For hosts that keep the order of an image themselves, and for frames that go on learning where earlier ones
ended (Frame's `builder`); other frames have builders of their own. A builder does one
thing at a time: a call while another thread's is under way raises Error (INVALID_OPERATION). Builders can be
copied, and pickled: they come back in the shared context. One with a model of its own comes back from
copies alone; unpickling raises Error (FILE), and save and load with `model` are the way.)");
  bindLearning(builder);
  builder
      .def(nb::init<const std::optional<GuideOptions>&, const LoggingContext*>(), "options"_a = nb::none(),
           "context"_a = nb::none(), "Raises Error (INVALID_ARGUMENT) for an option out of its range.")
      .def_static(
          "load", &Builder::load, "path"_a, "model"_a = nb::none(), "context"_a = nb::none(),
          R"(A builder that was saved, with the model that it had (None: the networks that come with ODIS).

Raises Error (FILE) for what is no saved builder or has another model.)")
      .def("save", &Builder::save, "path"_a, R"(Writes the options and all that was added and merged.

Raises Error (FILE) where it can't be written.)")
      .def("set_part_id", &Builder::setPartId, "id"_a,
           R"(The id of what is added to this builder, 0 at first: an int from 0 to 2**64 - 1.

Raises Error (INVALID_ARGUMENT) where a part that was merged has it.)")
      .def("merge", &Builder::merge, "builders"_a,
           R"(Takes copies of what other builders hold, in any order and nesting with the same result.

builders: a list of GuideBuilder. Raises Error (INVALID_ARGUMENT), and changes nothing, where they differ in
an option, the model or the extent of their cells (set_bounds), or where two have the same id.)")
      .def_prop_ro("vertex_counts", &Builder::vertexCounts, "VertexCounts of all that was added.")
      .def_prop_ro("bytes", &Builder::bytes, "Held at most while guides are built, vertices not included.")
      .def("__getstate__", &Builder::state)
      .def("__setstate__", &Builder::setState)
      .def("__copy__", &Builder::copy)
      .def("__deepcopy__", [](Builder& self, const nb::handle&) { return self.copy(); })
      .def("__repr__", &Builder::text);
}

}  // namespace odis::python
