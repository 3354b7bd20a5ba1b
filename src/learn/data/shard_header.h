// How a shard of the data set begins: magic number, format, and a header in JSON that says what arrays
// follow. docs/dataset-format.md describes it for readers in other languages.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace odis::learn {

// A file that is no shard, or a damaged one. Names the file, and the array where it is one.
class ShardError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline constexpr std::string_view kShardMagic = "ODISDATA";
inline constexpr uint32_t kShardFormat = 1;
// No array is larger: a damaged header must not make anyone ask for all memory.
inline constexpr uint64_t kMostArrayBytes = 1u << 28;

using Shape = std::vector<uint64_t>;

// How many elements an array of this shape has; kMostArrayBytes + 1 stands for all larger numbers.
uint64_t elementCount(const Shape& shape);

// What a shard says of itself. The file is as long as the header says; damage in its arrays is for those
// who read them to find.
class ShardHeader {
 public:
  // Reads no further than the header goes. Throws ShardError.
  explicit ShardHeader(const std::string& path);
  // The same of a file in memory; `path` is what errors name.
  ShardHeader(const std::string& path, std::string_view file);

  const std::string& path() const { return m_path; }
  const nlohmann::json& header() const { return m_header; }
  // Throws ShardError if there is no such array.
  const Shape& shape(const std::string& name) const { return find(name).shape; }
  // The arrays' names, and how many bytes each takes in the file.
  std::vector<std::pair<std::string, uint64_t>> arrays() const;

 protected:
  struct Array {
    std::string type;
    Shape shape;
    uint64_t elements = 0, offset = 0, bytes = 0;
    size_t elementSize = 1;
  };
  const Array& find(const std::string& name) const;

  std::string m_path;
  uint64_t m_end = 0;  // where the arrays begin in the file
  nlohmann::json m_header;
  std::vector<std::pair<std::string, Array>> m_arrays;

 private:
  // What is before the header: sets m_end.
  void parsePrefix(std::string_view prefix, uint64_t fileSize);
  // `size` bytes of arrays follow.
  void parse(std::string_view text, uint32_t crc, uint64_t size);
  void parseArrays(uint64_t size);
};

// The CRC-32 of bytes, as zlib and gzip have it.
uint32_t crc32(std::string_view bytes);

}  // namespace odis::learn
