// Small scenes for the integrators, as text.
#pragma once

#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "render/integrators/render.h"
#include "render/scene/scene.h"

namespace odis::test {

inline std::unique_ptr<render::Scene> loadScene(const std::string& body) {
  static int count = 0;
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() /
      ("odis_test_" + std::to_string(getpid()) + "_" + std::to_string(count++) + ".xml");
  std::ofstream(path) << "<scene version=\"3.0.0\">" << body << "</scene>";
  render::Warnings warnings;
  auto scene = render::Scene::load(path.string(), {}, warnings);
  std::filesystem::remove(path);
  return scene;
}

inline std::string sensor(const std::string& lookAt, float fov, int width, int height,
                          const std::string& medium = {}) {
  return "<sensor type=\"perspective\"><float name=\"fov\" value=\"" + std::to_string(fov) +
         "\"/><transform name=\"to_world\"><lookat " + lookAt +
         "/></transform><film type=\"hdrfilm\"><integer name=\"width\" value=\"" + std::to_string(width) +
         "\"/><integer name=\"height\" value=\"" + std::to_string(height) +
         "\"/><rfilter type=\"box\"/></film>" + medium + "</sensor>";
}

// The inside of a unit sphere that emits radiance 1 and reflects half of what it receives: radiance 1 / (1 -
// 0.5) = 2 arrives everywhere from every direction.
inline std::string furnace(const std::string& bsdf, int size = 8) {
  return sensor("origin=\"0.1,0.2,0.1\" target=\"1,0,0\" up=\"0,1,0\"", 60, size, size) +
         "<shape type=\"sphere\"><boolean name=\"flip_normals\" value=\"true\"/>" + bsdf +
         "<emitter type=\"area\"><rgb name=\"radiance\" value=\"1\"/></emitter></shape>";
}

// A room lit by a lamp that is turned to the ceiling: mostly indirect light, so that guiding has something to
// do.
inline std::string indirectRoom(int size = 24) {
  const auto wall = [](const std::string& transform, const std::string& color) {
    return "<shape type=\"rectangle\"><transform name=\"to_world\">" + transform +
           "</transform><bsdf type=\"twosided\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"" +
           color + "\"/></bsdf></bsdf></shape>";
  };
  return sensor("origin=\"0,0,3.4\" target=\"0,0,0\" up=\"0,1,0\"", 38, size, size) +
         wall("<rotate x=\"1\" angle=\"-90\"/><translate y=\"-1\"/>", "0.7 0.7 0.7") +
         wall("<rotate x=\"1\" angle=\"90\"/><translate y=\"1\"/>", "0.7 0.7 0.7") +
         wall("<translate z=\"-1\"/>", "0.6 0.6 0.7") +
         wall("<rotate y=\"1\" angle=\"90\"/><translate x=\"-1\"/>", "0.7 0.2 0.2") +
         wall("<rotate y=\"1\" angle=\"-90\"/><translate x=\"1\"/>", "0.2 0.7 0.2") +
         "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"0.15\"/><rotate x=\"1\" "
         "angle=\"-90\"/>"
         "<translate x=\"0.4\" y=\"0.5\" z=\"-0.3\"/></transform><bsdf type=\"diffuse\"/>"
         "<emitter type=\"area\"><rgb name=\"radiance\" value=\"60\"/></emitter></shape>"
         "<shape type=\"sphere\"><point name=\"center\" x=\"-0.4\" y=\"-0.6\" z=\"-0.2\"/><float "
         "name=\"radius\" value=\"0.4\"/>"
         "<bsdf type=\"roughconductor\"><string name=\"material\" value=\"Cu\"/><float name=\"alpha\" "
         "value=\"0.25\"/></bsdf></shape>"
         "<shape type=\"sphere\"><point name=\"center\" x=\"0.5\" y=\"-0.7\" z=\"0.1\"/><float "
         "name=\"radius\" value=\"0.3\"/>"
         "<bsdf type=\"plastic\"/></shape>";
}

// The text of a scene of these with another filter than a box, and more in its film.
inline std::string filtered(std::string text, const std::string& filter, const std::string& more = "") {
  const std::string box = "<rfilter type=\"box\"/>";
  return text.replace(text.find(box), box.size(), more + "<rfilter type=\"" + filter + "\"/>");
}

inline render::RenderResult renderScene(const render::Scene& scene, const render::RenderOptions& options) {
  render::Progress quiet;
  return render::render(scene, options, quiet);
}

inline bool sameBits(const std::vector<render::Rgb>& a, const std::vector<render::Rgb>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(render::Rgb)) == 0;
}

}  // namespace odis::test
