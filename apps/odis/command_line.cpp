// From the command line to a sub-command, from exceptions to exit codes.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <new>
#include <system_error>
#include <vector>

#include "command.h"
#include "console.h"
#include "eval/image_file.h"
#include "learn/data/shard_file.h"
#include "learn/inspect/saved.h"
#include "learn/scenes/generate.h"
#include "learn/train/learner.h"
#include "odis_version.h"
#include "render/files/library_error.h"
#include "render/xml/error.h"
#include "suggest.h"

namespace odis::app {

static constexpr const char* kExitCodes =
    "Exit codes: 0 all went well, 1 internal error, 2 wrong usage, 3 an input can't be read,\n"
    "4 an output can't be written, 5 a library is missing or the denoiser failed, 6 a time limit came "
    "before\n"
    "the samples asked for, 130 interrupted by Ctrl-C, 143 by SIGTERM (what was rendered is written).";

static int fail(ExitCode code, const std::string& message) {
  say(fmt::format("error: {}\n", message));
  return code;
}

// The library has no code of its own for a network at pixels that can't be computed: any such network fails
// for the same reason then.
static ExitCode codeOf(const Error& error) {
  if (error.code() != ODIS_ERROR_FILE) return kInternalError;
  try {
    GuideBuilder(GuideOptions().set("pixel-maps=network pixel-network=fast"));
  } catch (const Error& again) {
    if (std::string(error.what()) == again.what()) return kLibraryError;
  }
  return kSceneError;
}

// The innermost sub-command that was named.
static const CLI::App& deepest(const CLI::App& app) {
  const std::vector<CLI::App*> parsed = app.get_subcommands();
  return parsed.empty() ? app : deepest(*parsed.front());
}

static int reportUsage(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = deepest(app);
  std::string message = commandMissing(app, command);
  if (message.empty()) message = error.what();
  if (const std::string hint = suggestFor(app, command); !hint.empty()) message += "\n" + hint;
  std::string name = command.get_name();
  for (const CLI::App* parent = command.get_parent(); parent; parent = parent->get_parent())
    name = parent->get_name() + " " + name;
  return fail(kUsageError, message + "\nRun `" + name + " --help` for what there is.");
}

// What was printed may still wait to be written.
static int flushed(int code) {
  std::cout.flush();
  if (std::fflush(stdout) == 0 && std::cout) return code;
  if (errno == EPIPE) return kWriteError;  // as in `odis ... | head`: nobody is left to be told
  return code == kOk ? fail(kWriteError, "what was printed can't be written") : code;
}

std::vector<Command> addCommands(CLI::App& parent, const std::string& commandLine) {
  return {addRenderCommand(parent, commandLine),
          addCompareCommand(parent, commandLine),
          addAnalyzeCommand(parent),
          addTrainCommand(parent),
          addInspectCommand(parent),
          addAgreementCommand(parent),
          addBenchCommand(parent),
          addDenoiseCommand(parent),
          addMetricsCommand(parent),
          addImageCommand(parent),
          addMontageCommand(parent),
          addSceneCommand(parent),
          addScenesCommand(parent),
          addDatasetCommand(parent)};
}

int runCommandLine(int argc, char** argv) {
  // A file that may not grow any more is an error like a full disk, not the end of the program.
  std::signal(SIGXFSZ, SIG_IGN);
  // Whoever read what we print, or what we write into a pipe, may be gone: other outputs are worth finishing.
  std::signal(SIGPIPE, SIG_IGN);
  CLI::App app{"ODIS: offline deep importance sampling for path tracing", "odis"};
  app.footer(kExitCodes);
  app.set_version_flag("--version", std::string("odis ") + ODIS_VERSION_STRING);
  app.require_subcommand(1);
  const std::vector<Command> commands = addCommands(app, shellLine({argv, argv + argc}));
  try {
    app.parse(argc, argv);
    for (const Command& command : commands)
      if (command.app->parsed()) return flushed(command.run());
    return kUsageError;
  } catch (const CLI::Success& success) {  // --help, --version
    return flushed(app.exit(success));
  } catch (const CLI::ParseError& error) {
    return reportUsage(app, error);
  } catch (const UsageError& error) {
    return fail(kUsageError, error.what());
  } catch (const render::OptionError& error) {
    return fail(kUsageError, error.what());
  } catch (const learn::AssetError& error) {
    return fail(kUsageError, error.what());
  } catch (const learn::ConfigError& error) {
    return fail(kUsageError, error.what());
  } catch (const learn::TrainError& error) {
    return fail(kUsageError, error.what());
  } catch (const learn::GenerateError& error) {
    return fail(kUsageError, error.what());
  } catch (const render::MissingFiles& error) {
    for (const render::SceneError& file : error.files()) fail(kSceneError, file.what());
    return kSceneError;
  } catch (const render::SceneError& error) {
    return fail(kSceneError, error.what());
  } catch (const core::FileError& error) {
    return fail(kSceneError, error.what());
  } catch (const learn::ShardError& error) {
    return fail(kSceneError, error.what());
  } catch (const Error& error) {
    return fail(codeOf(error), error.what());
  } catch (const eval::ImageError& error) {
    return fail(kSceneError, error.what());
  } catch (const render::LibraryError& error) {
    return fail(kLibraryError, error.what());
  } catch (const WriteError& error) {
    return fail(kWriteError, error.what());
  } catch (const std::system_error& error) {  // of files and folders, and of printing
    if (error.code() == std::errc::broken_pipe) return kWriteError;
    return fail(kWriteError, error.what());
  } catch (const std::bad_alloc&) {
    return fail(kInternalError, "out of memory");
  } catch (const std::exception& error) {
    return fail(kInternalError, error.what());
  }
}

}  // namespace odis::app
