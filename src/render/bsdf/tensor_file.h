// Mitsuba's tensor files (".bsdf", ".pbsdf"): named arrays of numbers.
//
// The file: the 12 bytes "tensor_file" and a zero, the version (uint8 major 1, minor 0), the number of fields
// (uint32); of each field its name (uint16 length, bytes), its number of dimensions (uint16), its type
// (uint8), where its values begin (uint64, bytes from the start of the file) and its shape (uint64 each).
// Values are stored row by row, the last dimension fastest. All is little-endian.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "render/shape/file_bytes.h"

namespace odis::render {

class TensorFile {
 public:
  enum class Type : uint8_t { uint8 = 1, uint16 = 3, float32 = 10 };

  // Throws SceneError: at `at` if the file can't be read, in the file if it is none of these.
  TensorFile(const std::string& path, const SourceLocation& at);

  bool has(const std::string& name) const { return m_fields.count(name) > 0; }
  // The sizes along each dimension. All of the following throw SceneError if there is no such field.
  const std::vector<uint64_t>& shape(const std::string& name) const { return field(name).shape; }
  // The values, which must be of this type and lie within the file.
  std::vector<float> floats(const std::string& name) const;
  std::vector<uint16_t> shorts(const std::string& name) const;
  std::vector<uint8_t> bytes(const std::string& name) const;
  // Values of a field of floats one by one, without a copy of them all: checked like floats().
  class FloatView {
   public:
    explicit FloatView(const char* values) : m_values(values) {}
    float operator[](uint64_t index) const;

   private:
    const char* m_values;
  };
  FloatView view(const std::string& name) const;

  // Throws SceneError: "NAME holds FOUND, expected EXPECTED".
  [[noreturn]] void refuse(const std::string& name, const std::string& found,
                           const std::string& expected) const;
  // The shape as "3 x 4", for messages.
  std::string shapeText(const std::string& name) const;

 private:
  struct Field {
    std::vector<uint64_t> shape;
    uint8_t type = 0;
    uint64_t offset = 0;
  };
  const Field& field(const std::string& name) const;
  const char* values(const std::string& name, Type type, uint64_t& count) const;
  template <class T>
  std::vector<T> copy(const std::string& name, Type type) const;

  SourceLocation m_at;
  FileBytes m_bytes;
  std::map<std::string, Field> m_fields;
};

}  // namespace odis::render
