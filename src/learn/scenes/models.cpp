// Furniture from OBJ files.
#include <tiny_obj_loader.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "learn/scenes/furniture.h"
#include "render/image/srgb.h"

namespace odis::learn {

namespace {

// What a material of a model becomes: its own colour or texture, glass where it is transparent.
MaterialId materialOf(Draft& draft, const tinyobj::material_t& m, const std::string& folder) {
  if (m.dissolve < 0.7f) return draft.materials.glass();
  for (const char* word : {"metal", "chrome", "steel", "alu", "inox", "brass"})
    if (m.name.find(word) != std::string::npos) return draft.materials.metal();
  if (!m.diffuse_texname.empty()) {
    const std::string path = folder + "/" + m.diffuse_texname;
    if (std::filesystem::is_regular_file(path)) return draft.materials.textured(path);
  }
  Rgb color;
  for (int c = 0; c < 3; ++c) color[c] = std::clamp(render::srgbDecode(m.diffuse[c]), 0.02f, 0.9f);
  return draft.materials.finished(color);
}

Vec3 vec(const std::vector<tinyobj::real_t>& values, int index) {
  const size_t at = 3 * size_t(index);
  // Models have +y up and their front towards +z.
  return {-values[at], values[at + 2], values[at + 1]};
}

// One mesh a material (-1: none is named).
std::map<int, MeshData> meshesOf(const tinyobj::ObjReader& reader) {
  std::map<int, MeshData> meshes;
  const tinyobj::attrib_t& a = reader.GetAttrib();
  for (const tinyobj::shape_t& shape : reader.GetShapes())
    for (size_t face = 0; face < shape.mesh.material_ids.size(); ++face) {
      const tinyobj::index_t* corner = &shape.mesh.indices[3 * face];
      const Vec3 p[3] = {vec(a.vertices, corner[0].vertex_index), vec(a.vertices, corner[1].vertex_index),
                         vec(a.vertices, corner[2].vertex_index)};
      const Vec3 flat = render::cross(p[1] - p[0], p[2] - p[0]);
      if (!(render::length(flat) > 0)) continue;
      MeshData& mesh = meshes[shape.mesh.material_ids[face]];
      const auto first = uint32_t(mesh.positions.size());
      for (int k = 0; k < 3; ++k) {
        Vec3 n = corner[k].normal_index >= 0 ? vec(a.normals, corner[k].normal_index) : flat;
        if (!(render::length(n) > 0)) n = flat;
        const size_t uv = 2 * size_t(std::max(corner[k].texcoord_index, 0));
        const bool mapped = corner[k].texcoord_index >= 0;
        mesh.positions.push_back(p[k]);
        mesh.normals.push_back(render::normalize(n));
        mesh.uvs.push_back(mapped ? Vec2(a.texcoords[uv], 1 - a.texcoords[uv + 1]) : Vec2(p[k].x, p[k].z));
      }
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
  return meshes;
}

// Of this size, in the middle above the origin.
void resize(std::map<int, MeshData>& meshes, const Vec3& size) {
  Vec3 min(render::kInfinity), max(-render::kInfinity);
  for (const auto& [material, mesh] : meshes)
    for (const Vec3& p : mesh.positions)
      for (int c = 0; c < 3; ++c) {
        min[c] = std::min(min[c], p[c]);
        max[c] = std::max(max[c], p[c]);
      }
  Vec3 scale;
  for (int c = 0; c < 3; ++c) scale[c] = size[c] / std::max(max[c] - min[c], 1e-6f);
  const Vec3 base((min.x + max.x) / 2, (min.y + max.y) / 2, min.z);
  for (auto& [material, mesh] : meshes) {
    for (Vec3& p : mesh.positions) p = (p - base) * scale;
    for (Vec3& n : mesh.normals) n = render::normalize(n / scale);
  }
}

bool suits(const FurnitureModel& model, const Vec3& most, bool ornament) {
  if (!(model.width > 0 && model.depth > 0 && model.height > 0)) return !ornament;
  if (model.elevation > 0.1f || model.width > most.x || model.depth > most.y || model.height > most.z)
    return false;
  return ornament || (model.height > 0.35f && model.width > 0.25f);
}

}  // namespace

Piece makeModel(Draft& draft, const Vec3& most, bool ornament) {
  constexpr int kAttempts = 10;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const FurnitureModel& model =
        draft.random.pick(std::span<const FurnitureModel>(draft.assets.furniture()));
    if (!suits(model, most, ornament)) continue;
    const std::string folder = std::filesystem::path(model.path).parent_path().string();
    tinyobj::ObjReader reader;
    tinyobj::ObjReaderConfig config;
    config.mtl_search_path = folder;
    if (!reader.ParseFromFile(model.path, config)) continue;
    std::map<int, MeshData> meshes = meshesOf(reader);
    if (meshes.empty()) continue;
    Piece piece;
    piece.size = {model.width, model.depth, model.height};
    if (!(model.width > 0)) piece.size = Vec3(0.6f, 0.6f, 0.9f) * float(draft.random.range(0.6, 1.3));
    resize(meshes, piece.size);
    for (auto& [id, mesh] : meshes)
      piece.add(std::move(mesh), id < 0 ? draft.materials.lacquer()
                                        : materialOf(draft, reader.GetMaterials()[size_t(id)], folder));
    const std::string credit = model.name + (model.credit.empty() ? "" : ", " + model.credit);
    if (std::find(draft.scene.credits.begin(), draft.scene.credits.end(), credit) ==
        draft.scene.credits.end())
      draft.scene.credits.push_back(credit);
    return piece;
  }
  return {};
}

}  // namespace odis::learn
