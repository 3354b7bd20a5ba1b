#include "learn/data/shard_header.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "render/files/read_json.h"

namespace odis::learn {

namespace {

// Magic, format, length of the header, its CRC-32.
constexpr size_t kPrefix = 8 + 3 * 4;

uint32_t wordAt(std::string_view bytes, size_t at) {
  uint32_t word;
  std::memcpy(&word, bytes.data() + at, sizeof(word));
  return word;
}

size_t sizeOfElement(const std::string& type) {
  if (type == "|u1") return 1;
  if (type == "<u2" || type == "<f2") return 2;
  return type == "<u4" || type == "<i4" || type == "<f4" ? 4 : 0;
}

}  // namespace

uint64_t elementCount(const Shape& shape) {
  uint64_t count = 1;
  for (const uint64_t n : shape) {
    if (n != 0 && count > kMostArrayBytes / n) return kMostArrayBytes + 1;
    count *= n;
  }
  return count;
}

uint32_t crc32(std::string_view bytes) {
  return uint32_t(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

ShardHeader::ShardHeader(const std::string& path) : m_path(path) {
  try {
    render::InputFile file(path);
    const auto read = [&](uint64_t size) {
      std::string bytes(size, '\0');
      file.read(bytes.data(), size);
      return bytes;
    };
    const std::string prefix = read(std::min<uint64_t>(kPrefix, file.size()));
    parsePrefix(prefix, file.size());
    parse(read(m_end - kPrefix), wordAt(prefix, 16), file.size() - m_end);
  } catch (const render::ReadError& error) {
    throw ShardError(fmt::format("{}: cannot be read: {}", path, error.what()));
  }
}

ShardHeader::ShardHeader(const std::string& path, std::string_view file) : m_path(path) {
  parsePrefix(file, file.size());
  parse(file.substr(kPrefix, m_end - kPrefix), wordAt(file, 16), file.size() - m_end);
}

void ShardHeader::parsePrefix(std::string_view prefix, uint64_t fileSize) {
  if (prefix.size() < kPrefix || !prefix.starts_with(kShardMagic))
    throw ShardError(
        fmt::format("{}: is no shard of a data set, expected it to begin with {}", m_path, kShardMagic));
  if (wordAt(prefix, 8) != kShardFormat)
    throw ShardError(
        fmt::format("{}: found format {}, expected {}", m_path, wordAt(prefix, 8), kShardFormat));
  m_end = kPrefix + uint64_t(wordAt(prefix, 12));
  if (m_end > fileSize)
    throw ShardError(
        fmt::format("{}: is cut off: found {} bytes, expected at least {}", m_path, fileSize, m_end));
}

void ShardHeader::parse(std::string_view text, uint32_t crc, uint64_t size) {
  if (crc32(text) != crc)
    throw ShardError(fmt::format("{}: the header is damaged: its CRC-32 is {:08x}, expected {:08x}", m_path,
                                 crc32(text), crc));
  try {
    m_header = render::parseJson<nlohmann::json>(text);
    parseArrays(size);
  } catch (const render::ReadError& e) {
    throw ShardError(fmt::format("{}: the header is not as expected: {}", m_path, e.what()));
  } catch (const nlohmann::json::exception& e) {
    throw ShardError(fmt::format("{}: the header is not as expected: {}", m_path, render::jsonReason(e)));
  }
}

void ShardHeader::parseArrays(uint64_t size) {
  uint64_t expected = 0;
  for (const auto& [name, json] : m_header.at("arrays").items()) {
    Array array;
    json.at("type").get_to(array.type);
    for (const nlohmann::json& n : json.at("shape").get_ref<const nlohmann::json::array_t&>())
      array.shape.push_back(render::wholeNumber(n));
    array.offset = render::wholeNumber(json.at("offset"));
    array.bytes = render::wholeNumber(json.at("bytes"));
    array.elementSize = sizeOfElement(array.type);
    array.elements = elementCount(array.shape);
    if (array.elementSize == 0)
      throw ShardError(fmt::format("{}: {}: found the type \"{}\", expected |u1, <u2, <u4, <i4 or <f2",
                                   m_path, name, array.type));
    if (array.elements > kMostArrayBytes / array.elementSize)
      throw ShardError(fmt::format("{}: {}: is larger than any array may be", m_path, name));
    if (array.bytes > size || array.offset > size - array.bytes)
      throw ShardError(fmt::format("{}: {}: is cut off", m_path, name));
    expected = std::max(expected, array.offset + array.bytes);
    m_arrays.emplace_back(name, array);
  }
  if (expected != size)
    throw ShardError(fmt::format("{}: found {} bytes of arrays, expected {}", m_path, size, expected));
}

std::vector<std::pair<std::string, uint64_t>> ShardHeader::arrays() const {
  std::vector<std::pair<std::string, uint64_t>> result;
  for (const auto& [name, array] : m_arrays) result.emplace_back(name, array.bytes);
  return result;
}

const ShardHeader::Array& ShardHeader::find(const std::string& name) const {
  const auto found =
      std::find_if(m_arrays.begin(), m_arrays.end(), [&](const auto& entry) { return entry.first == name; });
  if (found == m_arrays.end()) throw ShardError(fmt::format("{}: has no array {}", m_path, name));
  return found->second;
}

}  // namespace odis::learn
