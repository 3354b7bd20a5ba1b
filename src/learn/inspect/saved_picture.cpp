#include <fmt/format.h>

#include <algorithm>

#include "learn/inspect/saved_output.h"
#include "learn/inspect/words.h"

namespace odis::learn {

namespace {

constexpr int kSpace = 8, kLine = 11;
constexpr int kLargeMap = 32 * kMapSize, kSmallMap = 6 * kMapSize;
constexpr size_t kMostOnASheet = 64;
constexpr int kSheetColumns = 8;

void drawLegend(Canvas& canvas, MapColors colors) {
  if (colors == MapColors::stops)
    drawScale(canvas, {kSpace, canvas.height - kSpace - kLine}, kLargeMap / 2, mapScale());
}

std::vector<uint32_t> shownCells(const GuideView& view) {
  std::vector<uint32_t> finest, shown;
  for (uint32_t cell = 0; cell < view.cellCount; ++cell)
    if (CellGrid::levelOf(view.keys[cell]) == 0) finest.push_back(cell);
  const size_t count = std::min(finest.size(), kMostOnASheet);
  for (size_t i = 0; i < count; ++i) shown.push_back(finest[i * finest.size() / count]);
  return shown;
}

}  // namespace

Canvas drawCell(const CellSummary& cell, const std::string& title, MapColors colors) {
  std::vector<std::string> lines{title, savedCellWords(cell)};
  for (const std::string& words : savedDecisionWords(cell)) lines.push_back(words);
  const int top = 2 * kSpace + int(lines.size()) * kLine;
  Canvas canvas(2 * kSpace + kLargeMap, top + kLargeMap + 2 * kSpace + kLine, kBackground);
  for (size_t i = 0; i < lines.size(); ++i)
    canvas.write(kSpace, kSpace + int(i) * kLine, kLargeMap, lines[i], kInk);
  drawMap(canvas, {kSpace, top}, kLargeMap, cell.map, colors);
  drawLegend(canvas, colors);
  return canvas;
}

Canvas drawGuide(const GuideSummary& guide, const std::string& title, MapColors colors) {
  constexpr int kWide = kSmallMap + kSpace, kHigh = kLine + kSmallMap + kSpace, kTop = 2 * kSpace + kLine;
  const GuideView view = guide.guide.view();
  const std::vector<uint32_t> cells = shownCells(view);
  const int rows = (int(cells.size()) + kSheetColumns - 1) / kSheetColumns;
  Canvas canvas(kSpace + kSheetColumns * kWide, kTop + rows * kHigh + kSpace + kLine, kBackground);
  canvas.write(kSpace, kSpace, canvas.width,
               fmt::format("{}: maps of {} of {} finest cells", title, cells.size(), guide.cells[0]), kInk);
  for (size_t i = 0; i < cells.size(); ++i) {
    const int left = kSpace + int(i) % kSheetColumns * kWide, top = kTop + int(i) / kSheetColumns * kHigh;
    canvas.write(left, top, kSmallMap, fmt::format("cell {}", cells[i]), kInk);
    drawMap(canvas, {left, top + kLine}, kSmallMap, mapSquare(view, cells[i]), colors);
  }
  drawLegend(canvas, colors);
  return canvas;
}

}  // namespace odis::learn
