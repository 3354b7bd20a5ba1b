// odis scene info
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>

#include "command.h"
#include "render/scene/info.h"
#include "render_arguments.h"
#include "scene_warnings.h"

namespace odis::app {

Command addSceneCommand(CLI::App& parent) {
  struct Arguments {
    std::string scene;
    SceneArguments part;
  };
  CLI::App* app = parent.add_subcommand("scene", "Look into a scene");
  app->require_subcommand(1);
  CLI::App* info = app->add_subcommand("info", "List what a scene holds and what is ignored of it");
  const auto arguments = std::make_shared<Arguments>();
  info->add_option("SCENE", arguments->scene, "Mitsuba 3 scene file")->required();
  arguments->part.addTo(*info);
  return {app, [arguments] {
            render::Warnings warnings;
            const auto scene = render::Scene::load(arguments->scene, arguments->part.loadOptions(), warnings);
            fmt::print("{}", render::describe(*scene, warnings));
            if (arguments->part.strict)
              tellWarnings(arguments->scene, warnings, {.quiet = true, .strict = true});
            return int(kOk);
          }};
}

}  // namespace odis::app
