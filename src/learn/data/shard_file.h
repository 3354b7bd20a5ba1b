// The container of the data set: named arrays in one file behind a header, each compressed by itself.
#pragma once

#include <half.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "learn/data/shard_header.h"

namespace odis::learn {

using Half = Imath::half;

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

// Gathers arrays, then writes them.
class ShardWriter {
 public:
  // In C order. Throws std::logic_error if the shape has not as many elements as there are values.
  template <class T>
  void add(const std::string& name, const Shape& shape, std::span<const T> values) {
    addBytes(name, kElementName<T>, shape, std::as_bytes(values), sizeof(T));
  }
  // Writes the file under a temporary name and renames it. `header` is what else there is to say, an
  // object. Throws WriteError.
  void write(const std::string& path, nlohmann::ordered_json header) const;

 private:
  void addBytes(const std::string& name, const char* type, const Shape& shape,
                std::span<const std::byte> bytes, size_t elementSize);

  nlohmann::ordered_json m_arrays = nlohmann::ordered_json::object();
  std::string m_frames;  // of all arrays, one after the other
};

// Reads the file at once, unpacks arrays as they are asked for.
class ShardReader : public ShardHeader {
 public:
  // Throws ShardError.
  explicit ShardReader(const std::string& path);
  // The same of a file in memory; `path` is what errors name.
  ShardReader(const std::string& path, std::string bytes);

  // Throws ShardError if there is no such array, if it is of another type or damaged.
  template <class T>
  std::vector<T> read(const std::string& name) const {
    const Array& array = find(name, kElementName<T>);
    std::vector<T> result(array.elements);
    unpack(name, array, std::as_writable_bytes(std::span(result)));
    return result;
  }
  // Unpacks everything; throws ShardError for the first array that is damaged.
  void verify() const;

 private:
  const Array& find(const std::string& name, const char* type) const;
  void unpack(const std::string& name, const Array& array, std::span<std::byte> values) const;

  std::string m_bytes;  // of the whole file
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

// The bytes of a file. Throws ShardError.
std::string shardBytes(const std::string& path);

}  // namespace odis::learn
