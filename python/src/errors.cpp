// odis.Error and its codes.
#include <odis/odis.hpp>

#include "bindings.h"

namespace odis::python {

namespace {

// Raises odis.Error for an exception of the library.
void translate(const std::exception_ptr& thrown, void* type) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Error& error) {
    const nb::handle errorType(static_cast<PyObject*>(type));
    const nb::object raised = errorType(error.what());
    raised.attr("code") = error.code();
    PyErr_SetObject(errorType.ptr(), raised.ptr());
  }
}

}  // namespace

void bindErrors(nb::module_& module) {
  nb::enum_<OdisError>(module, "ErrorCode", "Why the library refused.")
      .value("UNKNOWN", ODIS_ERROR_UNKNOWN, "A mistake of the library's.")
      .value("INVALID_ARGUMENT", ODIS_ERROR_INVALID_ARGUMENT, "A value out of its range.")
      .value("INVALID_OPERATION", ODIS_ERROR_INVALID_OPERATION, "Calls in the wrong order.")
      .value("OUT_OF_MEMORY", ODIS_ERROR_OUT_OF_MEMORY, "No memory, or the context's limit of it is reached.")
      .value("CANCELLED", ODIS_ERROR_CANCELLED, "Called off.")
      .value("FILE", ODIS_ERROR_FILE, "A file that can't be read, or is not what was expected.");
  const nb::exception<Error> error(module, "Error", PyExc_RuntimeError);
  error.attr("__doc__") = "What is raised where the library refuses; `code` says why (ErrorCode).";
  error.attr("code") = ODIS_ERROR_UNKNOWN;
  nb::register_exception_translator(translate, error.ptr());
}

}  // namespace odis::python
