// Objects as bytes: for pickle, which wants no files, while the library writes and reads files alone.
#pragma once

#include <string>

#include "bindings.h"

namespace odis::python {

// A file that is removed with this object. Of the interpreter's lock it needs all calls.
class TemporaryFile {
 public:
  TemporaryFile();
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::string& path() const { return m_path; }
  nb::bytes read() const;
  void write(const nb::bytes& bytes) const;

 private:
  nb::object m_folder;
  std::string m_path;
};

}  // namespace odis::python
