#include "odis/files/archive.h"

#include <filesystem>
#include <fstream>

#include "odis/files/crc32.h"
#include "odis/files/regular_file.h"

namespace odis::core {

namespace fs = std::filesystem;

namespace {

constexpr uint32_t kArchiveFormat = 1;

template <class Integer>
void putInteger(std::string& bytes, Integer value) {
  for (size_t i = 0; i < sizeof value; ++i) bytes.push_back(char(uint8_t(value >> (8 * i))));
}

void putText(std::string& bytes, std::string_view text) {
  putInteger(bytes, uint32_t(text.size()));
  bytes += text;
}

// Reads from the front of what is left, never beyond its end.
class Cursor {
 public:
  Cursor(std::string_view bytes, size_t at) : m_bytes(bytes), m_at(at) {}
  template <class Integer>
  bool read(Integer& value) {
    if (left() < sizeof value) return false;
    value = 0;
    for (size_t i = 0; i < sizeof value; ++i) value |= Integer(uint8_t(m_bytes[m_at++])) << (8 * i);
    return true;
  }
  bool read(std::string& text) {
    uint32_t length = 0;
    if (!read(length) || left() < length) return false;
    text = m_bytes.substr(m_at, length);
    m_at += length;
    return true;
  }
  bool skip(uint64_t count) {
    if (left() < count) return false;
    m_at += size_t(count);
    return true;
  }
  size_t at() const { return m_at; }
  size_t left() const { return m_bytes.size() - m_at; }

 private:
  std::string_view m_bytes;
  size_t m_at;
};

}  // namespace

ArchiveWriter::ArchiveWriter(std::string_view kind) : m_kind(kind) {}

void ArchiveWriter::addBytes(const std::string& name, uint32_t elementBytes, std::string_view bytes) {
  std::string& array = m_arrays.emplace_back();
  array.reserve(name.size() + 2 * sizeof(uint32_t) + sizeof(uint64_t) + bytes.size());
  putText(array, name);
  putInteger(array, elementBytes);
  putInteger(array, uint64_t(bytes.size() / elementBytes));
  array += bytes;
}

void ArchiveWriter::write(std::ostream& stream) const {
  uint32_t crc = 0;
  const auto put = [&](const std::string& bytes) {
    stream.write(bytes.data(), std::streamsize(bytes.size()));
    crc = crc32(bytes, crc);
  };
  std::string head(kArchiveMagic), checksum;
  putInteger(head, kArchiveFormat);
  putText(head, m_kind);
  putInteger(head, uint32_t(m_arrays.size()));
  put(head);
  for (const std::string& array : m_arrays) put(array);
  putInteger(checksum, crc);
  put(checksum);
}

void ArchiveWriter::write(const std::string& path) const {
  const std::string temporary = path + ".part";
  std::error_code error;
  {
    std::ofstream stream(temporary, std::ios::binary);
    write(stream);
    stream.close();
    if (!stream) {
      fs::remove(temporary, error);
      throw FileError("cannot write \"" + path + "\"");
    }
  }
  fs::rename(temporary, path, error);
  if (!error) return;
  const std::string reason = error.message();
  fs::remove(temporary, error);
  throw FileError("cannot write \"" + path + "\": " + reason);
}

Archive Archive::parse(const std::string& path, std::string bytes) {
  Archive archive;
  archive.m_path = path;
  archive.m_bytes = std::move(bytes);
  const std::string_view all = archive.m_bytes;
  archive.require(all.size() >= kArchiveMagic.size() + 4 && all.starts_with(kArchiveMagic),
                  "is nothing that ODIS saved, expected it to begin with ODISSAVE");
  const std::string_view body = all.substr(0, all.size() - 4);
  Cursor cursor(body, kArchiveMagic.size());
  uint32_t format = 0, crc = 0, count = 0;
  archive.require(cursor.read(format), "is cut off");
  archive.require(format == kArchiveFormat,
                  "found format " + std::to_string(format) + ", expected " + std::to_string(kArchiveFormat));
  Cursor(all, body.size()).read(crc);
  archive.require(crc == crc32(body), "is damaged or cut off");
  archive.require(cursor.read(archive.m_kind) && cursor.read(count), "is cut off");
  for (uint32_t i = 0; i < count; ++i) {
    std::string name;
    uint32_t elementBytes = 0;
    uint64_t elements = 0;
    archive.require(cursor.read(name) && cursor.read(elementBytes) && cursor.read(elements), "is cut off");
    archive.require(elementBytes > 0 && elements <= cursor.left() / elementBytes, name + ": is cut off");
    const size_t size = size_t(elements) * elementBytes;
    archive.m_arrays[name] = {elementBytes, cursor.at(), size};
    cursor.skip(size);
  }
  archive.require(cursor.left() == 0, "has bytes after its last array");
  return archive;
}

Archive Archive::load(const std::string& path) {
  if (const std::string why = whyUnreadable(path); !why.empty()) throw FileError(path + why);
  std::error_code error;
  std::ifstream stream(path, std::ios::binary);
  std::string bytes(stream ? size_t(fs::file_size(path, error)) : 0, '\0');
  if (!stream.read(bytes.data(), std::streamsize(bytes.size()))) throw FileError(path + ": cannot be read");
  return parse(path, std::move(bytes));
}

void Archive::require(bool holds, const std::string& what) const {
  if (!holds) throw FileError(m_path + ": " + what);
}

void Archive::requireKind(std::string_view kind) const {
  require(m_kind == kind, "found a saved \"" + m_kind + "\", expected a \"" + std::string(kind) + "\"");
}

std::string_view Archive::find(const std::string& name, size_t elementBytes) const {
  const auto found = m_arrays.find(name);
  require(found != m_arrays.end(), "has no array \"" + name + "\"");
  const Array& array = found->second;
  require(array.elementBytes == elementBytes, name + ": has elements of " +
                                                  std::to_string(array.elementBytes) + " bytes, expected " +
                                                  std::to_string(elementBytes));
  return std::string_view(m_bytes).substr(array.begin, array.bytes);
}

}  // namespace odis::core
