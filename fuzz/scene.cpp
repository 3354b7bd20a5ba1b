// Scene files, as far as an image of 4 x 4 pixels: everything that a scene can hold, with a few files beside
// it to refer to.
#include <filesystem>
#include <fstream>
#include <string>

#include "render/integrators/render.h"
#include "render/scene/scene.h"

namespace {

namespace fs = std::filesystem;
using namespace odis::render;

// The folder that the scenes lie in, removed at the end.
class Folder {
 public:
  Folder() {
    std::string pattern = (fs::temp_directory_path() / "odis-fuzz-XXXXXX").string();
    if (!mkdtemp(pattern.data())) std::abort();
    m_path = pattern;
    std::ofstream(m_path / "mesh.obj")
        << "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n";
    std::ofstream(m_path / "map.hdr")
        << "#?RADIANCE\n\n-Y 2 +X 2\n\200\200\200\201\1\1\1\201\2\2\2\201\3\3\3\201";
    std::ofstream(m_path / "part.xml") << "<bsdf type=\"diffuse\" id=\"part\"/>";
    std::ofstream(m_path / "line.spd") << "400 0.5\n700 0.75\n";
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(m_path, ignored);
  }
  std::string path(const char* name) const { return (m_path / name).string(); }

 private:
  fs::path m_path;
};

void renderScene(const std::string& path) {
  LoadOptions load;
  load.resolution = Vec2i(4, 4);
  Warnings warnings;
  const std::unique_ptr<Scene> scene = Scene::load(path, load, warnings);
  RenderOptions options;
  options.spp = 2;
  options.maxDepth = 6;
  options.threads = 1;
  options.variance = options.features = options.guideFeatures = true;
  Progress quiet;
  const RenderResult result = render(*scene, options, quiet);
  if (result.image.color.size() != 16) std::abort();
  for (const Rgb& color : result.image.color)
    if (std::isnan(color.x) || std::isnan(color.y) || std::isnan(color.z)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  static const Folder folder;
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  // Files elsewhere on the machine are none of ours.
  for (const char* outside : {"=\"/", "='/", ".."})
    if (text.find(outside) != std::string::npos) return -1;
  const std::string path = folder.path("scene.xml");
  std::ofstream(path, std::ios::binary) << text;
  try {
    renderScene(path);
  } catch (const SceneError&) {
  } catch (const OptionError&) {
  }
  return 0;
}
