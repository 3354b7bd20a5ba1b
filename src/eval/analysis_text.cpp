#include "eval/analysis_text.h"

#include <fmt/format.h>

namespace odis::eval {

namespace {

// In per cent.
std::string shareText(const Estimated& share) {
  return fmt::format("{:.1f} ± {:.1f}", 100 * share.value, 100 * share.error);
}

std::string numberText(const Estimated& e) {
  return fmt::format("{:.3g} ± {:.2g}", e.value, e.error);
}

// The end of a table's head and the line below it.
std::string rule(size_t columns) {
  std::string text("\n|");
  for (size_t i = 0; i < columns; ++i) text += "---|";
  text += '\n';
  return text;
}

}  // namespace

std::string analysisTable(const SceneAnalysis& scene, const std::vector<Method>& methods) {
  std::string text = fmt::format("| {}, {} x {}: % of the variance |", scene.name, scene.width, scene.height);
  for (const Method& method : methods) text += fmt::format(" {} |", method.name);
  text += rule(methods.size() + 1);
  const auto addRow = [&](const std::string& name, const auto& cell) {
    text += fmt::format("| {} |", name);
    for (const VarianceSplit& split : scene.splits) text += fmt::format(" {} |", cell(split));
    text += "\n";
  };
  for (size_t i = 0; i < causes().size(); ++i)
    addRow(causes()[i].name, [i](const VarianceSplit& split) { return shareText(split.shares[i]); });
  addRow("variance of a sample (relMSE)",
         [](const VarianceSplit& split) { return numberText(split.variance); });
  const VarianceSplit& first = scene.splits.front();
  addRow("its ratio", [&](const VarianceSplit& split) {
    return &split == &first ? std::string("1") : numberText(ratio(split.variance, first.variance));
  });
  addRow("rays of a sample",
         [](const VarianceSplit& split) { return fmt::format("{:.2f}", split.raysPerSample); });
  return text;
}

std::string analysisSummary(const std::vector<SceneAnalysis>& scenes, const std::vector<Method>& methods) {
  std::string text;
  const size_t columns = causes().size();
  for (size_t m = 0; m < methods.size(); ++m) {
    text += fmt::format("| {}: % of the variance |", methods[m].name);
    for (const Cause& cause : causes()) text += fmt::format(" {} |", cause.column);
    text += " relMSE | ratio | rays |" + rule(columns + 4);
    std::vector<double> sums(columns);
    for (const SceneAnalysis& scene : scenes) {
      const VarianceSplit& split = scene.splits[m];
      text += fmt::format("| {} |", scene.name);
      for (size_t i = 0; i < columns; ++i) {
        text += fmt::format(" {:.0f} |", 100 * split.shares[i].value);
        sums[i] += split.shares[i].value / double(scenes.size());
      }
      text += fmt::format(" {:.3g} | {:.2f} | {:.2f} |\n", split.variance.value,
                          ratio(split.variance, scene.splits.front().variance).value, split.raysPerSample);
    }
    text += "| mean |";
    for (const double mean : sums) text += fmt::format(" {:.0f} |", 100 * mean);
    text += " | | |\n\n";
  }
  return text;
}

nlohmann::ordered_json analysisJson(const std::vector<SceneAnalysis>& scenes,
                                    const AnalyzeSettings& settings) {
  nlohmann::ordered_json json{{"samples", settings.samples},
                              {"imageSpp", settings.imageSpp},
                              {"referenceSpp", settings.referenceSpp},
                              {"seed", settings.seed},
                              {"scenes", nlohmann::ordered_json::array()}};
  for (const SceneAnalysis& scene : scenes) {
    nlohmann::ordered_json entry{{"scene", scene.name}, {"width", scene.width}, {"height", scene.height}};
    for (size_t m = 0; m < scene.splits.size(); ++m) {
      const VarianceSplit& split = scene.splits[m];
      nlohmann::ordered_json shares = nlohmann::ordered_json::array();
      for (size_t i = 0; i < causes().size(); ++i)
        shares.push_back({{"cause", causes()[i].name},
                          {"share", split.shares[i].value},
                          {"standardError", split.shares[i].error}});
      entry["methods"].push_back({{"name", settings.methods[m].name},
                                  {"options", settings.methods[m].text},
                                  {"variance", split.variance.value},
                                  {"varianceStandardError", split.variance.error},
                                  {"raysPerSample", split.raysPerSample},
                                  {"shares", shares}});
    }
    json["scenes"].push_back(entry);
  }
  return json;
}

}  // namespace odis::eval
