// ply: a triangle mesh in Stanford's polygon format, as text or binary of either byte order.
//
//   filename         string           of the file
//   face_normals     boolean, false   shade with the triangles' own normals
//   flip_normals     boolean, false   turn the surface inside out
//   max_smooth_angle number           of Mitsuba 0.6, degrees: normals are made anew, smooth but for edges
//                                     that bend more
//   flip_tex_coords  boolean, false   v becomes 1 - v
//   to_world         transform
//
// Reads x, y, z, nx, ny, nz and u, v (or s, t) of the vertices and the lists vertex_indices (or vertex_index)
// of the faces; polygons become fans of triangles. Without normals in the file, smooth ones are computed.
// Other properties become attributes for the texture mesh_attribute, if there are one or three of a name:
// color_0, color_1, color_2 of vertices, or r, g, b, or red, green, blue, make vertex_color, diffuse_red,
// diffuse_green, diffuse_blue make vertex_diffuse, weight_0 of faces makes face_weight. What is left is
// skipped, the alpha of colours as well.
//
// Colours, which are those whose channels are called r, g, b or red, green, blue, and those that have "color"
// in their name, are linear. Where they are integers, the largest one of their type is 1: 255 of uchar, 127
// of char, 65535 of ushort. All other integers are taken as they are: labels, counts, coordinates.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>

#include "render/shape/factories.h"
#include "render/shape/file_bytes.h"
#include "render/shape/mesh_files.h"
#include "render/shape/text_cursor.h"
#include "render/xml/names.h"

namespace odis::render {

namespace {

enum class Encoding { ascii, little, big };
enum class Scalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::optional<Scalar> scalarNamed(std::string_view name) {
  static constexpr std::pair<std::string_view, Scalar> names[] = {
      {"char", Scalar::int8},      {"int8", Scalar::int8},       {"uchar", Scalar::uint8},
      {"uint8", Scalar::uint8},    {"short", Scalar::int16},     {"int16", Scalar::int16},
      {"ushort", Scalar::uint16},  {"uint16", Scalar::uint16},   {"int", Scalar::int32},
      {"int32", Scalar::int32},    {"uint", Scalar::uint32},     {"uint32", Scalar::uint32},
      {"float", Scalar::float32},  {"float32", Scalar::float32}, {"double", Scalar::float64},
      {"float64", Scalar::float64}};
  for (const auto& [known, scalar] : names)
    if (name == known) return scalar;
  return {};
}

uint64_t bytesOf(Scalar scalar) {
  constexpr uint64_t bytes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return bytes[size_t(scalar)];
}

// What a property of a vertex is stored as.
enum class Role { none, x, y, z, nx, ny, nz, u, v };

Role roleNamed(std::string_view name) {
  static constexpr std::pair<std::string_view, Role> names[] = {
      {"x", Role::x},   {"y", Role::y}, {"z", Role::z}, {"nx", Role::nx}, {"ny", Role::ny},
      {"nz", Role::nz}, {"u", Role::u}, {"s", Role::u}, {"v", Role::v},   {"t", Role::v}};
  for (const auto& [known, role] : names)
    if (name == known) return role;
  return Role::none;
}

struct Property {
  std::string name;
  Scalar type = Scalar::float32;
  std::optional<Scalar> countType;  // of a list
  Role role = Role::none;
  int attribute = -1;    // index among those of the mesh
  uint32_t channel = 0;  // of the attribute
  double divisor = 1;    // of what stands in the file
};

struct Element {
  std::string name;
  uint64_t count = 0;
  std::vector<Property> properties;

  bool has(Role role) const {
    return std::any_of(properties.begin(), properties.end(),
                       [&](const Property& p) { return p.role == role; });
  }
};

// What a property is of an attribute.
struct Channel {
  std::string attribute;  // "" if it is of none
  int index = 0;          // decides about the order of channels; those that are alike keep that of the file
  bool named = false;     // whether it is called like a channel of a colour, or its alpha
};

// Comes after the channels 0, 1, 2 of a colour.
constexpr int kAlpha = 3;

// The index of a channel by its name, -1 if it is no name of one.
int colorIndex(std::string_view channel) {
  static constexpr std::pair<std::string_view, int> names[] = {
      {"r", 0}, {"red", 0}, {"g", 1}, {"green", 1}, {"b", 2}, {"blue", 2}, {"a", kAlpha}, {"alpha", kAlpha}};
  for (const auto& [known, index] : names)
    if (channel == known) return index;
  return -1;
}

// "color_0" -> "color", 0.
Channel channelOf(const Property& property) {
  const std::string& name = property.name;
  if (property.countType || property.role != Role::none) return {};
  if (const int index = colorIndex(name); index >= 0 && index < kAlpha) return {"color", index, true};
  const size_t end = name.rfind('_');
  if (end == std::string::npos) return {};
  const std::string last = name.substr(end + 1);
  Channel result{name.substr(0, end), colorIndex(last)};
  result.named = result.index >= 0;
  if (!result.named) std::from_chars(last.data(), last.data() + last.size(), result.index);
  return result;
}

// The largest integer of a type; 1 for other types.
double largest(Scalar scalar) {
  constexpr double values[] = {127, 255, 32767, 65535, 2147483647, 4294967295, 1, 1};
  return values[size_t(scalar)];
}

class PlyReader {
 public:
  PlyReader(const std::string& path, std::string_view bytes)
      : m_path(path), m_cursor(bytes), m_bytes(bytes) {}

  MeshData read(Warnings& warnings) {
    readHeader();
    m_offset = size_t(m_cursor.position() - m_bytes.data());
    for (const Element& element : m_elements) {
      if (element.properties.empty()) continue;
      // This bounds what an absurd count can make us allocate.
      if (element.count > (remaining() + 1) / leastRowBytes(element))
        fail(fmt::format("{} elements \"{}\" are announced, but only {} bytes follow", element.count,
                         element.name, remaining()));
      if (element.name == "vertex")
        readVertices(element);
      else if (element.name == "face")
        readFaces(element);
      else
        for (m_row = 0; m_row < element.count; ++m_row)
          for (const Property& property : element.properties) skip(property);
    }
    if (m_degenerate > 0)
      warnings.add({m_path, 0, 0},
                   fmt::format("ignored {} faces with fewer than three corners", m_degenerate));
    return std::move(m_data);
  }

 private:
  // What a row takes at least: of a list its count, in text a digit and a blank for each number.
  uint64_t leastRowBytes(const Element& element) const {
    uint64_t bytes = 0;
    for (const Property& property : element.properties)
      bytes += m_encoding == Encoding::ascii ? 2 : bytesOf(property.countType.value_or(property.type));
    return bytes;
  }

  void readHeader() {
    if (m_cursor.word() != "ply") fail("not a PLY file: expected \"ply\" on the first line");
    m_cursor.takeLine();
    bool hasFormat = false;
    for (;;) {
      if (m_cursor.atEnd()) fail("the header has no end_header");
      const std::string_view keyword = m_cursor.word();
      if (keyword == "format") {
        hasFormat = true;
        readFormat();
      } else if (keyword == "element") {
        Element& element = m_elements.emplace_back();
        element.name = m_cursor.word();
        m_cursor.skipBlanks();
        if (!m_cursor.number(element.count))
          fail(fmt::format("found {}, expected the count of an element", m_cursor.found()));
      } else if (keyword == "property") {
        readProperty();
      } else if (keyword == "end_header") {
        m_cursor.takeLine();
        break;
      }
      m_cursor.takeLine();
    }
    if (!hasFormat) fail("the header names no format");
    for (Element& element : m_elements)
      if (element.name == "vertex" || element.name == "face") findAttributes(element);
  }

  void findAttributes(Element& element) {
    std::map<std::string, std::vector<std::pair<Channel, Property*>>> named;
    for (Property& property : element.properties)
      if (const Channel channel = channelOf(property); !channel.attribute.empty())
        named[channel.attribute].emplace_back(channel, &property);
    for (auto& [name, channels] : named) {
      std::stable_sort(channels.begin(), channels.end(),
                       [](const auto& a, const auto& b) { return a.first.index < b.first.index; });
      const bool colorName = lowerCase(name).find("color") != std::string::npos;
      const bool hasAlpha =
          channels.size() == 4 && channels[3].first.index == kAlpha && (colorName || channels[3].first.named);
      if (hasAlpha) channels.pop_back();
      if (channels.size() != 1 && channels.size() != 3) continue;
      const bool isColor = colorName || (channels.size() == 3 &&
                                         std::all_of(channels.begin(), channels.end(), [](const auto& c) {
                                           return c.first.named && c.first.index < kAlpha;
                                         }));
      for (size_t i = 0; i < channels.size(); ++i) {
        Property* property = channels[i].second;
        property->attribute = int(m_data.attributes.size());
        property->channel = uint32_t(i);
        if (isColor) property->divisor = largest(property->type);
      }
      m_data.attributes.push_back({element.name + "_" + name, uint32_t(channels.size()), {}});
    }
  }

  void readFormat() {
    const std::string_view format = m_cursor.word();
    if (format == "ascii")
      m_encoding = Encoding::ascii;
    else if (format == "binary_little_endian")
      m_encoding = Encoding::little;
    else if (format == "binary_big_endian")
      m_encoding = Encoding::big;
    else
      fail(fmt::format("unknown format \"{}\", expected ascii, binary_little_endian or binary_big_endian",
                       format));
  }

  void readProperty() {
    if (m_elements.empty()) fail("a property before the first element");
    Property property;
    std::string_view type = m_cursor.word();
    if (type == "list") {
      type = m_cursor.word();
      property.countType = scalarNamed(type);
      if (!property.countType) fail(unknownType(type));
      type = m_cursor.word();
    }
    const std::optional<Scalar> scalar = scalarNamed(type);
    if (!scalar) fail(unknownType(type));
    property.type = *scalar;
    property.name = m_cursor.word();
    if (!property.countType) property.role = roleNamed(property.name);
    m_elements.back().properties.push_back(std::move(property));
  }

  static std::string unknownType(std::string_view type) {
    return fmt::format("unknown type \"{}\", expected char, uchar, short, ushort, int, uint, float or double",
                       type);
  }

  void readVertices(const Element& element) {
    if (!m_data.positions.empty()) fail("a second element \"vertex\", expected one");
    if (!element.has(Role::x) || !element.has(Role::y) || !element.has(Role::z))
      fail("the vertices have no x, y and z");
    const bool hasNormals = element.has(Role::nx) && element.has(Role::ny) && element.has(Role::nz);
    const bool hasUvs = element.has(Role::u) && element.has(Role::v);
    if (element.count > UINT32_MAX) fail(fmt::format("{} vertices, expected less than 2^32", element.count));
    m_data.positions.reserve(element.count);
    if (hasNormals) m_data.normals.reserve(element.count);
    if (hasUvs) m_data.uvs.reserve(element.count);
    for (const Property& property : element.properties)
      if (property.attribute >= 0)
        attributeOf(property).values.reserve(attributeOf(property).channels * element.count);
    float values[9] = {};
    for (m_row = 0; m_row < element.count; ++m_row) {
      for (const Property& property : element.properties) {
        if (property.countType)
          skip(property);
        else if (property.attribute >= 0)
          store(property, m_row, nextOf(property));
        else
          values[int(property.role)] = float(next(property.type));
      }
      m_data.positions.emplace_back(values[1], values[2], values[3]);
      if (hasNormals) m_data.normals.emplace_back(values[4], values[5], values[6]);
      if (hasUvs) m_data.uvs.emplace_back(values[7], values[8]);
    }
  }

  MeshAttribute& attributeOf(const Property& property) {
    return m_data.attributes[size_t(property.attribute)];
  }
  float nextOf(const Property& property) { return float(next(property.type) / property.divisor); }
  // Sets a value of the element's vertex or triangle with this number.
  void store(const Property& property, uint64_t index, float value) {
    MeshAttribute& attribute = attributeOf(property);
    attribute.values.resize(std::max<size_t>(attribute.values.size(), (index + 1) * attribute.channels));
    attribute.values[index * attribute.channels + property.channel] = value;
  }

  void readFaces(const Element& element) {
    std::vector<std::pair<const Property*, float>> attributes;  // of the face
    const size_t before = m_data.triangles.size();
    for (m_row = 0; m_row < element.count; ++m_row) {
      const size_t first = m_data.triangles.size();
      attributes.clear();
      for (const Property& property : element.properties) {
        if (property.countType && (property.name == "vertex_indices" || property.name == "vertex_index"))
          readPolygon(property);
        else if (property.attribute >= 0)
          attributes.emplace_back(&property, nextOf(property));
        else
          skip(property);
      }
      for (size_t triangle = first; triangle < m_data.triangles.size(); ++triangle)
        for (const auto& [property, value] : attributes) store(*property, triangle - before, value);
    }
  }

  void readPolygon(const Property& property) {
    const uint64_t corners = listLength(property);
    uint32_t first = 0, previous = 0;
    for (uint64_t i = 0; i < corners; ++i) {
      const double index = next(property.type);
      if (!(index >= 0 && index < double(m_data.positions.size())) || index != std::floor(index))
        fail(fmt::format("face {} refers to vertex {}, expected a whole number less than {}", m_row, index,
                         m_data.positions.size()));
      const auto vertex = uint32_t(index);
      if (i == 0) first = vertex;
      if (i >= 2) m_data.triangles.push_back({first, previous, vertex});
      previous = vertex;
    }
    if (corners < 3) ++m_degenerate;
  }

  uint64_t listLength(const Property& property) {
    const double length = next(*property.countType);
    if (length != std::floor(length))
      fail(fmt::format("a list of {} elements in row {}, expected a whole number", length, m_row));
    if (!(length >= 0 && length <= double(remaining())))
      fail(fmt::format("a list of {} elements in row {}, but only {} bytes follow", length, m_row,
                       remaining()));
    return uint64_t(length);
  }

  void skip(const Property& property) {
    const uint64_t count = property.countType ? listLength(property) : 1;
    for (uint64_t i = 0; i < count; ++i) next(property.type);
  }

  uint64_t remaining() const {
    return m_encoding == Encoding::ascii ? uint64_t(m_bytes.data() + m_bytes.size() - m_cursor.position())
                                         : m_bytes.size() - m_offset;
  }

  // The next number of the body.
  double next(Scalar type) {
    if (m_encoding == Encoding::ascii) {
      double value;
      m_cursor.skipSpace();
      if (!m_cursor.number(value)) fail("found " + m_cursor.found() + ", expected a number");
      return value;
    }
    switch (type) {
      case Scalar::int8:
        return raw<int8_t>();
      case Scalar::uint8:
        return raw<uint8_t>();
      case Scalar::int16:
        return raw<int16_t>();
      case Scalar::uint16:
        return raw<uint16_t>();
      case Scalar::int32:
        return raw<int32_t>();
      case Scalar::uint32:
        return raw<uint32_t>();
      case Scalar::float32:
        return raw<float>();
      case Scalar::float64:
        return raw<double>();
    }
    return 0;
  }

  template <class T>
  T raw() {
    if (remaining() < sizeof(T)) fail(fmt::format("the file ends too early, in row {}", m_row));
    char bytes[sizeof(T)];
    std::memcpy(bytes, m_bytes.data() + m_offset, sizeof(T));
    m_offset += sizeof(T);
    if ((m_encoding == Encoding::little) != (std::endian::native == std::endian::little))
      std::reverse(bytes, bytes + sizeof(T));
    return std::bit_cast<T>(bytes);
  }

  // Text has lines; of a binary body only the file is known, and messages name the row.
  [[noreturn]] void fail(const std::string& message) const {
    throw SceneError({m_path, m_encoding == Encoding::ascii ? m_cursor.line() : 0, 0}, message);
  }

  const std::string& m_path;
  TextCursor m_cursor;
  std::string_view m_bytes;
  size_t m_offset = 0;  // of the next byte of a binary body
  Encoding m_encoding = Encoding::ascii;
  std::vector<Element> m_elements;
  MeshData m_data;
  uint64_t m_row = 0, m_degenerate = 0;
};

}  // namespace

MeshData readPly(const std::string& path, const SourceLocation& at, Warnings& warnings) {
  const FileBytes file(path, at);
  return PlyReader(path, file.view()).read(warnings);
}

ShapePtr makePly(const Properties& node, Builder& builder) {
  return makeMeshOfFile(node, builder, false);
}

}  // namespace odis::render
