// What must hold of every random scene, however it is rendered.
#pragma once

#include <cmath>

#include "render/integrators/render.h"
#include "render/scene/scene.h"
#include "support/random_scene.h"

namespace odis::test {

// One way to render.
struct Rendering {
  const char* name;
  render::IntegratorKind integrator;
  int spp;
  bool cached;
};
// As few samples as let the guides be built more than once.
inline constexpr Rendering kRenderings[] = {{"path", render::IntegratorKind::path, 8, false},
                                            {"odis", render::IntegratorKind::odis, 6, false},
                                            {"odis --cached", render::IntegratorKind::odis, 6, true},
                                            {"ppg", render::IntegratorKind::ppg, 3, false}};

inline std::string failureOf(const render::Scene& scene, const Rendering& rendering) {
  render::RenderOptions options;
  options.integrator = rendering.integrator;
  options.spp = rendering.spp;
  if (rendering.cached) options.set("cached=on");
  options.maxDepth = scene.integrator().maxDepth;
  options.rrDepth = scene.integrator().rrDepth;
  options.threads = 1;
  options.set("guided-cost=0");  // guides and refines, however little it gains
  options.variance = options.features = options.guideFeatures = true;
  render::Progress quiet;
  const render::RenderResult result = render::render(scene, options, quiet);
  const render::Crop& crop = scene.film().crop;
  if (result.image.color.size() != size_t(crop.width) * size_t(crop.height))
    return std::string(rendering.name) + ": the image has another number of pixels";
  for (const render::Rgb& color : result.image.color)
    if (!render::isFinite(color)) return std::string(rendering.name) + ": a pixel is not a finite number";
  return "";
}

// Empty if all is well. Throws SceneError where the scene can't be loaded.
inline std::string failureOfScene(const std::string& path) {
  render::Warnings warnings;
  const std::unique_ptr<render::Scene> scene = render::Scene::load(path, {}, warnings);
  for (const Rendering& rendering : kRenderings)
    if (std::string failure = failureOf(*scene, rendering); !failure.empty()) return failure;
  return "";
}

}  // namespace odis::test
