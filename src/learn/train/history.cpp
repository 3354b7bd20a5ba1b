#include "learn/train/history.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

#include "render/files/replace_file.h"
#include "render/image/write.h"

namespace odis::learn {

using render::Rgb;

namespace {

constexpr int kWidth = 640, kPanel = 220, kMargin = 44;
const Rgb kPaper{1, 1, 1}, kLetters{0.02f, 0.02f, 0.02f}, kGrid{0.8f, 0.8f, 0.8f};

using Points = std::vector<std::pair<double, double>>;

// A panel with its top at y: axes, the range of the values, and a line for each series.
void drawPanel(Canvas& canvas, int y, const std::string& title,
               const std::vector<std::pair<Points, Rgb>>& series) {
  double low = INFINITY, high = -INFINITY, last = 1;
  for (const auto& [points, color] : series)
    for (const auto& [step, value] : points) {
      low = std::min(low, value);
      high = std::max(high, value);
      last = std::max(last, step);
    }
  canvas.write(kMargin, y + 6, kWidth - kMargin, title, kLetters);
  if (!(low <= high)) return;
  if (high - low < 1e-9) high = low + 1e-9;
  const int top = y + 22, bottom = y + kPanel - 22, right = kWidth - 12;
  const auto across = [&](double step) { return kMargin + int(step / last * (right - kMargin)); };
  // Losses of trainings that failed may be infinite or no numbers.
  const auto down = [&](double value) {
    return bottom - int(render::limited((value - low) / (high - low), 0.0, 1.0) * (bottom - top));
  };
  for (int i = 0; i <= 4; ++i) {
    const double value = low + (high - low) * i / 4;
    canvas.fill(kMargin, down(value), right - kMargin, 1, kGrid);
    canvas.write(2, down(value) - 3, kMargin - 2, fmt::format("{:.4g}", value), kLetters);
  }
  canvas.write(kMargin, bottom + 8, 60, "step 0", kLetters);
  canvas.write(right - 60, bottom + 8, 60, fmt::format("{:.0f}", last), kLetters);
  for (const auto& [points, color] : series)
    for (size_t i = 0; i < points.size(); ++i) {
      const auto [step, value] = points[i];
      const auto [before, from] = points[i > 0 ? i - 1 : 0];
      // A column at a time, as high as the line is steep.
      for (int x = across(before); x <= across(step); ++x) {
        const double share = across(step) > across(before)
                                 ? double(x - across(before)) / (across(step) - across(before))
                                 : 1.0;
        canvas.fill(x, down(from + share * (value - from)) - 1, 2, 2, color);
      }
    }
}

// CRC-32C (polynomial 0x82f63b78, reflected), rotated and offset as the format asks for.
uint32_t maskedCrc(std::string_view bytes) {
  uint32_t crc = ~0u;
  for (const char c : bytes) {
    crc ^= uint8_t(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (0x82f63b78u & (0u - (crc & 1u)));
  }
  crc = ~crc;
  return ((crc >> 15) | (crc << 17)) + 0xa282ead8u;
}

template <class T>
void put(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

void putVarint(std::string& bytes, uint64_t value) {
  for (; value >= 128; value >>= 7) bytes.push_back(char(value | 128));
  bytes.push_back(char(value));
}

void putText(std::string& bytes, char key, const std::string& text) {
  bytes.push_back(key);
  putVarint(bytes, text.size());
  bytes += text;
}

void putRecord(std::string& file, const std::string& event) {
  std::string length;
  put(length, uint64_t(event.size()));
  file += length;
  put(file, maskedCrc(length));
  file += event;
  put(file, maskedCrc(event));
}

// Keys of a protocol buffer: number of the field times 8, and 0 for integers, 1 and 5 for 64 and 32 bits, 2
// for texts.
constexpr char kWallTime = 1 * 8 + 1, kStep = 2 * 8, kFileVersion = 3 * 8 + 2, kSummary = 5 * 8 + 2,
               kValue = 1 * 8 + 2, kTag = 1 * 8 + 2, kSimpleValue = 2 * 8 + 5;

void putScalar(std::string& file, double seconds, int step, const std::string& tag, double value) {
  std::string inner, summary, event;
  putText(inner, kTag, tag);
  inner.push_back(kSimpleValue);
  put(inner, float(value));
  putText(summary, kValue, inner);
  event.push_back(kWallTime);
  put(event, seconds);
  event.push_back(kStep);
  putVarint(event, uint64_t(step));
  putText(event, kSummary, summary);
  putRecord(file, event);
}

}  // namespace

Canvas drawHistory(const History& history) {
  static const Rgb kLines[] = {
      {0.05f, 0.2f, 0.6f}, {0.7f, 0.3f, 0.02f}, {0.1f, 0.45f, 0.1f}, {0.4f, 0.1f, 0.5f}};
  const size_t panels = history.lossNames.size() + 1;
  Canvas canvas(kWidth, int(panels) * kPanel, kPaper);
  for (size_t i = 0; i < history.lossNames.size(); ++i) {
    Points losses;
    for (const LossRow& row : history.losses) losses.emplace_back(row.step, row.losses[i]);
    drawPanel(canvas, int(i) * kPanel, history.lossNames[i], {{losses, kLines[0]}});
  }
  std::vector<std::pair<Points, Rgb>> series;
  std::string title = "held-out scenes: ";
  static constexpr const char* kColors[] = {" (blue)", " (orange)", " (green)", " (purple)"};
  for (size_t i = 0; i < std::min(history.validationNames.size(), std::size(kLines)); ++i) {
    Points values;
    for (const ValidationRow& row : history.validations) values.emplace_back(row.step, row.values[i]);
    series.emplace_back(values, kLines[i]);
    title += (i > 0 ? ", " : "") + history.validationNames[i] + kColors[i];
  }
  drawPanel(canvas, int(history.lossNames.size()) * kPanel, title, series);
  return canvas;
}

std::string tensorboardEvents(const History& history) {
  std::string file, first;
  first.push_back(kWallTime);
  put(first, 0.0);
  putText(first, kFileVersion, "brain.Event:2");
  putRecord(file, first);
  for (const LossRow& row : history.losses) {
    for (size_t i = 0; i < row.losses.size(); ++i)
      putScalar(file, row.seconds, row.step, history.lossNames[i], row.losses[i]);
    putScalar(file, row.seconds, row.step, "learning rate", row.learningRate);
  }
  for (const ValidationRow& row : history.validations)
    for (size_t i = 0; i < row.values.size(); ++i)
      putScalar(file, 0, row.step, "validation/" + history.validationNames[i], row.values[i]);
  return file;
}

void writeHistory(const std::string& folder, const History& history) {
  std::string losses = "step", validations = "step";
  for (const std::string& name : history.lossNames) losses += "," + name;
  losses += ",learning rate,seconds\n";
  for (const std::string& name : history.validationNames) validations += "," + name;
  validations += "\n";
  for (const LossRow& row : history.losses)
    losses +=
        fmt::format("{},{},{},{:.1f}\n", row.step, fmt::join(row.losses, ","), row.learningRate, row.seconds);
  for (const ValidationRow& row : history.validations)
    validations += fmt::format("{},{}\n", row.step, fmt::join(row.values, ","));
  render::writeFile(folder + "/losses.csv", losses);
  render::writeFile(folder + "/validation.csv", validations);
  render::writeFile(folder + "/events.out.tfevents.odis", tensorboardEvents(history));
  const Canvas canvas = drawHistory(history);
  render::writePng(folder + "/curves.png", canvas.width, canvas.height, canvas.pixels.data(), 0);
}

}  // namespace odis::learn
