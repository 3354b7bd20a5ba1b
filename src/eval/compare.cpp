#include "eval/compare.h"

#include <filesystem>

#include "eval/equal_time.h"
#include "eval/median.h"
#include "eval/scene_run.h"

namespace odis::eval {

namespace fs = std::filesystem;

std::string sceneName(const std::string& path) {
  const fs::path absolute = fs::absolute(path).lexically_normal();
  const std::string stem = absolute.stem().string();
  return stem == "scene" ? absolute.parent_path().filename().string() : stem;
}

namespace {

Schedule planOf(const CompareSettings& settings) {
  Schedule schedule;
  for (const std::string& path : settings.scenes) {
    const std::string scene = sceneName(path);
    schedule.plan(scene, "reference", settings.referenceSpp);
    for (int seed = 0; seed < settings.seeds; ++seed)
      for (const int spp : settings.spp)
        for (const Method& method : settings.methods) {
          schedule.plan(scene, method.name, spp);
          if (settings.equalTime && &method != &settings.methods.front())
            schedule.plan(scene, settings.methods.front().name, spp);
        }
  }
  return schedule;
}

// The median time that a method took for each number of samples.
std::vector<TimePoint> timesOf(const std::vector<Measurement>& measurements, const std::string& scene,
                               const std::string& method) {
  std::map<int, std::vector<double>> bySpp;
  for (const Measurement& m : measurements)
    if (m.scene == scene && m.method == method && !m.equalTime && !m.denoised)
      bySpp[m.spp].push_back(m.seconds);
  std::vector<TimePoint> points;
  for (const auto& [spp, seconds] : bySpp) points.push_back({double(spp), median(seconds)});
  return points;
}

// Methods take turns within a seed. False if cancelled.
bool compareAtEqualSamples(const CompareSettings& settings, SceneRun& run, const render::Progress& progress,
                           std::vector<Measurement>& results) {
  for (int seed = 0; seed < settings.seeds; ++seed)
    for (const int spp : settings.spp)
      for (const Method& method : settings.methods) {
        const std::vector<Measurement> measured = run.measure(method, {spp, spp, false}, uint64_t(seed));
        if (progress.cancelled()) return false;
        results.insert(results.end(), measured.begin(), measured.end());
      }
  return true;
}

// The same for all methods but the first, with what fits in the time that the first took.
bool compareAtEqualTime(const CompareSettings& settings, SceneRun& run, const render::Progress& progress,
                        std::vector<Measurement>& results) {
  const std::string& scene = run.record().name;
  const std::vector<TimePoint> allowed = timesOf(results, scene, settings.methods.front().name);
  std::vector<std::vector<TimePoint>> taken;
  for (const Method& method : settings.methods) taken.push_back(timesOf(results, scene, method.name));
  for (int seed = 0; seed < settings.seeds; ++seed)
    for (size_t i = 0; i < settings.spp.size(); ++i)
      for (size_t method = 1; method < settings.methods.size(); ++method) {
        const Budget budget{settings.spp[i], samplesInTime(taken[method], allowed[i].seconds), true};
        const std::vector<Measurement> measured =
            run.measure(settings.methods[method], budget, uint64_t(seed));
        if (progress.cancelled()) return false;
        results.insert(results.end(), measured.begin(), measured.end());
      }
  return true;
}

}  // namespace

Comparison compare(const CompareSettings& settings, CompareObserver& observer) {
  fs::create_directories(settings.folder);
  ResultsLog log(settings.folder + "/results.jsonl", settings.fresh);
  Schedule schedule = planOf(settings);
  Comparison result;
  for (const std::string& path : settings.scenes) {
    SceneRun run(settings, path, log, schedule, observer);
    if (observer.progress().cancelled()) return result;
    result.scenes.push_back(run.record());
    if (!compareAtEqualSamples(settings, run, observer.progress(), result.measurements)) return result;
    if (settings.equalTime && !compareAtEqualTime(settings, run, observer.progress(), result.measurements))
      return result;
  }
  return result;
}

}  // namespace odis::eval
