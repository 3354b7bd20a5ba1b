#include "learn/data/shard_file.h"

#include <fmt/format.h>
#include <zstd.h>

#include <bit>
#include <cstring>
#include <memory>

#include "render/files/input_file.h"
#include "render/files/replace_file.h"

namespace odis::learn {

static_assert(std::endian::native == std::endian::little, "elements are written as they lie in memory");

namespace {

constexpr int kLevel = 3;  // of compression

}  // namespace

std::string shardBytes(const std::string& path) {
  try {
    return render::readFile(path);
  } catch (const render::ReadError& error) {
    throw ShardError(fmt::format("{}: cannot be read: {}", path, error.what()));
  }
}

// The lowest bytes of all elements come first, then the next ones: like stands beside like, which
// compresses better.
void ShardWriter::addBytes(const std::string& name, const char* type, const Shape& shape,
                           std::span<const std::byte> bytes, size_t elementSize) {
  const size_t count = bytes.size() / elementSize;
  if (elementCount(shape) != count || bytes.size() > kMostArrayBytes)
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
  const uint32_t words[3] = {kShardFormat, uint32_t(text.size()), crc32(text)};
  render::replaceFile(path, [&](render::CheckedStream& stream) {
    stream.write(kShardMagic.data(), kShardMagic.size());
    stream.write(reinterpret_cast<const char*>(words), sizeof(words));
    stream.write(text.data(), text.size());
    stream.write(m_frames.data(), m_frames.size());
  });
}

ShardReader::ShardReader(const std::string& path) : ShardReader(path, shardBytes(path)) {}

ShardReader::ShardReader(const std::string& path, std::string bytes)
    : ShardHeader(path, bytes), m_bytes(std::move(bytes)) {}

const ShardHeader::Array& ShardReader::find(const std::string& name, const char* type) const {
  const Array& array = ShardHeader::find(name);
  if (array.type != type)
    throw ShardError(
        fmt::format("{}: {}: found elements of type {}, expected {}", m_path, name, array.type, type));
  return array;
}

void ShardReader::unpack(const std::string& name, const Array& array, std::span<std::byte> values) const {
  const char* frame = m_bytes.data() + m_end + array.offset;
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

void ShardReader::verify() const {
  for (const auto& [name, array] : m_arrays) {
    std::vector<std::byte> values(array.elements * array.elementSize);
    unpack(name, array, values);
  }
}

}  // namespace odis::learn
