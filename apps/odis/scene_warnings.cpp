#include "scene_warnings.h"

#include <fmt/format.h>

#include "console.h"

namespace odis::app {

using render::Effect;

void tellWarnings(const std::string& scene, const render::Warnings& warnings, const WarningLevel& level) {
  const auto list = [&](Effect effect, const char* kind) {
    for (const render::Warnings::Group& group : warnings.groups(effect))
      say(fmt::format("{}: {}\n", kind, group.text()));
  };
  if (level.verbose && !level.quiet) list(Effect::none, "note");
  if (!level.quiet) list(Effect::same, "note");
  list(Effect::difference, level.strict ? "error" : "warning");
  const size_t count = warnings.count(Effect::difference);
  if (count == 0) return;
  const std::string sum =
      fmt::format("{} difference{} the picture", count, count == 1 ? " changes" : "s change");
  if (level.strict) throw render::SceneError({scene}, sum);
  say(fmt::format("{}: {}\n", scene, sum));
}

}  // namespace odis::app
