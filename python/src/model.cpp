#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>

#include <cstdio>
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
      .def("__repr__",
           [](const Model& self) {
             char text[64];  // the same for all objects of Python that stand for this model
             std::snprintf(text, sizeof text, "<odis.Model at %p>", static_cast<const void*>(self.get()));
             return std::string(text);
           })
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
          "data"_a, "context"_a = nb::none(), "The networks of a file's bytes. Raises Error (FILE).");
}

}  // namespace odis::python
