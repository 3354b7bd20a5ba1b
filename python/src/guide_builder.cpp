#include <nanobind/stl/optional.h>
#include <nanobind/stl/variant.h>

#include <optional>

#include "calls.h"
#include "context.h"
#include "vertices.h"

namespace odis::python {

namespace {

GuideOptions interruptible(const std::optional<GuideOptions>& given) {
  GuideOptions options = given ? *given : GuideOptions();
  options.progressFunction = goOn;
  return options;
}

class Builder {
 public:
  Builder(const std::optional<GuideOptions>& options, const LoggingContext* context)
      : m_builder(interruptible(options), contextOrShared(context)) {}

  void add(const VerticesArgument& given) {
    const VertexArrays vertices = vertexArrays(given);
    callAlone(m_calls, [&] { m_builder.add(vertices.described()); });
  }
  Guide build(const VerticesArgument& given, const std::optional<Array>& pixelValues) {
    const VertexArrays vertices = vertexArrays(given);
    std::vector<float> values;
    if (pixelValues) {
      const Rows<float> rows(*pixelValues, "pixel_values");
      for (size_t i = 0; i < rows.size(); ++i) values.push_back(rows(i));
    }
    return callAlone(m_calls, [&] { return m_builder.build(vertices.described(), values); });
  }
  Guide rebuild(const Guide& previous) {
    return callAlone(m_calls, [&] { return m_builder.rebuild(previous); });
  }
  VertexCounts vertexCounts() {
    return callAlone(m_calls, [&] { return m_builder.vertexCounts(); });
  }
  uint64_t bytes() {
    return callAlone(m_calls, [&] { return m_builder.bytes(); });
  }

 private:
  GuideBuilder m_builder;
  Calls m_calls;
};

}  // namespace

void bindGuideBuilder(nb::module_& module) {
  nb::class_<Builder>(module, "GuideBuilder", R"(Gathers path vertices and builds guides from them.

For hosts that keep the order of an image themselves; Frame has a builder of its own. A builder does one
thing at a time: a call while another thread's is under way raises Error (INVALID_OPERATION).)")
      .def(nb::init<const std::optional<GuideOptions>&, const LoggingContext*>(), "options"_a = nb::none(),
           "context"_a = nb::none(), "Raises Error (INVALID_ARGUMENT) for an option out of its range.")
      .def("add", &Builder::add, "vertices"_a, R"(Adds vertices: PathVertices, or a dict of its fields.

The first call fixes the extent of the cells, so it should hold at least one pass over the image. Vertices of
guided paths may be added, too, their pdf being the mixture's. Ctrl-C raises KeyboardInterrupt where a guide
is built, not here.)")
      .def("build", &Builder::build, "vertices"_a, "pixel_values"_a = nb::none(),
           R"(Builds a guide: maps from all that was added, BSDF sampling fractions from `vertices`.

vertices: PathVertices, or a dict of its fields; (a part of) what was added, without those of guided paths.
pixel_values: float32 of shape (pixels,), indexed by the vertices' `pixel`: luminances that their
    contributions are divided by. None: contributions are taken as they are.)")
      .def("rebuild", &Builder::rebuild, "previous"_a,
           R"(Builds a guide from all that was added by now, with the BSDF sampling fractions of `previous`.

previous: a Guide of this builder. Cells that are new have their parents' fractions.)")
      .def_prop_ro("vertex_counts", &Builder::vertexCounts, "VertexCounts of all that was added.")
      .def_prop_ro("bytes", &Builder::bytes, "Held at most while guides are built, vertices not included.");
}

}  // namespace odis::python
