// odis train
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <chrono>
#include <memory>

#include "command.h"
#include "console.h"
#include "learn/train/train.h"
#include "render/files/input_file.h"

namespace odis::app {

namespace {

struct TrainArguments {
  std::string config, output;
  bool quiet = false;
};

// A line now and then; where lines stay, at most one every ten seconds, but for the first and the last step.
class TrainConsole : public learn::TrainObserver {
 public:
  explicit TrainConsole(bool quiet)
      : m_quiet(quiet), m_terminal(onTerminal()), m_pace(std::chrono::seconds(m_terminal ? 5 : 10)) {}
  void waiting(size_t shards, int expected) override {
    const bool first = m_shards == ~size_t(0);
    if (shards == m_shards || !(first || m_terminal || m_pace.isDue())) return;
    m_shards = shards;
    print(fmt::format("waiting for shards: {} of {}\n", shards, expected));
  }
  void loaded(size_t shards, size_t examples) override {
    if (m_terminal || m_pace.isDue()) print(fmt::format("{} shards, {} examples\n", shards, examples));
  }
  void step(int of, const learn::History& history) override {
    const int step = history.losses.back().step;
    const Clock::time_point now = Clock::now();
    if (m_first == 0) {
      m_first = step;
      m_start = now;
    }
    m_last = step == of;
    if (!m_last && !m_pace.isDue()) return;
    const double seconds = std::chrono::duration<double>(now - m_start).count();
    const std::string left = step > m_first && step < of
                                 ? ", " + durationText(seconds * (of - step) / (step - m_first)) + " left"
                                 : "";
    print(fmt::format("step {} of {}: {}{}\n", step, of,
                      named(history.lossNames, history.losses.back().losses), left));
  }
  void validated(const learn::History& history) override {
    if (!m_terminal && !m_last && !m_pace.isDue()) return;
    const learn::ValidationRow& row = history.validations.back();
    print(
        fmt::format("step {}, held-out scenes: {}\n", row.step, named(history.validationNames, row.values)));
  }
  bool cancelled() const override { return InterruptScope::interrupted(); }

 private:
  using Clock = std::chrono::steady_clock;
  static std::string named(const std::vector<std::string>& names, const std::vector<double>& values) {
    std::string text;
    for (size_t i = 0; i < values.size(); ++i)
      text += fmt::format("{}{} {:.4f}", i > 0 ? ", " : "", names[i], values[i]);
    return text;
  }
  void print(const std::string& line) const {
    if (!m_quiet) say(line);
  }
  bool m_quiet, m_terminal;
  LinePace m_pace;
  bool m_last = false;  // whether the last step is done
  size_t m_shards = ~size_t(0);
  int m_first = 0;
  Clock::time_point m_start;
};

int runTrain(const TrainArguments& a) {
  try {
    render::InputFile(a.config);
  } catch (const render::ReadError& error) {
    say(fmt::format("error: {}: cannot be read: {}\n", a.config, error.what()));
    return kSceneError;
  }
  const learn::TrainConfig config = learn::readConfig(a.config);
  const learn::Processes processes = learn::processesOfEnvironment();
  InterruptScope interrupt;
  TrainConsole observer(a.quiet || processes.rank > 0);
  if (!learn::train(config, a.output, processes, observer)) return InterruptScope::exitCode();
  if (!a.quiet && processes.rank == 0) say(fmt::format("{}/odis.weights\n", a.output));
  return kOk;
}

}  // namespace

Command addTrainCommand(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("train", "Train the networks on a data set: docs/network.md");
  const auto a = std::make_shared<TrainArguments>();
  app->add_option("CONFIG", a->config, "What to do: a JSON file")->required();
  app->add_option(
         "-o,--output", a->output,
         "Folder for weights, curves and checkpoints; where it has a checkpoint, training goes on from there")
      ->required();
  app->add_flag("-q,--quiet", a->quiet, "Print errors only");
  app->footer(
      "Several processes share the work where RANK, WORLD_SIZE, MASTER_ADDR and MASTER_PORT are set, as "
      "torchrun does.");
  return {app, [=] { return runTrain(*a); }};
}

}  // namespace odis::app
