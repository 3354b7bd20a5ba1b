// serialized: a triangle mesh in the binary format of Mitsuba 0.x, versions 3 and 4.
//
//   filename      string           of the file
//   shape_index   integer, 0       which of the file's meshes
//   face_normals  boolean, false   shade with the triangles' own normals (the file may ask for it too)
//   flip_normals  boolean, false   turn the surface inside out
//   max_smooth_angle number           of Mitsuba 0.6, degrees: normals are made anew, smooth but for edges
//                                     that bend more
//   to_world      transform
//
// Colours of the vertices become the attribute vertex_color, see the texture mesh_attribute.
//
// The file: for each mesh a header (uint16 0x041C, uint16 version) and a zlib stream; at the end the offset
// of each mesh (uint64, version 3: uint32) and their number (uint32). All little-endian.
#include <fmt/format.h>
#include <zlib.h>

#include <cstring>

#include "render/shape/factories.h"
#include "render/shape/file_bytes.h"
#include "render/shape/mesh_files.h"

namespace odis::render {

namespace {

constexpr uint16_t kMagic = 0x041C;
enum Flag : uint32_t {
  kHasNormals = 0x0001,
  kHasUvs = 0x0002,
  kHasColors = 0x0008,
  kFaceNormals = 0x0010,
  kDouble = 0x2000,
};

template <class T>
T readAt(std::string_view bytes, uint64_t offset, const SourceLocation& at) {
  if (offset > bytes.size() || bytes.size() - offset < sizeof(T))
    throw SceneError(at, "the file ends too early");
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

// Decompresses a zlib stream piece by piece.
class Inflater {
 public:
  Inflater(std::string_view compressed, const SourceLocation& at) : m_at(at), m_size(compressed.size()) {
    m_stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(compressed.data()));
    m_stream.avail_in = uInt(std::min<size_t>(compressed.size(), UINT32_MAX));
    if (inflateInit(&m_stream) != Z_OK) throw SceneError(m_at, "cannot start zlib");
  }
  ~Inflater() { inflateEnd(&m_stream); }
  Inflater(const Inflater&) = delete;

  void read(void* target, uint64_t bytes) {
    auto* out = static_cast<Bytef*>(target);
    while (bytes > 0) {
      const uInt piece = uInt(std::min<uint64_t>(bytes, 1u << 30));
      m_stream.next_out = out;
      m_stream.avail_out = piece;
      const int result = inflate(&m_stream, Z_SYNC_FLUSH);
      const uInt done = piece - m_stream.avail_out;
      out += done;
      bytes -= done;
      if (bytes > 0 && (result != Z_OK || done == 0))
        throw SceneError(m_at, "the compressed mesh is damaged or ends too early");
    }
  }
  template <class T>
  T read() {
    T value;
    read(&value, sizeof(T));
    return value;
  }
  // An upper bound of the decompressed size. Deflate shrinks zeros by 1032 to one, but no mesh is made of
  // zeros: those of exporters shrink by less than ten.
  uint64_t maxBytes() const { return uint64_t(m_size) * 200 + (1u << 20); }

 private:
  const SourceLocation& m_at;
  size_t m_size;
  z_stream m_stream = {};
};

// In pieces, so that memory is touched for what the stream holds only, not for all that its header announces.
template <class T>
void readElements(Inflater& in, std::vector<T>& target, uint64_t count) {
  constexpr uint64_t kPiece = 1u << 16;
  target.reserve(count);
  while (target.size() < count) {
    const uint64_t done = target.size(), piece = std::min(kPiece, count - done);
    target.resize(done + piece);
    in.read(target.data() + done, piece * sizeof(T));
  }
}

template <class V>
void readVectors(Inflater& in, std::vector<V>& target, uint64_t count, bool isDouble) {
  if (!isDouble) return readElements(in, target, count);
  constexpr unsigned n = V::dimensions();
  target.reserve(count);
  for (uint64_t vertex = 0; vertex < count; ++vertex) {
    double values[n];
    in.read(values, sizeof(values));
    V& v = target.emplace_back();
    for (unsigned i = 0; i < n; ++i) v[i] = float(values[i]);
  }
}

// Where mesh number `index` starts, from the table at the end of the file.
uint64_t findMesh(std::string_view bytes, int64_t index, uint16_t version, const SourceLocation& at) {
  if (bytes.size() < 8) throw SceneError(at, "the file ends too early");
  const auto count = readAt<uint32_t>(bytes, bytes.size() - 4, at);
  if (index < 0 || index >= int64_t(count))
    throw SceneError(at, fmt::format("shape_index is {}, but the file has {} meshes", index, count));
  const uint64_t entry = version == 4 ? 8 : 4, fromEnd = 4 + entry * (count - uint64_t(index));
  if (fromEnd > bytes.size()) throw SceneError(at, "the file ends too early");
  const uint64_t offset = bytes.size() - fromEnd;
  return version == 4 ? readAt<uint64_t>(bytes, offset, at) : readAt<uint32_t>(bytes, offset, at);
}

}  // namespace

MeshData readSerialized(const std::string& path, int64_t shapeIndex, const SourceLocation& at) {
  const FileBytes file(path, at);
  const std::string_view bytes = file.view();
  const SourceLocation inFile{path, 0, 0};
  const auto checkVersion = [&](uint64_t offset) {
    if (readAt<uint16_t>(bytes, offset, inFile) != kMagic)
      throw SceneError(inFile, fmt::format("no serialized mesh at byte {}", offset));
    const auto version = readAt<uint16_t>(bytes, offset + 2, inFile);
    if (version != 3 && version != 4)
      throw SceneError(inFile, fmt::format("version {} is not supported, expected 3 or 4", version));
    return version;
  };
  const uint16_t version = checkVersion(0);
  const uint64_t offset = findMesh(bytes, shapeIndex, version, inFile);
  checkVersion(offset);

  Inflater in(bytes.substr(offset + 4), inFile);
  const auto flags = in.read<uint32_t>();
  if (version == 4)
    while (in.read<char>() != '\0') {
    }
  const auto vertices = in.read<uint64_t>(), triangles = in.read<uint64_t>();
  const bool isDouble = flags & kDouble;
  const uint64_t scalars =
      3u + (flags & kHasNormals ? 3u : 0u) + (flags & kHasUvs ? 2u : 0u) + (flags & kHasColors ? 3u : 0u);
  const uint64_t vertexBytes = scalars * (isDouble ? 8 : 4);
  if (vertices > UINT32_MAX || vertices > in.maxBytes() / vertexBytes ||
      triangles > (in.maxBytes() - vertices * vertexBytes) / sizeof(Triangle))
    throw SceneError(
        inFile, fmt::format("mesh {} announces {} vertices and {} triangles, more than the file can hold",
                            shapeIndex, vertices, triangles));

  MeshData mesh;
  mesh.faceNormals = flags & kFaceNormals;
  readVectors(in, mesh.positions, vertices, isDouble);
  if (flags & kHasNormals) readVectors(in, mesh.normals, vertices, isDouble);
  if (flags & kHasUvs) readVectors(in, mesh.uvs, vertices, isDouble);
  if (flags & kHasColors) {
    std::vector<Vec3> colors;
    readVectors(in, colors, vertices, isDouble);
    MeshAttribute& attribute = mesh.attributes.emplace_back();
    attribute = {"vertex_color", 3, {}};
    attribute.values.reserve(3 * colors.size());
    for (const Vec3& c : colors) attribute.values.insert(attribute.values.end(), {c.x, c.y, c.z});
  }
  readElements(in, mesh.triangles, triangles);
  return mesh;
}

ShapePtr makeSerialized(const Properties& node, Builder& builder) {
  return makeMeshOfFile(node, builder, false);
}

}  // namespace odis::render
