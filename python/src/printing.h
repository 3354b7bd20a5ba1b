// How objects print themselves.
#pragma once

#include <string>
#include <vector>

#include "bindings.h"

namespace odis::python {

// "NAME=VALUE, NAME=VALUE, ..." of some attributes of an object; numbers with six digits.
std::string attributesOf(nb::handle object, const std::vector<const char*>& names);

// Lets a class print itself as "odis.CLASS(NAME=VALUE, ...)".
template <class Class>
void printAttributes(Class& bound, std::vector<const char*> names) {
  bound.def("__repr__", [names = std::move(names)](nb::handle self) {
    const std::string type = nb::cast<std::string>(nb::object(self.type().attr("__name__")));
    return "odis." + type + "(" + attributesOf(self, names) + ")";
  });
}

}  // namespace odis::python
