#include "eval/load_scene.h"

namespace odis::eval {

using namespace render;

std::unique_ptr<Scene> loadScene(const std::string& path, LoadOptions options, int pixels,
                                 Warnings& warnings) {
  std::unique_ptr<Scene> scene = Scene::load(path, options, warnings);
  if (pixels <= 0) return scene;
  const double aspect = double(scene->film().width) / scene->film().height;
  options.resolution = Vec2i(std::max(1, int(std::lround(std::sqrt(pixels * aspect)))),
                             std::max(1, int(std::lround(std::sqrt(pixels / aspect)))));
  scene.reset();  // never two in memory
  return Scene::load(path, options, warnings);
}

}  // namespace odis::eval
