// odis montage
#include <CLI/CLI.hpp>
#include <memory>
#include <vector>

#include "command.h"
#include "eval/montage.h"
#include "output.h"
#include "validators.h"

namespace odis::app {

Command addMontageCommand(CLI::App& parent) {
  struct Arguments {
    std::vector<std::string> images;
    std::string output;
    float exposure = 0;
  };
  CLI::App* app = parent.add_subcommand("montage", "Put EXR images side by side in a PNG");
  const auto arguments = std::make_shared<Arguments>();
  app->add_option("IMAGES", arguments->images, "EXR files, left to right")->required();
  app->add_option("-o,--output", arguments->output, "PNG to write")->required();
  app->add_option("--exposure", arguments->exposure, "In stops")
      ->check(within(kStops))
      ->capture_default_str();
  return {app, [arguments] {
            Outputs outputs;
            outputs.add(arguments->output, {".png"});
            outputs.rejectInputs(arguments->images);
            std::vector<eval::ColorImage> images;
            for (const std::string& path : arguments->images) images.push_back(eval::readColor(path));
            eval::ColorImage all = eval::montage(images);
            render::RenderedImage frame;
            frame.width = all.width;
            frame.height = all.height;
            frame.color = std::move(all.pixels);
            writePreview(arguments->output, frame, arguments->exposure);
            return int(kOk);
          }};
}

}  // namespace odis::app
