// obj: a triangle mesh in Wavefront's text format.
//
//   filename         string           of the file
//   face_normals     boolean, false   shade with the triangles' own normals
//   flip_normals     boolean, false   turn the surface inside out
//   max_smooth_angle number           of Mitsuba 0.6, degrees: normals are made anew, smooth but for edges
//                                     that bend more
//   flip_tex_coords  boolean, true    v becomes 1 - v
//   to_world         transform
//
// Reads v, vt, vn and f; polygons become fans of triangles; groups and materials are not told apart. Corners
// that agree in position, texture coordinate and normal share a vertex. Without normals in the file, smooth
// ones are computed. Numbers four to six of a v are its linear colour, which becomes the attribute
// vertex_color, see the texture mesh_attribute; vertices without one beside others are white.
#include <fmt/format.h>

#include <array>
#include <map>

#include "render/shape/factories.h"
#include "render/shape/file_bytes.h"
#include "render/shape/mesh_files.h"
#include "render/shape/text_cursor.h"

namespace odis::render {

namespace {

constexpr uint32_t kNone = UINT32_MAX;
// Vertices of one position that are looked through one by one: most meshes have no more.
constexpr int kMostLinked = 16;

class ObjReader {
 public:
  ObjReader(const std::string& path, std::string_view text) : m_path(path), m_cursor(text) {
    m_positions.reserve(text.size() / 100);
    m_data.positions.reserve(text.size() / 100);
    m_data.triangles.reserve(text.size() / 80);
  }

  MeshData read(Warnings& warnings) {
    while (!m_cursor.atEnd()) {
      readLine();
      m_cursor.nextLine();
    }
    if (m_degenerate > 0)
      warnings.add({m_path, 0, 0},
                   fmt::format("ignored {} faces with fewer than three corners", m_degenerate));
    // Vertices without a normal or a texture coordinate next to others that have one get zeros.
    if (m_hasNormals) m_data.normals.resize(m_data.positions.size(), Vec3(0, 0, 0));
    if (m_hasUvs) m_data.uvs.resize(m_data.positions.size(), Vec2(0, 0));
    if (!m_colors.empty()) addColors();
    return std::move(m_data);
  }

 private:
  // A vertex that was made from a position: others of the same position are linked from it.
  struct Vertex {
    uint32_t uv, normal, next, position;
  };

  void readLine() {
    m_cursor.skipBlanks();
    const char first = m_cursor.peek();
    if (first != 'v' && first != 'f') return;
    const std::string_view command = m_cursor.word();
    if (command == "v") {
      m_positions.push_back(readVector<Vec3>(3));
      m_firstVertex.push_back(kNone);
      if (!m_cursor.atLineEnd()) readColor();
    } else if (command == "vt") {
      m_uvs.push_back(readVector<Vec2>(1));
    } else if (command == "vn") {
      m_normals.push_back(readVector<Vec3>(3));
    } else if (command == "f") {
      readFace();
    }
  }

  void addColors() {
    m_colors.resize(m_positions.size(), Vec3(1, 1, 1));
    MeshAttribute& attribute = m_data.attributes.emplace_back();
    attribute = {"vertex_color", 3, {}};
    attribute.values.reserve(3 * m_vertices.size());
    for (const Vertex& vertex : m_vertices) {
      const Vec3& c = m_colors[vertex.position];
      attribute.values.insert(attribute.values.end(), {c.x, c.y, c.z});
    }
  }

  // Reads a vector of which the first `required` components must be there.
  template <class V>
  V readVector(unsigned required) {
    V v(0.0f);
    for (unsigned i = 0; i < V::dimensions(); ++i) {
      m_cursor.skipBlanks();
      if (!m_cursor.number(v[i])) {
        if (i < required) fail("found " + m_cursor.found() + ", expected a number");
        break;
      }
    }
    return v;
  }

  // After a position; a single number there is its homogeneous coordinate, which has no meaning here.
  void readColor() {
    Vec3 color;
    for (int i = 0; i < 3; ++i) {
      m_cursor.skipBlanks();
      if (!m_cursor.number(color[i])) return;
    }
    m_colors.resize(m_positions.size(), Vec3(1, 1, 1));
    m_colors.back() = color;
  }

  void readFace() {
    uint32_t first = kNone, previous = kNone;
    int corners = 0;
    for (; !m_cursor.atLineEnd(); ++corners) {
      if (m_cursor.peek() == '#') break;
      const uint32_t vertex = readCorner();
      if (corners == 0) first = vertex;
      if (corners >= 2) m_data.triangles.push_back({first, previous, vertex});
      previous = vertex;
    }
    if (corners < 3) ++m_degenerate;
  }

  uint32_t readCorner() {
    uint32_t uv = kNone, normal = kNone;
    const uint32_t position = readIndex(m_positions.size(), "vertex");
    if (m_cursor.peek() == '/') {
      m_cursor.advance();
      if (m_cursor.peek() != '/') uv = readIndex(m_uvs.size(), "texture coordinate");
      if (m_cursor.peek() == '/') {
        m_cursor.advance();
        normal = readIndex(m_normals.size(), "normal");
      }
    }
    return findVertex(position, uv, normal);
  }

  // Indices count from one; negative ones count backwards from the last element so far.
  uint32_t readIndex(size_t count, const char* what) {
    int64_t index;
    if (!m_cursor.number(index))
      fail(fmt::format("found {}, expected the index of a {}", m_cursor.found(), what));
    if (m_cursor.peek() == '.') fail(fmt::format("expected the index of a {}, a whole number", what));
    const int64_t resolved = index > 0 ? index - 1 : int64_t(count) + index;
    if (index == 0 || resolved < 0 || resolved >= int64_t(count))
      fail(index == 0
               ? fmt::format("the face refers to {} 0, expected numbers from 1 on, or negative ones", what)
               : fmt::format("the face refers to {} {}, but only {} are defined so far", what, index, count));
    return uint32_t(resolved);
  }

  uint32_t findVertex(uint32_t position, uint32_t uv, uint32_t normal) {
    const auto index = uint32_t(m_vertices.size());
    uint32_t* link = &m_firstVertex[position];
    int linked = 0;
    for (; *link != kNone && linked < kMostLinked; link = &m_vertices[*link].next, ++linked)
      if (m_vertices[*link].uv == uv && m_vertices[*link].normal == normal) return *link;
    if (linked < kMostLinked) {
      *link = index;
    } else {
      const auto [known, added] = m_crowded.try_emplace({position, uv, normal}, index);
      if (!added) return known->second;
    }
    m_vertices.push_back({uv, normal, kNone, position});
    m_data.positions.push_back(m_positions[position]);
    if (uv != kNone) {
      m_hasUvs = true;
      m_data.uvs.resize(index, Vec2(0, 0));
      m_data.uvs.push_back(m_uvs[uv]);
    }
    if (normal != kNone) {
      m_hasNormals = true;
      m_data.normals.resize(index, Vec3(0, 0, 0));
      m_data.normals.push_back(m_normals[normal]);
    }
    return index;
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw SceneError({m_path, m_cursor.line(), 0}, message);
  }

  const std::string& m_path;
  TextCursor m_cursor;
  std::vector<Vec3> m_positions, m_normals;  // as in the file
  std::vector<Vec3> m_colors;                // of the first positions, up to the last one that has any
  std::vector<Vec2> m_uvs;
  std::vector<Vertex> m_vertices;       // one for each of m_data.positions
  std::vector<uint32_t> m_firstVertex;  // one for each of m_positions
  // By position, texture coordinate and normal, those that don't fit in the chain of their position.
  std::map<std::array<uint32_t, 3>, uint32_t> m_crowded;
  MeshData m_data;
  bool m_hasUvs = false, m_hasNormals = false;
  uint64_t m_degenerate = 0;
};

}  // namespace

MeshData readObj(const std::string& path, const SourceLocation& at, Warnings& warnings) {
  const FileBytes file(path, at);
  return ObjReader(path, file.view()).read(warnings);
}

ShapePtr makeObj(const Properties& node, Builder& builder) {
  return makeMeshOfFile(node, builder, true);
}

}  // namespace odis::render
