// A split of variance for people, as Markdown that can also be read as it is, and for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "eval/analyze.h"

namespace odis::eval {

// One scene: a row a cause, a column a method.
std::string analysisTable(const SceneAnalysis& scene, const std::vector<Method>& methods);
// One table a method: a row a scene, a column a cause, and the mean over scenes.
std::string analysisSummary(const std::vector<SceneAnalysis>& scenes, const std::vector<Method>& methods);
nlohmann::ordered_json analysisJson(const std::vector<SceneAnalysis>& scenes,
                                    const AnalyzeSettings& settings);

}  // namespace odis::eval
