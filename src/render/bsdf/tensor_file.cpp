#include "render/bsdf/tensor_file.h"

#include <fmt/format.h>

#include <cstring>

namespace odis::render {
namespace {

constexpr std::string_view kMagic("tensor_file\0", 12);

// Reads the header from front to back.
class HeaderCursor {
 public:
  HeaderCursor(std::string_view bytes, const SourceLocation& at) : m_bytes(bytes), m_at(at) {}

  std::string_view take(uint64_t count) {
    if (m_bytes.size() < count) throw SceneError(m_at, "the tensor file ends too early, in its header");
    const std::string_view taken = m_bytes.substr(0, count);
    m_bytes.remove_prefix(count);
    return taken;
  }
  template <class T>
  T number() {
    T value;
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }

 private:
  std::string_view m_bytes;
  const SourceLocation& m_at;
};

const char* nameOf(TensorFile::Type type) {
  return type == TensorFile::Type::uint8 ? "uint8" : type == TensorFile::Type::uint16 ? "uint16" : "float32";
}
uint64_t sizeOf(TensorFile::Type type) {
  return type == TensorFile::Type::uint8 ? 1 : type == TensorFile::Type::uint16 ? 2 : 4;
}

}  // namespace

TensorFile::TensorFile(const std::string& path, const SourceLocation& at)
    : m_at{path, 0, 0}, m_bytes(path, at) {
  HeaderCursor cursor(m_bytes.view(), m_at);
  if (m_bytes.view().substr(0, kMagic.size()) != kMagic)
    throw SceneError(m_at, "found no tensor file, expected one, which begins with \"tensor_file\"");
  cursor.take(kMagic.size());
  const auto major = cursor.number<uint8_t>(), minor = cursor.number<uint8_t>();
  if (major != 1)
    throw SceneError(m_at, fmt::format("found a tensor file of version {}.{}, expected 1.0", major, minor));
  for (auto count = cursor.number<uint32_t>(); count > 0; --count) {
    const std::string name(cursor.take(cursor.number<uint16_t>()));
    Field& field = m_fields[name];
    field.shape.resize(cursor.number<uint16_t>());
    field.type = cursor.number<uint8_t>();
    field.offset = cursor.number<uint64_t>();
    for (uint64_t& size : field.shape) size = cursor.number<uint64_t>();
  }
}

const TensorFile::Field& TensorFile::field(const std::string& name) const {
  const auto found = m_fields.find(name);
  if (found == m_fields.end())
    throw SceneError(m_at, "the tensor file has no field '" + name + "', expected one");
  return found->second;
}

void TensorFile::refuse(const std::string& name, const std::string& found,
                        const std::string& expected) const {
  throw SceneError(m_at, "the field '" + name + "' holds " + found + ", expected " + expected);
}

std::string TensorFile::shapeText(const std::string& name) const {
  const std::vector<uint64_t>& sizes = shape(name);
  return sizes.empty() ? "1" : fmt::format("{}", fmt::join(sizes, " x "));
}

const char* TensorFile::values(const std::string& name, Type type, uint64_t& count) const {
  const Field& f = field(name);
  if (f.type != uint8_t(type))
    refuse(name, fmt::format("values of type {}", f.type),
           fmt::format("{} ({})", uint8_t(type), nameOf(type)));
  const std::string_view all = m_bytes.view();
  const uint64_t room = f.offset < all.size() ? (all.size() - f.offset) / sizeOf(type) : 0;
  count = 1;
  bool fits = room > 0;  // a field without dimensions is a single value
  for (const uint64_t size : f.shape) {
    // A product that would not fit in the file does not overflow either.
    fits = fits && (size == 0 || count <= room / size);
    if (fits) count *= size;
  }
  if (!fits) refuse(name, shapeText(name) + " values", fmt::format("no more than the {} in the file", room));
  if (count == 0) refuse(name, "no values", "at least one");
  return all.data() + f.offset;
}

template <class T>
std::vector<T> TensorFile::copy(const std::string& name, Type type) const {
  uint64_t count;
  const char* first = values(name, type, count);
  std::vector<T> result(count);
  std::memcpy(result.data(), first, count * sizeof(T));
  return result;
}

std::vector<float> TensorFile::floats(const std::string& name) const {
  return copy<float>(name, Type::float32);
}
std::vector<uint16_t> TensorFile::shorts(const std::string& name) const {
  return copy<uint16_t>(name, Type::uint16);
}
std::vector<uint8_t> TensorFile::bytes(const std::string& name) const {
  return copy<uint8_t>(name, Type::uint8);
}

TensorFile::FloatView TensorFile::view(const std::string& name) const {
  uint64_t count;
  return FloatView(values(name, Type::float32, count));
}

float TensorFile::FloatView::operator[](uint64_t index) const {
  float value;
  std::memcpy(&value, m_values + index * sizeof(float), sizeof(float));
  return value;
}

}  // namespace odis::render
