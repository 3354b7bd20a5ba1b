#include "eval/compare.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "eval/image_file.h"
#include "eval/load_scene.h"
#include "eval/montage.h"
#include "eval/reference.h"
#include "eval/results_log.h"
#include "eval/scene_hash.h"
#include "odis_version.h"
#include "render/image/write.h"

namespace odis::eval {

using namespace render;
namespace fs = std::filesystem;

std::string sceneName(const std::string& path) {
  const fs::path absolute = fs::absolute(path).lexically_normal();
  const std::string stem = absolute.stem().string();
  return stem == "scene" ? absolute.parent_path().filename().string() : stem;
}

namespace {

// One scene's share of a comparison.
class SceneRun {
 public:
  SceneRun(const CompareSettings& settings, const std::string& path, ResultsLog& log,
           CompareObserver& observer)
      : m_settings(settings), m_name(sceneName(path)), m_log(log), m_observer(observer) {
    observer.start(m_name);
    Warnings warnings;
    m_scene = loadScene(path, settings.load, settings.pixels, warnings);
    observer.warnings(warnings);
    m_hash = hashScene(path, settings.load.defines);
    RenderOptions options;
    options.maxDepth = settings.maxDepth.value_or(m_scene->integrator().maxDepth);
    options.rrDepth = settings.rrDepth.value_or(m_scene->integrator().rrDepth);
    observer.start(m_name + ": reference");
    m_reference = settings.reference.empty()
                      ? cachedReference(*m_scene, m_name, m_hash, options, settings.referenceSpp,
                                        settings.folder + "/references", observer.progress())
                      : readColor(settings.reference);
    if (m_reference.pixels.empty()) return;
    const Crop& crop = m_scene->film().crop;
    if (m_reference.width != crop.width || m_reference.height != crop.height)
      throw ImageError(fmt::format("{}: is {} x {}, the image of {} is {} x {}", settings.reference,
                                   m_reference.width, m_reference.height, m_name, crop.width, crop.height));
  }

  Measurement measure(const Method& method, uint64_t seed) {
    RenderOptions options = method.options;
    options.spp = m_settings.spp;
    options.seed = seed;
    options.maxDepth = m_settings.maxDepth.value_or(m_scene->integrator().maxDepth);
    options.rrDepth = m_settings.rrDepth.value_or(m_scene->integrator().rrDepth);
    const Crop& crop = m_scene->film().crop;
    const std::string key = hexText(hashText(
        fmt::format("{} {} {}x{} {} {} {} {} {} {} {} {} {} {}", hexText(m_hash), method.text,
                    m_scene->film().width, m_scene->film().height, crop.x, crop.y, crop.width, crop.height,
                    options.spp, options.maxDepth, options.rrDepth, seed, ODIS_VERSION_STRING,
                    m_settings.reference + std::to_string(m_settings.referenceSpp))));
    const bool wantsImage = m_settings.images && seed == 0;
    const Measurement* known = m_log.find(key);
    if (known && !(wantsImage && known->image.empty())) return *known;

    m_observer.start(fmt::format("{}: {}, seed {}", m_name, method.name, seed));
    const RenderResult result = render::render(*m_scene, options, m_observer.progress());
    Measurement m;
    m.scene = m_name;
    m.method = method.name;
    m.seed = seed;
    m.key = key;
    if (result.stats.interrupted) return m;
    m.error = compareImages({result.frame.width, result.frame.height, result.frame.color}, m_reference);
    m.seconds = result.stats.secondsPilot + result.stats.secondsBuild + result.stats.secondsGuided;
    m.spp = result.stats.spp;
    m.rays = result.stats.rays + result.stats.shadowRays;
    if (wantsImage) m.image = writeImages(method, result.frame);
    m_log.add(m);
    return m;
  }

  // Puts the images that this run made, and the reference, side by side; nothing if an earlier run made some.
  void writeMontage() {
    if (m_shown.size() != m_settings.methods.size()) return;
    m_shown.push_back(m_reference);
    const ColorImage all = montage(m_shown);
    writePng(fmt::format("{}/images/{}.png", m_settings.folder, m_name), all.width, all.height,
             all.pixels.data(), m_settings.exposure);
  }

 private:
  std::string writeImages(const Method& method, const Frame2D& frame) {
    const std::string folder = m_settings.folder + "/images";
    fs::create_directories(folder);
    const std::string stem = fmt::format("{}/{}-{}", folder, m_name, method.name);
    writeColor(stem + ".exr", frame, m_scene->film().width, m_scene->film().height,
               {{"odis:method", method.text}, {"odis:version", ODIS_VERSION_STRING}});
    writePng(stem + ".png", frame.width, frame.height, frame.color.data(), m_settings.exposure);
    m_shown.push_back({frame.width, frame.height, frame.color});
    return stem + ".png";
  }

  const CompareSettings& m_settings;
  std::string m_name;
  ResultsLog& m_log;
  CompareObserver& m_observer;
  std::unique_ptr<Scene> m_scene;
  uint64_t m_hash = 0;
  ColorImage m_reference;
  std::vector<ColorImage> m_shown;
};

}  // namespace

std::vector<Measurement> compare(const CompareSettings& settings, CompareObserver& observer) {
  fs::create_directories(settings.folder);
  ResultsLog log(settings.folder + "/results.jsonl", settings.fresh);
  std::vector<Measurement> results;
  for (const std::string& path : settings.scenes) {
    SceneRun run(settings, path, log, observer);
    if (observer.progress().cancelled()) return results;
    for (int seed = 0; seed < settings.seeds; ++seed) {
      for (const Method& method : settings.methods) {
        Measurement measurement = run.measure(method, uint64_t(seed));
        if (observer.progress().cancelled()) return results;
        results.push_back(std::move(measurement));
      }
    }
    if (settings.images) run.writeMontage();
  }
  return results;
}

}  // namespace odis::eval
