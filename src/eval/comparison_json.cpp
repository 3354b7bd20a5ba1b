#include "eval/comparison_json.h"

#include <fmt/format.h>

#include <fstream>
#include <thread>

#include "eval/results_log.h"
#include "eval/scene_hash.h"
#include "odis_version.h"

namespace odis::eval {

using Json = nlohmann::ordered_json;

std::string machineName() {
  std::string name = "unknown processor";
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);)
    if (line.rfind("model name", 0) == 0 && line.find(": ") != std::string::npos) {
      name = line.substr(line.find(": ") + 2);
      break;
    }
  return fmt::format("{}, {} threads", name, std::thread::hardware_concurrency());
}

static Json toJson(const Interval& interval) {
  return Json::array({interval.value, interval.low, interval.high});
}

static Json toJson(const SamplesNeeded& needed) {
  static constexpr const char* kWhere[] = {"unknown", "below", "within", "beyond"};
  return {{"where", kWhere[needed.where]}, {"samples", needed.samples}};
}

static Json toJson(const ComparisonRow& row) {
  Json json = {{"scene", row.scene},
               {"method", row.method},
               {"spp", row.spp},
               {"equalTime", row.equalTime},
               {"denoised", row.denoised},
               {"seeds", row.seeds},
               {"samples", row.samples},
               {"errorRatio", toJson(row.errorRatio)},
               {"untrimmedRatio", toJson(row.untrimmedRatio)},
               {"errorTimeRatio", toJson(row.errorTimeRatio)},
               {"errorRaysRatio", toJson(row.errorRaysRatio)},
               {"cpuSecondsRatio", row.cpuSecondsRatio},
               {"raysRatio", row.raysRatio},
               {"needed", toJson(row.needed)}};
  if (row.isMean()) return json;
  json.update({{"trimmedRelMse", row.error.trimmedRelMse},
               {"relMse", row.error.relMse},
               {"smape", row.error.smape},
               {"mse", row.error.mse},
               {"mean", toJson(row.mean)},
               {"flip", row.error.flip},
               {"ssim", row.error.ssim},
               {"nonFinitePixels", row.error.nonFinitePixels},
               {"seconds", row.seconds},
               {"cpuSeconds", row.cpuSeconds},
               {"rays", row.rays},
               {"image", row.image}});
  return json;
}

static Json toJson(const SceneRecord& scene) {
  Json json = {{"name", scene.name},
               {"file", scene.file},
               {"hash", hexText(scene.hash)},
               {"width", scene.width},
               {"height", scene.height},
               {"maxDepth", scene.maxDepth},
               {"rrDepth", scene.rrDepth},
               {"reference", scene.reference},
               {"referenceSettings", scene.referenceSettings},
               {"referenceError", nullptr}};
  if (scene.referenceError)
    json["referenceError"] = {{"relMse", scene.referenceError->relMse},
                              {"trimmedRelMse", scene.referenceError->trimmedRelMse}};
  return json;
}

Json comparisonJson(const Comparison& comparison, const std::vector<ComparisonRow>& rows,
                    const std::vector<Method>& methods, const Provenance& provenance) {
  Json json;
  json["version"] = ODIS_VERSION_STRING;
  json["command"] = provenance.command;
  json["machine"] = provenance.machine;
  json["denoiser"] = nullptr;
  if (provenance.denoiser) json["denoiser"] = *provenance.denoiser;
  json["error"] = "ratios: relMSE without the worst 0.1 % of the pixels, median over seeds";
  json["untrimmed"] = "ratios: relMSE of all pixels, mean over seeds";
  json["mean"] = "luminance of the image over the reference's, mean over seeds";
  json["intervals"] = fmt::format(
      "[value, low, high]: {:.0f} %, bootstrap over seeds, {} resamples; of `mean` "
      "by Student's t",
      100 * kConfidence, kResamples);
  for (const char* list : {"methods", "scenes", "rows", "runs"}) json[list] = Json::array();
  for (const Method& method : methods)
    json["methods"].push_back({{"name", method.name}, {"options", method.text}});
  for (const SceneRecord& scene : comparison.scenes) json["scenes"].push_back(toJson(scene));
  for (const ComparisonRow& row : rows) json["rows"].push_back(toJson(row));
  for (const Measurement& m : comparison.measurements) {
    Json run = measurementJson(m);
    run.erase("key");
    json["runs"].push_back(std::move(run));
  }
  return json;
}

}  // namespace odis::eval
