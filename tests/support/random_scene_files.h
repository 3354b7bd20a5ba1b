// The files that random scenes refer to.
#pragma once

#include <array>
#include <fstream>
#include <limits>
#include <vector>

#include "render/image/write.h"
#include "support/temporary_folder.h"

namespace odis::test {

class SceneFiles {
 public:
  // `project` is the folder of the sources, where files of measurements and of shapes lie.
  explicit SceneFiles(std::string project) : m_project(std::move(project)) {
    write("mesh.obj") << "v -1 -1 0\nv 1 -1 0\nv 1 1 0.3\nv -1 1 0\nv 0 0 0\n"
                         "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\nf 1/1 3/1 5/1\nf 1 1 2\n";
    write("mesh.ply") << "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                         "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
                         "property float r\nproperty float g\nproperty float b\nelement face 3\n"
                         "property list uchar int vertex_indices\nproperty float share_0\nend_header\n"
                         "-1 0 0 0 0 1 1 0 0\n1 0 0 1 0 0 0 2 0\n0 1 0 0 0 0 0 0 -1\n0 0 1 0 0 -1 nan 1 1\n"
                         "3 0 1 2 0.5\n3 1 2 3 nan\n3 0 2 3 3\n";
    write("curves.txt") << "-1 0 0 0.1\n0 1 0 0.2\n1 0 0.5 0.1\n1 -1 0 0.05\n0 -1 0 0.1\n";
    write("map.hdr") << "#?RADIANCE\n\n-Y 2 +X 2\n\200\200\200\201\1\1\1\201\2\2\2\201\3\3\3\201";
    constexpr float kInf = std::numeric_limits<float>::infinity();
    writeImage("bad.exr", 3, {NAN, -NAN, kInf, -kInf, -1e30f, 1e30f, 1e-40f, 0.5f, 2.0f});
    writeImage("one.exr", 1, {0.7f});
    writeGrid("density.vol", 1, {0, 0, 1, 0.25f, 0, 0, 2, 0});
    writeGrid("albedo.vol", 3, {1, 0, 0.5f, 0.9f, 1,    1, 0, 0, 0, 0.3f, 0.7f, 0.9f,
                                1, 1, 1,    0.9f, 0.9f, 0, 0, 1, 0, 0.5f, 0.5f, 0.5f});
    writeGrid("flakes.vol", 6, flakes());
  }

  std::string path(const std::string& name) const { return m_folder.path(name); }
  std::string data(const std::string& name) const { return m_project + "/tests/bsdf/data/" + name; }
  std::string shape(const std::string& type) const {
    if (type == "obj") return path("mesh.obj");
    if (type == "ply") return path("mesh.ply");
    if (type == "serialized") return m_project + "/fuzz/corpus/serialized/whole4.serialized";
    if (type == "sdfgrid") return m_project + "/fuzz/corpus/volume/ball.vol";
    return path("curves.txt");
  }
  // Writes a scene, and returns where it lies.
  std::string scene(const std::string& text) const {
    write("scene.xml") << text;
    return path("scene.xml");
  }

 private:
  std::ofstream write(const std::string& name) const { return std::ofstream(path(name), std::ios::binary); }
  void writeImage(const std::string& name, int side, const std::vector<float>& grey) const {
    render::writeExr(path(name), {side, side, 0, 0, side, side},
                     {{"R", grey.data()}, {"G", grey.data()}, {"B", grey.data()}}, {});
  }

  // A volume of 2 x 2 x 2 voxels.
  void writeGrid(const std::string& name, int32_t channels, const std::vector<float>& values) const {
    std::ofstream file = write(name);
    const auto append = [&](const auto& x) { file.write(reinterpret_cast<const char*>(&x), sizeof(x)); };
    file << "VOL\3";
    for (const int32_t n : {1, 2, 2, 2, channels}) append(n);
    for (const float x : {-1.0f, -1.0f, -1.0f, 1.0f, 1.0f, 1.0f}) append(x);
    for (const float x : values) append(x);
  }
  static std::vector<float> flakes() {
    std::vector<float> values;
    for (int voxel = 0; voxel < 8; ++voxel)
      for (const double x : {1.0, 0.1 + voxel, 1e-3, 0.0, voxel % 2 * 0.01, 0.0}) values.push_back(float(x));
    return values;
  }

  TemporaryFolder m_folder;
  std::string m_project;
};

}  // namespace odis::test
