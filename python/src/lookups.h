#pragma once

#include <odis/odis.hpp>

#include "bindings.h"

namespace odis::python {

// What a host asks a guide at its vertices, for many at once.
void bindLookups(nb::class_<Guide>& guide);
// Tables for hosts that look up in kernels of their own.

}  // namespace odis::python
