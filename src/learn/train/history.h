// How a training went: its losses, as tables, a picture and TensorBoard's events.
#pragma once

#include <string>
#include <vector>

#include "learn/scenes/canvas.h"

namespace odis::learn {

// The mean over the steps since the row before.
struct LossRow {
  int step = 0;
  std::vector<double> losses;  // as History::lossNames
  double learningRate = 0;
  double seconds = 0;  // since the training began, pauses left out
};

// What held-out scenes say.
struct ValidationRow {
  int step = 0;
  std::vector<double> values;  // as History::validationNames
};

struct History {
  std::vector<std::string> lossNames, validationNames;
  std::vector<LossRow> losses;
  std::vector<ValidationRow> validations;
};

// Writes losses.csv, validation.csv, curves.png and events.out.tfevents.odis to the folder. Throws
// WriteError.
void writeHistory(const std::string& folder, const History& history);

// The curves: a panel for each loss, and one for what held-out scenes say.
Canvas drawHistory(const History& history);
// An event file as TensorBoard reads it: records with masked CRC-32C, each a protocol buffer `Event`.
std::string tensorboardEvents(const History& history);

}  // namespace odis::learn
