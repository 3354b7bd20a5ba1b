// The options of `odis render` that say how to render; `odis compare` takes them for each of its methods.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/integrators/render.h"

namespace CLI {
class App;
}

namespace odis::app {

// How a method differs from another: everything but the scene, the number of samples and the outputs.
struct MethodArguments {
  std::string integrator = "odis", sampler = "sobol", preset = "default", weights;
  std::string film;  // splat, pixels; empty: what the command takes by default
  bool cached = false;
  std::vector<std::string> settings;  // "key=value" each

  void addTo(CLI::App& app);
  // Throws UsageError.
  void apply(render::RenderOptions& options) const;
};

// Which scene, and which part and size of it.
struct SceneArguments {
  std::vector<std::string> defines;
  std::string resolution, crop;
  bool strict = false;  // whether what changes the picture is an error

  void addTo(CLI::App& app);
  // Throws UsageError.
  render::LoadOptions loadOptions() const;
};

// The whole of `odis render`.
struct RenderArguments {
  std::string scene, output, png, aov, statsFile, recordsFile, tev, replay, resume;
  std::optional<int> spp, maxDepth, rrDepth;
  uint64_t seed = 0;
  int threads = 0;
  double timeLimit = 0, saveMinutes = 0;
  float exposure = 0;
  bool denoise = false, variance = false, stats = false, quiet = false, verbose = false;
  MethodArguments method;
  SceneArguments part;
  std::string commandLine;

  void addTo(CLI::App& app);
};

// "640x360" and "0,0,64,64" as numbers; throw UsageError.
render::Vec2i parseResolution(const std::string& text);
render::Crop parseCrop(const std::string& text);
// "key=value"; throws UsageError.
std::pair<std::string, std::string> parseDefine(const std::string& text);
// The options that a text like "--integrator odis --set guide-bounces=1" stands for; throws UsageError.
render::RenderOptions parseMethod(const std::string& text);

}  // namespace odis::app
