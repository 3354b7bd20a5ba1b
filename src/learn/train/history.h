// How a training went: its losses, as tables, a picture and TensorBoard's events.
#pragma once

#include <string>
#include <vector>

#include "learn/scenes/canvas.h"

namespace odis::learn {

// The mean over the steps since the row before.
struct LossRow {
  int step = 0;
  double loss = 0, lights = 0;  // of maps, of choices among lights
  double learningRate = 0;
  double seconds = 0;  // since the training began, pauses left out
};

// Held-out scenes: predictedVariance() of the network, and of the formula beside it.
struct ValidationRow {
  int step = 0;
  double variance = 1, formula = 1;
};

struct History {
  std::vector<LossRow> losses;
  std::vector<ValidationRow> validations;
};

// Writes losses.csv, validation.csv, curves.png and events.out.tfevents.odis to the folder. Throws
// WriteError.
void writeHistory(const std::string& folder, const History& history);

// The curves: losses above, predicted variance below.
Canvas drawHistory(const History& history);
// An event file as TensorBoard reads it: records with masked CRC-32C, each a protocol buffer `Event`.
std::string tensorboardEvents(const History& history);

}  // namespace odis::learn
