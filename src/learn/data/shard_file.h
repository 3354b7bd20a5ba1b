// The container of the data set: named arrays in one file, each compressed by itself. docs/dataset-format.md
// describes it for readers in other languages.
#pragma once

#include <half.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace odis::learn {

using Half = Imath::half;

// A file that is no shard, or a damaged one. Names the file, and the array where it is one.
class ShardError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The element types, named as numpy does.
template <class T>
inline constexpr const char* kElementName = nullptr;
template <>
inline constexpr const char* kElementName<uint8_t> = "|u1";
template <>
inline constexpr const char* kElementName<uint16_t> = "<u2";
template <>
inline constexpr const char* kElementName<uint32_t> = "<u4";
template <>
inline constexpr const char* kElementName<int32_t> = "<i4";
template <>
inline constexpr const char* kElementName<Half> = "<f2";
template <>
inline constexpr const char* kElementName<float> = "<f4";

using Shape = std::vector<uint64_t>;

// Gathers arrays, then writes them.
class ShardWriter {
 public:
  // In C order. Throws std::logic_error if the shape has not as many elements as there are values.
  template <class T>
  void add(const std::string& name, const Shape& shape, std::span<const T> values) {
    addBytes(name, kElementName<T>, shape, std::as_bytes(values), sizeof(T));
  }
  // Writes the file under a temporary name and renames it. `header` is what else there is to say, an object. Throws
  // WriteError.
  void write(const std::string& path, nlohmann::ordered_json header) const;

 private:
  void addBytes(const std::string& name, const char* type, const Shape& shape,
                std::span<const std::byte> bytes, size_t elementSize);

  nlohmann::ordered_json m_arrays = nlohmann::ordered_json::object();
  std::string m_frames;  // of all arrays, one after the other
};

// Reads the header at once, arrays as they are asked for.
class ShardReader {
 public:
  // Throws ShardError.
  explicit ShardReader(const std::string& path);
  // The same of a file in memory; `path` is what errors name.
  ShardReader(const std::string& path, std::string bytes);

  const nlohmann::json& header() const { return m_header; }
  // Throw ShardError if there is no such array or if it is of another type.
  const Shape& shape(const std::string& name) const { return find(name).shape; }
  template <class T>
  std::vector<T> read(const std::string& name) const {
    const Array& array = find(name, kElementName<T>);
    std::vector<T> result(array.elements);
    unpack(name, array, std::as_writable_bytes(std::span(result)));
    return result;
  }
  // The arrays' names, and how many bytes each takes in the file.
  std::vector<std::pair<std::string, uint64_t>> arrays() const;
  // Unpacks everything; throws ShardError for the first array that is damaged.
  void verify() const;

 private:
  struct Array {
    std::string type;
    Shape shape;
    uint64_t elements = 0, offset = 0, bytes = 0;
    size_t elementSize = 1;
  };
  void parse();
  const Array& find(const std::string& name, const char* type = nullptr) const;
  void unpack(const std::string& name, const Array& array, std::span<std::byte> values) const;

  std::string m_path, m_bytes;
  nlohmann::json m_header;
  std::vector<std::pair<std::string, Array>> m_arrays;
};

// An array of which there must be one element, or several, for each of `count`. Throws ShardError.
template <class T>
std::vector<T> readColumn(const ShardReader& reader, const std::string& name, size_t count, size_t each = 1) {
  std::vector<T> values = reader.read<T>(name);
  if (values.size() != count * each)
    throw ShardError(name + ": found " + std::to_string(values.size()) + " elements, expected " +
                     std::to_string(count * each));
  return values;
}

// The CRC-32 of bytes, as zlib and gzip have it.
uint32_t crc32(std::string_view bytes);

// The bytes of a file. Throws ShardError.
std::string shardBytes(const std::string& path);

}  // namespace odis::learn
