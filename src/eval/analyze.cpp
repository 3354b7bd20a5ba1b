#include "eval/analyze.h"

namespace odis::eval {

using namespace render;

static constexpr uint64_t kReferenceSeed = 0x7265666572656eull;

SceneAnalysis analyzeScene(const AnalyzeSettings& settings, const std::string& path, Warnings& warnings,
                           Progress& progress) {
  const std::unique_ptr<Scene> scene = Scene::load(path, settings.load, warnings);
  const auto withDepths = [&](RenderOptions options) {
    options.maxDepth = settings.maxDepth.value_or(scene->integrator().maxDepth);
    options.rrDepth = settings.rrDepth.value_or(scene->integrator().rrDepth);
    return options;
  };
  SceneAnalysis result{sceneName(path), scene->film().crop.width, scene->film().crop.height, {}};

  RenderOptions options;
  options.spp = settings.referenceSpp;
  options.seed = settings.seed ^ kReferenceSeed;
  options.threads = settings.methods.front().options.threads;
  const ColorImage reference{result.width, result.height,
                             render::render(*scene, withDepths(options), progress).image.color};

  for (const Method& method : settings.methods) {
    if (progress.cancelled()) return {};
    options = withDepths(method.options);
    options.spp = settings.imageSpp;
    options.seed = settings.seed;
    result.splits.push_back(splitVariance(*scene, options, reference, settings.samples, progress));
  }
  if (progress.cancelled()) result.splits.clear();
  return result;
}

}  // namespace odis::eval
