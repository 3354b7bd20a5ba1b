#include "learn/scenes/write_ply.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>

namespace odis::learn {

static_assert(std::endian::native == std::endian::little);

std::string encodePly(const MeshData& mesh) {
  std::string text = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\n"
      "property float u\nproperty float v\n"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      mesh.positions.size(), mesh.triangles.size());
  size_t at = text.size();
  text.resize(at + 32 * mesh.positions.size() + 13 * mesh.triangles.size());
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3 &p = mesh.positions[i], &n = mesh.normals[i];
    const Vec2& uv = mesh.uvs[i];
    const float values[8] = {p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y};
    std::memcpy(&text[at], values, sizeof(values));
    at += sizeof(values);
  }
  for (const render::Triangle& triangle : mesh.triangles) {
    text[at++] = 3;
    std::memcpy(&text[at], triangle.data(), 12);
    at += 12;
  }
  return text;
}

}  // namespace odis::learn
