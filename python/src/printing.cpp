#include "printing.h"

#include <nanobind/stl/string.h>

namespace odis::python {

std::string attributesOf(nb::handle object, const std::vector<const char*>& names) {
  std::string text;
  for (const char* name : names) {
    const nb::object value = object.attr(name);
    const bool isNumber = PyFloat_Check(value.ptr());
    text.append(text.empty() ? "" : ", ").append(name).append("=");
    const nb::object shown =
        isNumber ? nb::object(nb::str("{:.6g}").attr("format")(value)) : nb::object(nb::repr(value));
    text += nb::cast<std::string>(shown);
  }
  return text;
}

}  // namespace odis::python
