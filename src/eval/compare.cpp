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

// The median of the processor's time that a method took for each number of samples.
std::vector<TimePoint> timesOf(const std::vector<Measurement>& measurements, const std::string& scene,
                               const std::string& method) {
  std::map<int, std::vector<double>> bySpp;
  for (const Measurement& m : measurements)
    if (m.scene == scene && m.method == method && !m.equalTime && !m.denoised)
      bySpp[m.spp].push_back(m.cpuSeconds);
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

// What fits in the time of the first method, and what is the same image: with as many samples as that.
struct Fit {
  Budget budget, like;
  bool isNew() const { return like.equalTime && like.spp == budget.spp; }
};

std::vector<Fit> fitsOf(const std::vector<int>& spp, const std::vector<TimePoint>& taken,
                        const std::vector<TimePoint>& allowed) {
  std::vector<Fit> fits;
  for (size_t i = 0; i < spp.size(); ++i) {
    const Budget budget{spp[i], samplesInTime(taken, allowed[i].seconds), true};
    Fit fit{budget, budget};
    for (const Fit& before : fits)
      if (before.budget.samples == budget.samples && fit.isNew()) fit.like = before.like;
    for (const int samples : spp)
      if (samples == budget.samples) fit.like = {samples, samples, false};
    fits.push_back(fit);
  }
  return fits;
}

// What was measured of the image that `fit` shares with another row.
std::vector<Measurement> takenOver(const std::vector<Measurement>& results, const std::string& scene,
                                   const std::string& method, const Fit& fit, uint64_t seed) {
  std::vector<Measurement> found;
  for (const Measurement& m : results) {
    if (m.scene != scene || m.method != method || m.seed != seed) continue;
    if (m.spp != fit.like.spp || m.equalTime != fit.like.equalTime) continue;
    found.push_back(m);
    found.back().spp = fit.budget.spp;
    found.back().equalTime = true;
  }
  return found;
}

// The same for all methods but the first, with what fits in the time that the first took.
bool compareAtEqualTime(const CompareSettings& settings, SceneRun& run, const render::Progress& progress,
                        std::vector<Measurement>& results) {
  const std::string& scene = run.record().name;
  const std::vector<TimePoint> allowed = timesOf(results, scene, settings.methods.front().name);
  std::vector<std::vector<Fit>> fits;
  for (const Method& method : settings.methods)
    fits.push_back(fitsOf(settings.spp, timesOf(results, scene, method.name), allowed));
  for (int seed = 0; seed < settings.seeds; ++seed)
    for (size_t i = 0; i < settings.spp.size(); ++i)
      for (size_t method = 1; method < settings.methods.size(); ++method) {
        const Fit& fit = fits[method][i];
        std::vector<Measurement> measured;
        if (fit.budget.samples > 0 && fit.isNew())
          measured = run.measure(settings.methods[method], fit.budget, uint64_t(seed));
        else
          run.skip(fit.budget);
        if (fit.budget.samples > 0 && !fit.isNew())
          measured = takenOver(results, scene, settings.methods[method].name, fit, uint64_t(seed));
        if (progress.cancelled()) return false;
        results.insert(results.end(), measured.begin(), measured.end());
      }
  return true;
}

// Whether a reference of the scene was rendered into the folder before, be it another one than is needed.
bool hasReference(const CompareSettings& settings, const std::string& scene) {
  std::error_code error;
  for (fs::directory_iterator it(settings.folder + "/references", error), end; !error && it != end;
       it.increment(error))
    if (it->path().filename().string().starts_with(scene + "-")) return true;
  return !settings.reference.empty();
}

Schedule planOf(const CompareSettings& settings) {
  Schedule schedule;
  for (const std::string& path : settings.scenes) {
    const std::string scene = sceneName(path);
    schedule.plan(scene, "reference", hasReference(settings, scene) ? 0 : settings.referenceSpp);
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

}  // namespace

Comparison compare(const CompareSettings& settings, CompareObserver& observer) {
  fs::create_directories(settings.folder);
  ResultsLog log(settings.folder + "/results.jsonl", settings.fresh);
  Schedule schedule = planOf(settings);
  Comparison result;
  for (const std::string& path : settings.scenes) {
    SceneRun run(settings, path, log, schedule, observer);
    run.timeASample();
    if (path == settings.scenes.front()) observer.begin(schedule.outlook());
    run.takeReference();
    if (observer.progress().cancelled()) return result;
    result.scenes.push_back(run.record());
    if (!compareAtEqualSamples(settings, run, observer.progress(), result.measurements)) return result;
    if (settings.equalTime && !compareAtEqualTime(settings, run, observer.progress(), result.measurements))
      return result;
  }
  return result;
}

}  // namespace odis::eval
