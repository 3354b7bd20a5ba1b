#include "learn/data/shard_file.h"

#include <fmt/format.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <memory>

#include "render/image/checked_stream.h"
#include "render/image/replace_file.h"

namespace odis::learn {

static_assert(std::endian::native == std::endian::little, "elements are written as they lie in memory");

namespace {

constexpr std::string_view kMagic = "ODISDATA";
constexpr uint32_t kFormat = 1;
// Magic, format, length of the header, its CRC-32.
constexpr size_t kPrefix = 8 + 3 * 4;
constexpr int kLevel = 3;  // of compression
// No array is larger: a damaged header must not make anyone ask for all memory.
constexpr uint64_t kMostBytes = 1u << 28;

uint32_t wordAt(const std::string& bytes, size_t at) {
  uint32_t word;
  std::memcpy(&word, bytes.data() + at, sizeof(word));
  return word;
}

size_t sizeOfElement(const std::string& type) {
  if (type == "|u1") return 1;
  if (type == "<u2" || type == "<f2") return 2;
  return type == "<u4" || type == "<i4" || type == "<f4" ? 4 : 0;
}

uint64_t countOf(const Shape& shape) {
  uint64_t count = 1;
  for (const uint64_t n : shape) {
    if (n != 0 && count > kMostBytes / n) return kMostBytes + 1;
    count *= n;
  }
  return count;
}

}  // namespace

uint32_t crc32(std::string_view bytes) {
  return uint32_t(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::string shardBytes(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw ShardError(fmt::format("{}: cannot be opened: {}", path, std::strerror(errno)));
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (stream.bad()) throw ShardError(fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
  return bytes;
}

// The lowest bytes of all elements come first, then the next ones: like stands beside like, which compresses better.
void ShardWriter::addBytes(const std::string& name, const char* type, const Shape& shape,
                           std::span<const std::byte> bytes, size_t elementSize) {
  const size_t count = bytes.size() / elementSize;
  if (countOf(shape) != count || bytes.size() > kMostBytes)
    throw std::logic_error("the shape of " + name + " does not fit its values");
  std::vector<std::byte> planes(bytes.size());
  for (size_t i = 0; i < count; ++i)
    for (size_t b = 0; b < elementSize; ++b) planes[b * count + i] = bytes[i * elementSize + b];

  const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(), &ZSTD_freeCCtx);
  if (!context) throw std::bad_alloc();
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kLevel);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  std::string frame(ZSTD_compressBound(planes.size()), '\0');
  const size_t size = ZSTD_compress2(context.get(), frame.data(), frame.size(), planes.data(), planes.size());
  if (ZSTD_isError(size)) throw std::runtime_error(fmt::format("{}: {}", name, ZSTD_getErrorName(size)));
  m_arrays[name] = {{"type", type}, {"shape", shape}, {"offset", m_frames.size()}, {"bytes", size}};
  m_frames.append(frame, 0, size);
}

void ShardWriter::write(const std::string& path, nlohmann::ordered_json header) const {
  header["arrays"] = m_arrays;
  const std::string text = header.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  const uint32_t words[3] = {kFormat, uint32_t(text.size()), crc32(text)};
  render::replaceFile(path, [&](const std::string& temporary) {
    render::CheckedStream stream(temporary);
    stream.write(kMagic.data(), std::streamsize(kMagic.size()));
    stream.write(reinterpret_cast<const char*>(words), sizeof(words));
    stream.write(text.data(), std::streamsize(text.size()));
    stream.write(m_frames.data(), std::streamsize(m_frames.size()));
    stream.close();
  });
}

ShardReader::ShardReader(const std::string& path) : ShardReader(path, shardBytes(path)) {}

ShardReader::ShardReader(const std::string& path, std::string bytes)
    : m_path(path), m_bytes(std::move(bytes)) {
  if (m_bytes.size() < kPrefix || m_bytes.compare(0, kMagic.size(), kMagic) != 0)
    throw ShardError(
        fmt::format("{}: is no shard of a data set, expected it to begin with {}", path, kMagic));
  if (wordAt(m_bytes, 8) != kFormat)
    throw ShardError(fmt::format("{}: found format {}, expected {}", path, wordAt(m_bytes, 8), kFormat));
  const size_t length = wordAt(m_bytes, 12);
  if (length > m_bytes.size() - kPrefix)
    throw ShardError(fmt::format("{}: is cut off: found {} bytes, expected at least {}", path, m_bytes.size(),
                                 kPrefix + length));
  const std::string_view text = std::string_view(m_bytes).substr(kPrefix, length);
  if (crc32(text) != wordAt(m_bytes, 16))
    throw ShardError(fmt::format("{}: the header is damaged: its CRC-32 is {:08x}, expected {:08x}", path,
                                 crc32(text), wordAt(m_bytes, 16)));
  m_header = nlohmann::json::parse(text, nullptr, false);
  m_bytes.erase(0, kPrefix + length);
  try {
    parse();
  } catch (const nlohmann::json::exception& e) {
    throw ShardError(fmt::format("{}: the header is not as expected: {}", path, e.what()));
  }
}

void ShardReader::parse() {
  uint64_t expected = 0;
  for (const auto& [name, json] : m_header.at("arrays").items()) {
    Array array;
    json.at("type").get_to(array.type);
    json.at("shape").get_to(array.shape);
    json.at("offset").get_to(array.offset);
    json.at("bytes").get_to(array.bytes);
    array.elementSize = sizeOfElement(array.type);
    array.elements = countOf(array.shape);
    if (array.elementSize == 0)
      throw ShardError(fmt::format("{}: {}: found the type \"{}\", expected |u1, <u2, <u4, <i4 or <f2",
                                   m_path, name, array.type));
    if (array.elements > kMostBytes / array.elementSize)
      throw ShardError(fmt::format("{}: {}: is larger than any array may be", m_path, name));
    if (array.bytes > m_bytes.size() || array.offset > m_bytes.size() - array.bytes)
      throw ShardError(fmt::format("{}: {}: is cut off", m_path, name));
    expected = std::max(expected, array.offset + array.bytes);
    m_arrays.emplace_back(name, array);
  }
  if (expected != m_bytes.size())
    throw ShardError(
        fmt::format("{}: found {} bytes of arrays, expected {}", m_path, m_bytes.size(), expected));
}

const ShardReader::Array& ShardReader::find(const std::string& name, const char* type) const {
  const auto found =
      std::find_if(m_arrays.begin(), m_arrays.end(), [&](const auto& entry) { return entry.first == name; });
  if (found == m_arrays.end()) throw ShardError(fmt::format("{}: has no array {}", m_path, name));
  const Array& array = found->second;
  if (type && array.type != type)
    throw ShardError(
        fmt::format("{}: {}: found elements of type {}, expected {}", m_path, name, array.type, type));
  return array;
}

void ShardReader::unpack(const std::string& name, const Array& array, std::span<std::byte> values) const {
  const char* frame = m_bytes.data() + array.offset;
  if (ZSTD_getFrameContentSize(frame, array.bytes) != values.size())
    throw ShardError(fmt::format("{}: {}: is damaged: not of the size that its shape says", m_path, name));
  std::vector<std::byte> planes(values.size());
  const size_t size = ZSTD_decompress(planes.data(), planes.size(), frame, array.bytes);
  if (ZSTD_isError(size) || size != values.size())
    throw ShardError(fmt::format("{}: {}: is damaged: {}", m_path, name,
                                 ZSTD_isError(size) ? ZSTD_getErrorName(size) : "too short"));
  for (size_t i = 0; i < array.elements; ++i)
    for (size_t b = 0; b < array.elementSize; ++b)
      values[i * array.elementSize + b] = planes[b * array.elements + i];
}

std::vector<std::pair<std::string, uint64_t>> ShardReader::arrays() const {
  std::vector<std::pair<std::string, uint64_t>> result;
  for (const auto& [name, array] : m_arrays) result.emplace_back(name, array.bytes);
  return result;
}

void ShardReader::verify() const {
  for (const auto& [name, array] : m_arrays) {
    std::vector<std::byte> values(array.elements * array.elementSize);
    unpack(name, array, values);
  }
}

}  // namespace odis::learn
