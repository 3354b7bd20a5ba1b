// The Python module: each function adds some classes of the interface in include/odis to it.
#pragma once

#include <nanobind/nanobind.h>

namespace nb = nanobind;
using namespace nb::literals;  // NOLINT: "name"_a is how nanobind names parameters

namespace odis::python {

void bindErrors(nb::module_& module);
void bindContext(nb::module_& module);
void bindModel(nb::module_& module);
void bindOptions(nb::module_& module);
void bindVertices(nb::module_& module);
void bindGuide(nb::module_& module);
void bindGuideBuilder(nb::module_& module);
void bindFrame(nb::module_& module);

}  // namespace odis::python
