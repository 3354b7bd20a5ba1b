#include "eval/scene_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>

#include "eval/scene_hash.h"
#include "odis_version.h"
#include "render/integrators/job.h"

namespace odis::eval {

using namespace render;
namespace fs = std::filesystem;

SceneRun::SceneRun(const CompareSettings& settings, const std::string& path, ResultsLog& log,
                   Schedule& schedule, CompareObserver& observer)
    : m_settings(settings), m_log(log), m_schedule(schedule), m_observer(observer) {
  m_record.name = sceneName(path);
  m_record.file = path;
  observer.start(m_record.name, schedule.outlook());
  Warnings warnings;
  m_scene = Scene::load(path, settings.load, warnings);
  observer.warnings(path, warnings);
  m_record.hash = hashScene(path, settings.load.defines);
  m_record.width = m_scene->film().crop.width;
  m_record.height = m_scene->film().crop.height;
  m_record.maxDepth = settings.maxDepth.value_or(m_scene->integrator().maxDepth);
  m_record.rrDepth = settings.rrDepth.value_or(m_scene->integrator().rrDepth);
}

RenderOptions SceneRun::plainOptions(int spp) const {
  RenderOptions options;
  options.maxDepth = m_record.maxDepth;
  options.rrDepth = m_record.rrDepth;
  options.threads = m_settings.methods.front().options.threads;
  options.spp = spp;
  return options;
}

void SceneRun::timeASample() {
  if (!m_schedule.isPending(m_record.name)) return;
  RenderOptions options = plainOptions(1);
  options.integrator = IntegratorKind::path;
  const Stopwatch watch;
  render::render(*m_scene, options, m_observer.progress());
  m_schedule.learn(m_record.name, watch.seconds());
}

void SceneRun::takeReference() {
  const CompareSettings& settings = m_settings;
  m_observer.start(m_record.name + ": reference", m_schedule.outlook());
  if (settings.reference.empty())
    m_reference = cachedReference(*m_scene, m_record.name, m_record.hash, plainOptions(settings.referenceSpp),
                                  settings.folder + "/references", m_observer.progress());
  else
    m_reference = readReference(settings.reference);
  m_schedule.finish(m_record.name, "reference", settings.referenceSpp, m_reference.secondsRendered);
  const ColorImage& image = m_reference.image;
  if (image.pixels.empty()) return;  // cancelled
  if (image.width != m_record.width || image.height != m_record.height)
    throw ImageError(fmt::format("{}: is {} x {}, the image of {} is {} x {}", settings.reference,
                                 image.width, image.height, m_record.name, m_record.width, m_record.height));
  m_record.reference = m_reference.file;
  m_record.referenceSettings = m_reference.settings;
  m_record.referenceError = m_reference.error;
}

std::string SceneRun::keyOf(const Method& method, const RenderOptions& options, const Budget& budget) const {
  const FilmSettings& film = m_scene->film();
  return hexText(hashText(fmt::format("{} {} {}x{} {} {} {} {} {} {} {} {} {} {} {}", hexText(m_record.hash),
                                      method.text, film.width, film.height, film.crop.x, film.crop.y,
                                      film.crop.width, film.crop.height, options.spp, options.maxDepth,
                                      options.rrDepth, options.seed, ODIS_VERSION_STRING,
                                      m_settings.reference + std::to_string(m_settings.referenceSpp),
                                      budget.equalTime ? fmt::format("time of {}", budget.spp) : "")));
}

std::string SceneRun::denoisedKey(const std::string& key) const {
  return hexText(hashText(key + " denoised with clean auxiliary images by " + m_settings.denoiser->name()));
}

void SceneRun::renderAuxiliariesOf(uint64_t seed, int threads) {
  if (!m_auxiliaries.albedo.empty() && m_auxiliarySeed == seed) return;
  const std::clock_t start = std::clock();
  const Stopwatch watch;
  m_auxiliaries = renderAuxiliaries(*m_scene, seed, threads, m_observer.progress());
  m_auxiliarySeed = seed;
  m_auxiliarySeconds = watch.seconds();
  m_auxiliaryCpuSeconds = double(std::clock() - start) / CLOCKS_PER_SEC;
}

// The measurement of the same image after the denoiser; nothing if that was cancelled.
std::optional<Measurement> SceneRun::measureDenoised(Measurement m, const Method& method,
                                                     const RenderedImage& noisy) {
  const std::clock_t start = std::clock();
  const Stopwatch watch;
  const DenoiserInput input{noisy.width, noisy.height, noisy.color, m_auxiliaries.albedo,
                            m_auxiliaries.normal};
  auto colors = m_settings.denoiser->denoise(input, Auxiliaries::clean, m_observer.progress());
  if (!colors) return {};
  m.seconds += watch.seconds() + m_auxiliarySeconds;
  m.cpuSeconds += double(std::clock() - start) / CLOCKS_PER_SEC + m_auxiliaryCpuSeconds;
  m.denoised = true;
  m.key = denoisedKey(m.key);
  RenderedImage image = noisy;
  image.color = std::move(*colors);
  return measureImage(m, method, image);
}

std::optional<std::vector<Measurement>> SceneRun::known(const Method& method, const std::string& key,
                                                        uint64_t seed) const {
  std::vector<std::string> keys{key};
  if (m_settings.denoiser) keys.push_back(denoisedKey(key));
  std::vector<Measurement> found;
  for (const std::string& each : keys) {
    const Measurement* known = m_log.find(each);
    if (!known || (seed == 0 && !fs::exists(m_settings.folder + "/" + known->image))) return {};
    found.push_back(*known);
    // The same scene and the same options may go by other names today.
    found.back().scene = m_record.name;
    found.back().method = method.name;
  }
  return found;
}

Measurement SceneRun::measureImage(const Measurement& what, const Method& method,
                                   const RenderedImage& image) {
  Measurement m = what;
  m.error = compareImages({image.width, image.height, image.color}, m_reference.image);
  if (m.seed == 0) m.image = writeImage(m, method, image);
  m_log.add(m);
  return m;
}

void SceneRun::skip(const Budget& budget) {
  m_schedule.finish(m_record.name, m_settings.methods.front().name, budget.spp, 0);
}

std::vector<Measurement> SceneRun::measure(const Method& method, const Budget& budget, uint64_t seed) {
  RenderOptions options = method.options;
  options.spp = budget.samples;
  options.seed = seed;
  options.maxDepth = m_record.maxDepth;
  options.rrDepth = m_record.rrDepth;
  const std::string key = keyOf(method, options, budget);
  // What takes a given time is planned as if it were the first method.
  const std::string& planned = budget.equalTime ? m_settings.methods.front().name : method.name;
  if (auto known = this->known(method, key, seed)) {
    m_schedule.finish(m_record.name, planned, budget.spp, known->back().seconds);
    return *known;
  }

  m_observer.start(fmt::format("{}: {}, {} spp, seed {}", m_record.name, method.name, budget.samples, seed),
                   m_schedule.outlook());
  Measurement m;
  const std::clock_t start = std::clock();  // of all threads
  const RenderResult result = render::render(*m_scene, options, m_observer.progress());
  if (result.stats.interrupted) return {};
  m.cpuSeconds = double(std::clock() - start) / CLOCKS_PER_SEC;
  m.scene = m_record.name;
  m.method = method.name;
  m.spp = budget.spp;
  m.equalTime = budget.equalTime;
  m.seed = seed;
  m.key = key;
  m.seconds = result.stats.secondsPilot + result.stats.secondsBuild + result.stats.secondsGuided;
  m.samples = result.stats.spp;
  m.rays = result.stats.rays + result.stats.shadowRays;
  std::vector<Measurement> measured{measureImage(m, method, result.image)};
  if (m_settings.denoiser) {
    renderAuxiliariesOf(seed, options.threads);
    if (m_auxiliaries.albedo.empty()) return {};  // cancelled
    const auto denoised = measureDenoised(m, method, result.image);
    if (!denoised) return {};
    measured.push_back(*denoised);
  }
  m_schedule.finish(m_record.name, planned, budget.spp, measured.back().seconds);
  return measured;
}

std::string SceneRun::writeImage(const Measurement& m, const Method& method,
                                 const RenderedImage& frame) const {
  fs::create_directories(m_settings.folder + "/images");
  // The key keeps images of the same name but other settings apart.
  const std::string name =
      fmt::format("images/{}-{}-{}{}{}-{}.exr", m.scene, m.method, m.spp, m.equalTime ? "-time" : "",
                  m.denoised ? "-denoised" : "", m.key.substr(0, 8));
  std::map<std::string, std::string> metadata{{"odis:method", method.text},
                                              {"odis:version", ODIS_VERSION_STRING}};
  if (m.denoised) metadata["odis:denoiser"] = m_settings.denoiser->name();
  writeColor(m_settings.folder + "/" + name, frame, m_scene->film().width, m_scene->film().height, metadata);
  return name;
}

}  // namespace odis::eval
