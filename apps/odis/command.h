// What the sub-commands share: how they are made, and how they end.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "render/files/replace_file.h"

namespace CLI {
class App;
}

namespace odis::app {

enum ExitCode {
  kOk = 0,
  kInternalError = 1,
  kUsageError = 2,
  kSceneError = 3,  // a scene or an image that cannot be read
  kWriteError = 4,
  kLibraryError = 5,   // a library is missing, or the denoiser failed; what was rendered is written
  kTimeLimit = 6,      // came before the samples that were asked for; what was rendered is written
  kInterrupted = 130,  // by Ctrl-C; what was there is written
  kTerminated = 143    // the same by SIGTERM
};

// A command line that makes no sense.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// An output that cannot be written.
using render::WriteError;

struct Command {
  CLI::App* app;
  std::function<int()> run;  // called if `app` was on the command line; returns an ExitCode
};

// Each adds its options to `parent`.
Command addRenderCommand(CLI::App& parent, const std::string& commandLine);
Command addSceneCommand(CLI::App& parent);
Command addScenesCommand(CLI::App& parent);
Command addDatasetCommand(CLI::App& parent);
Command addDenoiseCommand(CLI::App& parent);
Command addMetricsCommand(CLI::App& parent);
Command addImageCommand(CLI::App& parent);
Command addMontageCommand(CLI::App& parent);
Command addCompareCommand(CLI::App& parent, const std::string& commandLine);
Command addAgreementCommand(CLI::App& parent);
Command addBenchCommand(CLI::App& parent);
Command addAnalyzeCommand(CLI::App& parent);
Command addInspectCommand(CLI::App& parent);
Command addTrainCommand(CLI::App& parent);

// All of them, in the order in which help shows them.
std::vector<Command> addCommands(CLI::App& parent, const std::string& commandLine);

// Runs the whole command line; errors go to stderr. Returns an ExitCode.
int runCommandLine(int argc, char** argv);

// The arguments as one line that a shell reads as they are.
std::string shellLine(const std::vector<std::string>& arguments);
// "3 min 20 s", "4.2 s", "1.5 GiB".
std::string durationText(double seconds);
std::string bytesText(double bytes);

}  // namespace odis::app
