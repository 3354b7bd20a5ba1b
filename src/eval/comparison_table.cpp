#include "eval/comparison_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "eval/median.h"
#include "odis_version.h"

namespace odis::eval {

static constexpr const char* kAllScenes = "geometric mean";

static ComparisonRow summarizeOne(const std::vector<const Measurement*>& runs) {
  const auto medianOf = [&](auto&& field) {
    std::vector<double> values;
    for (const Measurement* run : runs) values.push_back(field(*run));
    return median(std::move(values));
  };
  ComparisonRow row;
  row.scene = runs.front()->scene;
  row.method = runs.front()->method;
  row.seeds = int(runs.size());
  row.error = medianOf([](const Measurement& m) { return m.error.trimmedRelMse; });
  row.seconds = medianOf([](const Measurement& m) { return m.seconds; });
  row.rays = medianOf([](const Measurement& m) { return double(m.rays); });
  row.spp = medianOf([](const Measurement& m) { return m.spp; });
  row.image = runs.front()->image;
  return row;
}

std::vector<ComparisonRow> summarize(const std::vector<Measurement>& measurements) {
  // Group by scene and method, in order of appearance.
  std::vector<std::vector<const Measurement*>> groups;
  for (const Measurement& m : measurements) {
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& known) {
      return known.front()->scene == m.scene && known.front()->method == m.method;
    });
    if (group == groups.end())
      groups.push_back({&m});
    else
      group->push_back(&m);
  }

  std::vector<ComparisonRow> rows;
  size_t first = 0;  // the row that the present scene's ratios are to
  for (const auto& group : groups) {
    rows.push_back(summarizeOne(group));
    ComparisonRow& row = rows.back();
    if (row.scene != rows[first].scene) first = rows.size() - 1;
    row.errorRatio = row.error / rows[first].error;
    row.raysRatio = row.rays / rows[first].rays;
    row.secondsRatio = row.seconds / rows[first].seconds;
  }
  if (rows.empty() || rows.front().scene == rows.back().scene) return rows;

  std::vector<ComparisonRow> means;
  for (const ComparisonRow& row : rows) {
    auto mean =
        std::find_if(means.begin(), means.end(), [&](const auto& m) { return m.method == row.method; });
    if (mean == means.end()) {
      means.emplace_back();
      mean = means.end() - 1;
      mean->scene = kAllScenes;
      mean->method = row.method;
    }
    // `seeds` counts the scenes here, until the means are taken.
    const double share = 1.0 / ++mean->seeds;
    mean->errorRatio *= std::pow(row.errorRatio / mean->errorRatio, share);
    mean->raysRatio *= std::pow(row.raysRatio / mean->raysRatio, share);
    mean->secondsRatio *= std::pow(row.secondsRatio / mean->secondsRatio, share);
  }
  rows.insert(rows.end(), means.begin(), means.end());
  return rows;
}

std::string markdownTable(const std::vector<ComparisonRow>& rows) {
  const bool images =
      std::any_of(rows.begin(), rows.end(), [](const auto& row) { return !row.image.empty(); });
  size_t sceneWidth = 5, methodWidth = 6;
  for (const ComparisonRow& row : rows) {
    sceneWidth = std::max(sceneWidth, row.scene.size());
    methodWidth = std::max(methodWidth, row.method.size());
  }
  std::string text = fmt::format(
      "| {:{}} | {:{}} |    error | seconds |  Mrays | error ratio | rays ratio | time ratio |{}\n", "scene",
      sceneWidth, "method", methodWidth, images ? " picture |" : "");
  text += fmt::format(
      "|:{:-<{}}-|:{:-<{}}-|---------:|--------:|-------:|------------:|-----------:|-----------:|{}\n", "",
      sceneWidth, "", methodWidth, images ? ":--------|" : "");
  for (const ComparisonRow& row : rows) {
    text += fmt::format("| {:{}} | {:{}} | ", row.scene, sceneWidth, row.method, methodWidth);
    if (row.scene == kAllScenes)
      text += fmt::format("{:8} | {:7} | {:6} | ", "", "", "");
    else
      text += fmt::format("{:8.3g} | {:7.2f} | {:6.1f} | ", row.error, row.seconds, row.rays * 1e-6);
    text += fmt::format("{:11.3f} | {:10.3f} | {:10.3f} |", row.errorRatio, row.raysRatio, row.secondsRatio);
    if (images) text += fmt::format(" {} |", row.image);
    text += '\n';
  }
  return text;
}

std::string jsonText(const std::vector<ComparisonRow>& rows, const std::vector<Measurement>& measurements) {
  nlohmann::json json;
  json["version"] = ODIS_VERSION_STRING;
  json["error"] = "relMSE without the worst 0.1 % of the pixels; median over seeds";
  json["rows"] = nlohmann::json::array();
  for (const ComparisonRow& row : rows) {
    nlohmann::json entry = {{"scene", row.scene},
                            {"method", row.method},
                            {"errorRatio", row.errorRatio},
                            {"raysRatio", row.raysRatio},
                            {"secondsRatio", row.secondsRatio}};
    if (row.scene != kAllScenes)
      entry.update({{"seeds", row.seeds},
                    {"error", row.error},
                    {"seconds", row.seconds},
                    {"rays", row.rays},
                    {"spp", row.spp}});
    json["rows"].push_back(std::move(entry));
  }
  for (const Measurement& m : measurements)
    json["runs"].push_back({{"scene", m.scene},
                            {"method", m.method},
                            {"seed", m.seed},
                            {"relMse", m.error.relMse},
                            {"trimmedRelMse", m.error.trimmedRelMse},
                            {"smape", m.error.smape},
                            {"mse", m.error.mse},
                            {"nonFinitePixels", m.error.nonFinitePixels},
                            {"seconds", m.seconds},
                            {"rays", m.rays}});
  return json.dump(2) + "\n";
}

}  // namespace odis::eval
