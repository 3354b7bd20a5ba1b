#include "render_outcome.h"

#include <fmt/format.h>

#include <filesystem>

#include "command.h"
#include "console.h"

namespace odis::app {

using render::RenderStats;

static const char* stopReason() {
  return InterruptScope::interrupted() ? "interrupted" : "stopped by --time-limit";
}

bool isWorthWriting(const RenderArguments& a, const RenderStats& stats) {
  if (stats.samples == 0) {
    say(fmt::format("{} before there was an image: nothing is written\n", stopReason()));
    return false;
  }
  // Some pixels have no sample yet: better an old image than black ones.
  if (stats.fewestSamples > 0 || !std::filesystem::is_regular_file(a.output)) return true;
  say(
      fmt::format("{} at {:.2f} samples per pixel, some pixels have none: {} stays as it was, nothing is "
                  "written\n",
                  stopReason(), stats.spp, a.output));
  return false;
}

std::string samplesText(const RenderStats& stats, int asked) {
  if (!stats.interrupted)
    return fmt::format("{:.4g} sample{} per pixel", stats.spp, stats.spp == 1 ? "" : "s");
  return fmt::format("{} at {:.4g} of {} samples per pixel", stopReason(), stats.spp, asked);
}

int renderExitCode(const RenderArguments& a, const RenderStats& stats) {
  if (const int code = InterruptScope::exitCode(); code != kOk) return code;
  // Without --spp the time is what was asked for; a rendering that is saved is meant to go on.
  const bool timeIsAskedFor = !a.spp && a.saveMinutes == 0;
  return stats.interrupted && !(timeIsAskedFor && stats.fewestSamples > 0) ? kTimeLimit : kOk;
}

}  // namespace odis::app
