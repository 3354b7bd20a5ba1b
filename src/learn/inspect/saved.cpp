#include "learn/inspect/saved.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "learn/inspect/summaries.h"
#include "learn/inspect/vertex_integral.h"
#include "learn/inspect/words.h"
#include "odis/saved_vertices.h"
#include "render/path/features.h"

namespace odis::learn {

Quantiles quantilesOf(std::vector<float> values) {
  std::erase_if(values, [](float value) { return std::isnan(value); });
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double fraction) {
    return values[size_t(std::lround(fraction * double(values.size() - 1)))];
  };
  return {at(0.1), at(0.5), at(0.9)};
}

SquareMap mapSquare(const GuideView& view, uint32_t cell) {
  return squareOf(SamplingMap<float>(view.maps, int32_t(cell)));
}

float mapEntropy(const GuideView& view, uint32_t cell) {
  return render::entropy(SamplingMap<float>(view.maps, int32_t(cell)));
}

GuideSummary summarizeGuide(core::Guide guide) {
  GuideSummary result;
  const GuideView view = guide.view();
  const CellGrid grid(view.grid);
  result.finestEdge = grid.finestEdge();
  std::vector<uint32_t> finest;
  for (uint32_t cell = 0; cell < view.cellCount; ++cell) {
    const int level = CellGrid::levelOf(view.keys[cell]);
    ++result.cells[size_t(level)];
    const float half = 0.5f * grid.edge(view.keys[cell]);
    const Float3 middle = grid.middle(view.keys[cell]), corner{half, half, half};
    extend(result.bounds, middle - corner);
    extend(result.bounds, middle + corner);
    if (level == 0) finest.push_back(cell);
  }
  const auto over = [&](const auto& valueOf) {
    std::vector<float> values;
    for (const uint32_t cell : finest) values.push_back(valueOf(cell));
    return quantilesOf(std::move(values));
  };
  for (int c = 0; c < kRoughnessClasses; ++c)
    result.bsdfFraction[c] = over([&](uint32_t cell) { return view.decisions[cell].bsdfFraction[c]; });
  result.entropy = over([&](uint32_t cell) { return mapEntropy(view, cell); });
  result.survivalFactor = over([&](uint32_t cell) { return view.decisions[cell].survivalFactor; });
  result.learnedLightFraction =
      over([&](uint32_t cell) { return view.decisions[cell].learnedLightFraction; });
  result.guide = std::move(guide);
  return result;
}

bool isSaved(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  std::string begin(core::kArchiveMagic.size(), '\0');
  std::ifstream(path, std::ios::binary).read(begin.data(), std::streamsize(begin.size()));
  return begin == core::kArchiveMagic;
}

SavedInspection inspectSaved(const core::Archive& file) {
  SavedInspection result;
  result.kind = file.kind();
  if (result.kind == "guide") {
    result.guide = summarizeGuide(core::Guide::load(file));
  } else if (result.kind == "builder") {
    result.builder = summarizeBuilder(file);
  } else if (result.kind == "vertices") {
    const std::vector<PathVertex> vertices = core::loadVertices(file, "vertices");
    const ArrayView<const PathVertex> all = vertices;
    result.vertices = summarizeVertices(VertexParts(&all, 1));
  } else {
    file.require(result.kind == "frame",
                 "found a saved \"" + result.kind + "\", expected a guide, a builder, vertices or a frame");
    const core::SavedFrame frame(file);
    result.frame = summarizeFrame(frame, file);
    result.guide = summarizeGuide(frame.guide);
  }
  return result;
}

CellSummary inspectCell(const SavedInspection& saved, const Float3& point,
                        const std::optional<Float3>& normal) {
  if (!saved.guide) throw render::OptionError("--point: looks into a guide, found saved " + saved.kind);
  const GuideView view = saved.guide->guide.view();
  // Cells are split by the axis that normals are nearest to: without a normal, all six are asked.
  std::vector<Float3> normals{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  if (normal) normals = {*normal};
  CellSummary result;
  result.cell = kNoCell;
  result.level = kCellLevels;
  for (const Float3& n : normals) {
    const uint32_t cell = odis::findCell(view, {point, n, 0, 0});
    if (cell == kNoCell || CellGrid::levelOf(view.keys[cell]) >= result.level) continue;
    result.cell = cell;
    result.level = CellGrid::levelOf(view.keys[cell]);
    result.normal = n;
  }
  if (result.cell == kNoCell)
    throw render::OptionError(fmt::format("--point: the guide has no cell at {}{}; its cells reach from {}",
                                          vectorText(point), normal ? " that faces this way" : "",
                                          boundsWords(saved.guide->bounds)));
  const CellGrid grid(view.grid);
  result.edge = grid.edge(view.keys[result.cell]);
  result.middle = grid.middle(view.keys[result.cell]);
  result.decisions = view.decisions[result.cell];
  const LearnedLights lights = learnedLights(view, result.cell);
  for (uint32_t group = 0; lights.cdf && group < view.lightGroups; ++group)
    result.lights.push_back(lights.cdf[group + 1] - lights.cdf[group]);
  result.entropy = mapEntropy(view, result.cell);
  result.map = mapSquare(view, result.cell);
  return result;
}

}  // namespace odis::learn
