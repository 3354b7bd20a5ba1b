#include "render/scene/files_ahead.h"

#include <filesystem>

#include "render/shape/mesh_files.h"
#include "render/xml/find_file.h"

namespace odis::render {

namespace {

// The file that an element names; empty if there is none.
std::string fileOf(const Properties& node, const std::vector<std::string>& folders) {
  const auto parameter = node.parameters.find("filename");
  if (parameter == node.parameters.end()) return {};
  const auto* name = std::get_if<std::string>(&parameter->second.value);
  return name ? findFile(*name, folders, parameter->second.location) : std::string();
}

}  // namespace

std::string imageKey(const std::string& path, bool srgb) {
  return path + (srgb ? "|srgb" : "|linear");
}

FilesAhead::~FilesAhead() {
  m_tasks.cancel();
  m_tasks.wait();
}

void FilesAhead::begin(const Properties& root, const std::vector<std::string>& folders) {
  find(root, folders);
  readOn();
}

void FilesAhead::find(const Properties& node, const std::vector<std::string>& folders) {
  if (!m_seen.insert(&node).second) return;
  try {
    if (node.tag == "shape") findMesh(node, folders);
    if ((node.tag == "texture" && node.type == "bitmap") || (node.tag == "emitter" && node.type == "envmap"))
      findImage(node, folders);
    if (node.tag == "volume" && node.type == "gridvolume") findVolume(node, folders);
  } catch (const SceneError&) {  // is thrown again when the element is made, if it is
  }
  for (const Properties::Child& child : node.children) find(*child.node, folders);
}

void FilesAhead::findMesh(const Properties& shape, const std::vector<std::string>& folders) {
  const std::string path = fileOf(shape, folders);
  const MeshReader reader = path.empty() ? MeshReader() : meshReader(shape);
  if (!reader) return;
  const auto read = [reader, path, at = shape.placeOf("filename")] {
    ReadMesh result;
    result.data = reader(path, at, result.warnings);
    return result;
  };
  std::error_code unknown;
  const uint64_t bytes = std::filesystem::file_size(path, unknown);
  m_queue.push_back(std::make_shared<Mesh>(read, unknown ? 0 : bytes));
  m_meshes[&shape] = m_queue.back();
}

void FilesAhead::findImage(const Properties& node, const std::vector<std::string>& folders) {
  if (node.parameters.contains("gamma")) return;  // it decides how the file is decoded
  const auto raw = node.parameters.find("raw");
  const bool* linear = raw == node.parameters.end() ? nullptr : std::get_if<bool>(&raw->second.value);
  const bool srgb = !(linear && *linear);
  const std::string path = fileOf(node, folders);
  if (path.empty()) return;
  std::shared_ptr<Picture>& known = m_images[imageKey(path, srgb)];
  if (known) return;
  known = std::make_shared<Picture>(
      [path, srgb, at = node.placeOf("filename")] { return Image::read(path, srgb, at); });
  m_tasks.run([picture = known] { picture->begin(); });
}

void FilesAhead::findVolume(const Properties& node, const std::vector<std::string>& folders) {
  const std::string path = fileOf(node, folders);
  if (path.empty()) return;
  std::shared_ptr<Grid>& grid = m_volumes[&node];
  grid = std::make_shared<Grid>([path, at = node.placeOf("filename")] { return readVolumeFile(path, at); });
  m_tasks.run([grid] { grid->begin(); });
}

void FilesAhead::readOn() {
  for (; m_next < m_queue.size() && m_bytesWaiting < m_mostBytesWaiting; ++m_next) {
    const std::shared_ptr<Mesh>& mesh = m_queue[m_next];
    if (mesh->taken) continue;
    mesh->begun = true;
    m_bytesWaiting += mesh->bytes;
    m_tasks.run([mesh] { mesh->work.begin(); });
  }
}

std::optional<MeshData> FilesAhead::takeMesh(const Properties& shape, Warnings& warnings) {
  const auto found = m_meshes.find(&shape);
  if (found == m_meshes.end() || found->second->taken) return std::nullopt;
  Mesh& mesh = *found->second;
  mesh.taken = true;
  if (mesh.begun) m_bytesWaiting -= mesh.bytes;
  readOn();
  ReadMesh read = mesh.work.take();
  warnings.add(read.warnings);
  return std::move(read.data);
}

std::optional<VolumeFile> FilesAhead::takeVolume(const Properties& volume) {
  const auto found = m_volumes.extract(&volume);
  if (!found) return std::nullopt;
  return found.mapped()->take();
}

std::shared_ptr<const Image> FilesAhead::takeImage(const std::string& path, bool srgb) {
  const auto found = m_images.extract(imageKey(path, srgb));
  return found ? found.mapped()->take() : nullptr;
}

}  // namespace odis::render
