#include "saved_bytes.h"

#include <nanobind/stl/string.h>

namespace odis::python {

TemporaryFile::TemporaryFile()
    : m_folder(nb::module_::import_("tempfile").attr("TemporaryDirectory")("", "odis-")),
      m_path(nb::cast<std::string>(nb::object(m_folder.attr("name"))) + "/saved") {}

TemporaryFile::~TemporaryFile() {
  try {
    m_folder.attr("cleanup")();
  } catch (nb::python_error& error) {
    error.discard_as_unraisable("a temporary file of odis");
  }
}

nb::bytes TemporaryFile::read() const {
  return nb::cast<nb::bytes>(nb::module_::import_("pathlib").attr("Path")(m_path).attr("read_bytes")());
}

void TemporaryFile::write(const nb::bytes& bytes) const {
  nb::module_::import_("pathlib").attr("Path")(m_path).attr("write_bytes")(bytes);
}

}  // namespace odis::python
