#include "compare_arguments.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <functional>
#include <set>

#include "command.h"
#include "validators.h"

namespace odis::app {

void CompareArguments::addTo(CLI::App& app) {
  app.add_option("SCENE", settings.scenes, "Mitsuba 3 scene files")->required();
  app.add_option("--methods", methods, "name=options of `odis render`, with commas between methods")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->capture_default_str();
  app.add_option("--spp", spp,
                 "Samples per pixel of each method, 1 to 16777216, with commas between several: 4,8,16")
      ->capture_default_str();
  app.add_flag("--equal-time", settings.equalTime,
               "The other methods also with as many samples as fit in the first one's time");
  app.add_flag("--denoise", denoise, "Measure every image after Open Image Denoise, too: docs/denoising.md");
  app.add_option("--seeds", settings.seeds, "How often each method renders")
      ->check(within(1, 1 << 24))
      ->capture_default_str();
  CLI::Option* samples = app.add_option("--reference-spp", settings.referenceSpp,
                                        "Samples per pixel of references; they are kept")
                             ->check(within(kSamplesPerPixel))
                             ->capture_default_str();
  app.add_option("--reference", settings.reference, "EXR file to use as the reference")->excludes(samples);
  app.add_option("--pixels", pixels, "Render images of about this many pixels")->check(within(kPixelCount));
  app.add_option("--max-depth", settings.maxDepth, "In place of the scenes'")->check(within(kMaxDepth));
  app.add_option("--rr-depth", settings.rrDepth, "In place of the scenes'")->check(within(kRouletteDepth));
  app.add_option("-o,--output", settings.folder, "Folder for report, results, references and images")
      ->required();
  CLI::Option* pictures =
      app.add_flag("--images", images, "Also write PNGs of seed 0, and one of all methods side by side");
  app.add_option("--exposure", exposure, "Of the PNGs, in stops")
      ->needs(pictures)
      ->check(within(kStops))
      ->capture_default_str();
  app.add_flag("--fresh", settings.fresh, "Forget earlier results; references are kept");
  app.add_option("--threads", threads, "0: one a core")->check(within(kThreadCount))->capture_default_str();
  app.add_flag("--wide", wide, "Print all columns; without it what fits in 100 letters");
  app.add_flag("-q,--quiet", quiet, "Print the tables, and what changes a scene's picture, only");
  part.addTo(app);
}

void CompareArguments::apply() {
  settings.methods = parseMethods(methods, threads);
  settings.spp = parseSampleCounts(spp);
  settings.load = part.loadOptions();
  if (settings.equalTime && settings.methods.size() < 2)
    throw UsageError("--equal-time is about a second method: there is only one");
  settings.load.pixels = pixels;
  if (pixels > 0 && (settings.load.resolution || settings.load.crop))
    throw UsageError("--pixels sets the size: it can't go with --resolution or --crop");
  if (!settings.reference.empty() && settings.scenes.size() > 1)
    throw UsageError("--reference is the image of one scene: it can't go with several");
  std::set<std::string> names;
  for (const std::string& scene : settings.scenes)
    if (!names.insert(eval::sceneName(scene)).second)
      throw UsageError(fmt::format("{}: two scenes are named \"{}\"", scene, eval::sceneName(scene)));
  if (denoise) settings.denoiser = std::make_shared<render::Denoiser>(threads);
}

std::vector<int> parseSampleCounts(const std::string& text) {
  const size_t count = size_t(std::count(text.begin(), text.end(), ',')) + 1;
  const auto counts = parseNumbers<int>(text, ',', count, kSamplesPerPixel);
  const bool rising =
      counts && std::adjacent_find(counts->begin(), counts->end(), std::greater_equal<>()) == counts->end();
  if (!rising)
    throw UsageError(
        fmt::format("--spp: found \"{}\", expected whole numbers from {} that rise, as in 4,8,16", text,
                    kSamplesPerPixel.text()));
  return *counts;
}

std::vector<eval::Method> parseMethods(const std::vector<std::string>& texts, int threads) {
  std::vector<eval::Method> methods;
  std::set<std::string> names;
  for (const std::string& text : texts) {
    const size_t equals = text.find('=');
    if (equals == 0 || equals == std::string::npos)
      throw UsageError(fmt::format("--methods: found \"{}\", expected name=options", text));
    eval::Method method{text.substr(0, equals), text.substr(equals + 1), {}};
    if (method.name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.") !=
        std::string::npos)
      throw UsageError(
          fmt::format("--methods: \"{}\": a name is made of letters, digits, - _ and .", method.name));
    if (!names.insert(method.name).second)
      throw UsageError(fmt::format("--methods: two methods are named \"{}\"", method.name));
    method.options = parseMethod(method.text);
    method.options.threads = threads;
    methods.push_back(std::move(method));
  }
  return methods;
}

}  // namespace odis::app
