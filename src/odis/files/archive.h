// Files of named arrays of numbers: saved guides, builders, vertices and frames.
//
//   bytes  0-7   ODISSAVE
//          8-11  format, 1
//          then  what is saved: length of a text in bytes, the text ("guide", "builder", "vertices", "frame")
//                number of arrays; for each: length of its name, the name, bytes of an element, number of
//                elements (64 bits), the elements
//          last 4 CRC-32 of all before
// All numbers are little-endian and, but for the elements, unsigned integers of 32 bits. Elements are numbers
// or arrays of numbers. Structs are saved field by field (odis/files/fields.h), but for some of frames, which
// lie in the file as in memory: saved frames are for the version that wrote them.
#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <ostream>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace odis::core {

inline constexpr std::string_view kArchiveMagic = "ODISSAVE";

// What can't be read or written, or is damaged. Names the file.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class ArchiveWriter {
 public:
  explicit ArchiveWriter(std::string_view kind);

  template <class T>
  void add(const std::string& name, std::span<const T> elements) {
    static_assert(std::is_trivially_copyable_v<T>);
    addBytes(name, sizeof(T), {reinterpret_cast<const char*>(elements.data()), elements.size_bytes()});
  }
  template <class T>
  void add(const std::string& name, const std::vector<T>& elements) {
    add(name, std::span<const T>(elements));
  }
  void addText(const std::string& name, const std::string& text) {
    add(name, std::span<const char>(text.data(), text.size()));
  }
  template <class T>
  void addValue(const std::string& name, const T& value) {
    add(name, std::span<const T>(&value, 1));
  }

  void write(std::ostream& stream) const;
  // Replaces the file when all is written. Throws FileError.
  void write(const std::string& path) const;

 private:
  void addBytes(const std::string& name, uint32_t elementBytes, std::string_view bytes);

  std::string m_kind;
  std::vector<std::string> m_arrays;  // each as it is written
};

class Archive {
 public:
  // Throw FileError; `path` is what errors name.
  static Archive parse(const std::string& path, std::string bytes);
  static Archive load(const std::string& path);

  const std::string& kind() const { return m_kind; }
  // Throws FileError if something else is saved here.
  void requireKind(std::string_view kind) const;
  bool contains(const std::string& name) const { return m_arrays.count(name) > 0; }
  // How many elements an array has. Throws FileError as get().
  template <class T>
  size_t count(const std::string& name) const {
    return find(name, sizeof(T)).size() / sizeof(T);
  }
  // The elements of an array. Throws FileError if there is none of that name with elements of that size.
  template <class T>
  std::vector<T> get(const std::string& name) const {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::string_view bytes = find(name, sizeof(T));
    std::vector<T> elements(bytes.size() / sizeof(T));
    if (!elements.empty()) std::memcpy(static_cast<void*>(elements.data()), bytes.data(), bytes.size());
    return elements;
  }
  // The same, of an array that must have so many.
  template <class T>
  std::vector<T> get(const std::string& name, size_t count) const {
    std::vector<T> elements = get<T>(name);
    require(elements.size() == count, name + ": has another number of elements than expected");
    return elements;
  }
  std::string text(const std::string& name) const {
    const std::vector<char> bytes = get<char>(name);
    return {bytes.begin(), bytes.end()};
  }
  template <class T>
  T value(const std::string& name) const {
    return get<T>(name, 1)[0];
  }
  // The same; `otherwise` where the file has no such array.
  template <class T>
  T valueOr(const std::string& name, T otherwise) const {
    return contains(name) ? value<T>(name) : otherwise;
  }
  // Throws FileError with the file's name unless `holds`.
  void require(bool holds, const std::string& what) const;

 private:
  struct Array {
    uint32_t elementBytes;
    size_t begin, bytes;
  };
  std::string_view find(const std::string& name, size_t elementBytes) const;

  std::string m_path, m_kind, m_bytes;
  std::map<std::string, Array> m_arrays;
};

}  // namespace odis::core
