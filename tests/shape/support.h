// What the tests of shapes and of the intersector share.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "render/scene/scene.h"
#include "render/shape/affine.h"
#include "render/shape/cylinder.h"
#include "render/shape/disk.h"
#include "render/shape/mesh.h"
#include "render/shape/plain_meshes.h"
#include "render/shape/sphere.h"
#include "support/random.h"

namespace odis::test {

using namespace odis::render;

inline std::unique_ptr<Scene> sceneOf(const std::vector<ShapePtr>& shapes) {
  auto scene = std::make_unique<Scene>();
  for (const ShapePtr& shape : shapes) scene->addShape(shape);
  scene->finish();
  return scene;
}

inline std::shared_ptr<Mesh> meshOf(MeshData data, const MeshOptions& options = {}) {
  Warnings warnings;
  return Mesh::make(std::move(data), options, {}, warnings);
}

inline std::shared_ptr<Sphere> sphereOf(const Vec3d& center, double radius, bool flip = false) {
  return std::make_shared<Sphere>(center, radius,
                                  std::array<Vec3d, 3>{Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)}, flip);
}

inline Matrix4 rotation(float x, float y, float z) {
  Matrix4 m;
  m.setEulerAngles(Vec3(x, y, z));
  return m;
}

inline Matrix4 scaling(const Vec3& s) {
  Matrix4 m;
  m.setScale(s);
  return m;
}

inline Matrix4 translation(const Vec3& t) {
  Matrix4 m;
  m.setTranslation(t);
  return m;
}

// A file in a folder of its own, removed at the end.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, const std::string& content) {
    static int count = 0;
    m_folder = std::filesystem::temp_directory_path() /
               ("odis_shape_test_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
    std::filesystem::create_directories(m_folder);
    std::ofstream(path(name), std::ios::binary) << content;
    m_path = path(name);
  }
  ~TemporaryFile() { std::filesystem::remove_all(m_folder); }
  TemporaryFile(const TemporaryFile&) = delete;
  const std::string& path() const { return m_path; }

 private:
  std::string path(const std::string& name) const { return (m_folder / name).string(); }
  std::filesystem::path m_folder;
  std::string m_path;
};

inline ::testing::AssertionResult near(const Vec3& a, const Vec3& b, float tolerance = 1e-5f) {
  if (length(a - b) <= tolerance) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "(" << a.x << ", " << a.y << ", " << a.z << ") is not near (" << b.x
                                       << ", " << b.y << ", " << b.z << ")";
}

inline ::testing::AssertionResult near(const Vec2& a, const Vec2& b, float tolerance = 1e-5f) {
  return near(Vec3(a.x, a.y, 0), Vec3(b.x, b.y, 0), tolerance);
}

}  // namespace odis::test
