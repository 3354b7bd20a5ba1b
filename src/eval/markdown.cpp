#include "eval/markdown.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace odis::eval {

std::string neededText(const SamplesNeeded& needed) {
  switch (needed.where) {
    case SamplesNeeded::unknown:
      return "";
    case SamplesNeeded::below:
      return fmt::format("under {:.3g}", needed.samples);
    case SamplesNeeded::within:
      return fmt::format("{:.3g}", needed.samples);
    case SamplesNeeded::beyond:
      return fmt::format("beyond {:.3g}", needed.samples);
  }
  return "";
}

namespace {

constexpr size_t kWideColumns = 14;
using Cells = std::vector<std::vector<std::string>>;

std::vector<size_t> widthsOf(const Cells& cells) {
  std::vector<size_t> widths(cells.front().size(), 3);
  for (const auto& row : cells)
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  return widths;
}

// Cuts the names of the first column where a table would become wider than kNarrow.
Cells narrowed(Cells cells) {
  constexpr size_t kNarrow = 100, kLeast = 8;
  const std::vector<size_t> widths = widthsOf(cells);
  size_t others = 1;
  for (size_t i = 1; i < widths.size(); ++i) others += widths[i] + 3;
  const size_t most = std::max(kLeast, kNarrow - std::min(kNarrow, others + 3));
  for (auto& row : cells)
    if (row.front().size() > most) row.front() = row.front().substr(0, most - 2) + "..";
  return cells;
}

// Rows of cells, the first of them the header; columns from `numbers` on are aligned to the right.
std::string layOut(const Cells& cells, size_t numbers) {
  const std::vector<size_t> widths = widthsOf(cells);
  std::string text;
  for (size_t r = 0; r < cells.size(); ++r) {
    for (size_t i = 0; i < widths.size(); ++i)
      text += i < numbers ? fmt::format("| {:<{}} ", cells[r][i], widths[i])
                          : fmt::format("| {:>{}} ", cells[r][i], widths[i]);
    text += "|\n";
    if (r > 0) continue;
    for (size_t i = 0; i < widths.size(); ++i)
      text +=
          i < numbers ? fmt::format("|:{:-<{}}-", "", widths[i]) : fmt::format("|-{:-<{}}:", "", widths[i]);
    text += "|\n";
  }
  return text;
}

// "0.812 [0.790, 0.851]"; without an interval where there is no doubt: a method over itself, or one seed.
std::string intervalText(const Interval& interval) {
  const std::string value = fmt::format("{:.3f}", interval.value);
  if (!(interval.high > interval.low)) return value;
  return fmt::format("{} [{:.3f}, {:.3f}]", value, interval.low, interval.high);
}

// The same in less room.
std::string shortIntervalText(const Interval& interval) {
  const auto text = [](double value) {
    return fmt::format(fmt::runtime(value >= 100 ? "{:.3g}" : value >= 0.1 ? "{:.2f}" : "{:.2g}"), value);
  };
  if (!(interval.high > interval.low)) return text(interval.value);
  return fmt::format("{} [{}, {}]", text(interval.value), text(interval.low), text(interval.high));
}

std::vector<std::string> narrowCells(const ComparisonRow& row) {
  std::vector<std::string> cells{"  " + row.method, std::to_string(row.spp), "", "", "", ""};
  if (row.equalTime) {
    cells[0] += fmt::format(", time of {}", row.spp);
    cells[1] = fmt::format("{:.3g}", row.samples);
  }
  if (!row.sameAs.empty()) {
    cells[2] = "= " + row.sameAs;
    return cells;
  }
  if (!row.isMean()) {
    cells[2] = fmt::format("{:.3g}", row.error.trimmedRelMse);
    cells[3] = fmt::format("{:.2f}", row.cpuSeconds);
  }
  cells[4] = shortIntervalText(row.errorRatio);
  cells[5] = shortIntervalText(row.errorTimeRatio);
  return cells;
}

std::vector<std::string> rowCells(const ComparisonRow& row) {
  // What was asked for, or what fitted in the time of that.
  const std::string samples =
      row.equalTime ? fmt::format("{:.3g} in time of {}", row.samples, row.spp) : fmt::format("{}", row.spp);
  std::vector<std::string> cells{row.scene, row.method, samples};
  if (!row.sameAs.empty()) {
    cells.push_back("= " + row.sameAs);
    cells.resize(kWideColumns);
    return cells;
  }
  if (row.isMean())
    cells.insert(cells.end(), {"", "", "", "", "", ""});
  else
    cells.insert(cells.end(),
                 {fmt::format("{:.3g}", row.error.trimmedRelMse), fmt::format("{:.3f}", row.error.flip),
                  fmt::format("{:.3f}", row.error.ssim), intervalText(row.mean),
                  fmt::format("{:.2f}", row.cpuSeconds), fmt::format("{:.1f}", row.rays * 1e-6)});
  cells.insert(cells.end(),
               {intervalText(row.errorRatio), intervalText(row.untrimmedRatio),
                intervalText(row.errorTimeRatio), intervalText(row.errorRaysRatio), neededText(row.needed)});
  return cells;
}

// What of the smallest error of a scene is its reference's own, of images as rendered or denoised.
std::string shareText(const SceneRecord& scene, const std::vector<ComparisonRow>& rows, bool denoised) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const ComparisonRow& row : rows)
    if (row.scene == scene.name && row.denoised == denoised)
      smallest = std::min(smallest, row.error.trimmedRelMse);
  if (!scene.referenceError || !(smallest > 0) || std::isinf(smallest)) return "";
  return fmt::format("{:.1f} %", 100 * scene.referenceError->trimmedRelMse / smallest);
}

bool anyDenoised(const std::vector<ComparisonRow>& rows) {
  return std::any_of(rows.begin(), rows.end(), [](const ComparisonRow& row) { return row.denoised; });
}

Cells referencesCells(const std::vector<ComparisonRow>& rows, const std::vector<SceneRecord>& scenes) {
  const bool denoised = anyDenoised(rows);
  Cells cells{{"reference of", "its own error", "of the smallest error"}};
  if (denoised) cells.front().push_back("of the smallest, denoised");
  for (const SceneRecord& scene : scenes) {
    const std::string own =
        scene.referenceError ? fmt::format("{:.2g}", scene.referenceError->trimmedRelMse) : "not known";
    cells.push_back({scene.name, own, shareText(scene, rows, false)});
    if (denoised) cells.back().push_back(shareText(scene, rows, true));
  }
  return cells;
}

// One table, of the images as they were rendered or of the denoised ones.
std::string rowsTable(const std::vector<ComparisonRow>& rows, bool denoised) {
  const std::string needed = rows.empty() ? "first method needs" : rows.front().method + " needs";
  std::vector<std::vector<std::string>> cells{{"scene", "method", "spp", "error", "FLIP", "SSIM", "mean",
                                               "CPU s", "Mrays", "error ratio", "untrimmed", "error x time",
                                               "error x rays", needed}};
  for (const ComparisonRow& row : rows)
    if (row.denoised == denoised) cells.push_back(rowCells(row));
  return layOut(cells, 2);
}

// The same with the columns that matter most, below the name of each scene.
std::string narrowTable(const std::vector<ComparisonRow>& rows, bool denoised) {
  Cells cells{{"scene, method", "spp", "error", "CPU s", "error ratio", "error x time"}};
  const std::string* scene = nullptr;
  for (const ComparisonRow& row : rows) {
    if (row.denoised != denoised) continue;
    if (!scene || *scene != row.scene) cells.push_back({row.scene, "", "", "", "", ""});
    scene = &row.scene;
    cells.push_back(narrowCells(row));
  }
  return layOut(narrowed(std::move(cells)), 1);
}

}  // namespace

std::string markdownTables(const std::vector<ComparisonRow>& rows, const std::vector<SceneRecord>& scenes) {
  std::string text = rowsTable(rows, false) + "\n";
  if (anyDenoised(rows)) text += "The same images denoised:\n\n" + rowsTable(rows, true) + "\n";
  return text + layOut(referencesCells(rows, scenes), 1);
}

std::string narrowTables(const std::vector<ComparisonRow>& rows, const std::vector<SceneRecord>& scenes) {
  std::string text = narrowTable(rows, false) + "\n";
  if (anyDenoised(rows)) text += "The same images denoised:\n\n" + narrowTable(rows, true) + "\n";
  return text + layOut(narrowed(referencesCells(rows, scenes)), 1);
}

}  // namespace odis::eval
