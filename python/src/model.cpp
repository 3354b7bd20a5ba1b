#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>

#include <odis/odis.hpp>

#include "bindings.h"
#include "context.h"

namespace odis::python {

void bindModel(nb::module_& module) {
  nb::class_<Model>(module, "Model", "What turns statistics of cells into decisions: networks, or formulas.")
      .def(
          "__init__",
          [](Model* self, const LoggingContext* context) { new (self) Model(contextOrShared(context)); },
          "context"_a = nb::none(), "The networks that come with the library.")
      .def_static(
          "from_file",
          [](const std::filesystem::path& path, const LoggingContext* context) {
            return Model::load(path.string(), contextOrShared(context));
          },
          "path"_a, "context"_a = nb::none(), "The networks of a file of weights. Raises Error (FILE).")
      .def_static(
          "from_bytes",
          [](const nb::bytes& data, const LoggingContext* context) {
            return Model(odisNewModelFromMemory(contextOrShared(context).get(), data.data(), data.size()));
          },
          "data"_a, "context"_a = nb::none(), "The networks of a file's bytes. Raises Error (FILE).")
      .def("with_direction_formula", &Model::withDirectionFormula,
           "A model like this one, with a formula instead of the network for directions.")
      .def("with_pixel_network", &Model::withPixelNetwork, "name"_a,
           "A model like this one, with a network for maps at pixels of those that come with ODIS: "
           "\"paper\",\n"
           "say. Raises Error (FILE) where ODIS was built without oneDNN.")
      .def("with_light_formula", &Model::withLightFormula,
           "A model like this one, with a formula instead of the network for the choice of lights.");
}

}  // namespace odis::python
