// Comparing methods: each renders each scene with several seeds; errors are taken against one reference a
// scene.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "eval/metrics.h"
#include "render/integrator/render.h"

namespace odis::eval {

// One way to render: the options of `odis render` as text, which names its results, and what they mean.
struct Method {
  std::string name;
  std::string text;
  render::RenderOptions options;
};

struct CompareSettings {
  std::vector<std::string> scenes;
  std::vector<Method> methods;  // ratios are to the first
  int seeds = 8;                // 0 .. seeds - 1
  int spp = 4;
  int referenceSpp = 1024;
  std::string reference;                 // an EXR file to use instead, "" for none; for one scene
  std::optional<int> maxDepth, rrDepth;  // replace the scene's
  render::LoadOptions load;
  int pixels = 0;       // size of the images at the scene's aspect ratio; 0: as the scene or `load` has it
  bool images = false;  // write the images of seed 0 as EXR and PNG, and a picture of all side by side
  float exposure = 0;   // of these PNGs, in stops
  bool fresh = false;   // forget earlier results
  std::string folder;   // where results, references and images go
};

// One rendering.
struct Measurement {
  std::string scene, method;
  uint64_t seed = 0;
  std::string key;  // hash of everything that the result depends on
  ErrorMetrics error;
  double seconds = 0, spp = 0;
  uint64_t rays = 0;  // shadow rays included
  std::string image;  // the PNG, "" if none was written
};

// Told of what is being done; its Progress is the one that rendering reports to.
class CompareObserver {
 public:
  virtual ~CompareObserver() = default;
  virtual void start(const std::string& what) = 0;
  virtual void warnings(const render::Warnings& warnings) = 0;
  virtual render::Progress& progress() = 0;
};

// Renders what is not yet in folder/results.jsonl, to which each result is added as it comes, and returns all
// results in the order scene, seed, method: methods take turns, so that a noisy machine is noisy for all.
// Ends early if progress is cancelled. Throws SceneError, std::runtime_error.
std::vector<Measurement> compare(const CompareSettings& settings, CompareObserver& observer);

// A scene's name in tables and files: its file's stem, or its folder's name if that is only "scene".
std::string sceneName(const std::string& path);

}  // namespace odis::eval
