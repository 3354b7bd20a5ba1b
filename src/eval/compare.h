// Comparing methods: each renders each scene with several numbers of samples and several seeds; errors are
// taken against one reference a scene.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "eval/measurement.h"
#include "render/denoise/denoiser.h"
#include "render/integrators/render.h"

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
  std::vector<int> spp{4};      // ascending
  bool equalTime = false;       // the other methods also with what fits in the first one's time
  // Every image is measured denoised as well; null: none is. All methods share albedo and normals: those of
  // plain path tracing with as many samples and the same seed.
  std::shared_ptr<const render::Denoiser> denoiser;
  int referenceSpp = 1024;
  std::string reference;                 // an EXR file to use instead, "" for none; for one scene
  std::optional<int> maxDepth, rrDepth;  // replace the scene's
  render::LoadOptions load;
  bool fresh = false;  // forget earlier results
  std::string folder;  // where results, references and images go
};

// A scene as it was rendered.
struct SceneRecord {
  std::string name, file;
  uint64_t hash = 0;
  int width = 0, height = 0, maxDepth = 0, rrDepth = 0;
  std::string reference;                         // EXR file
  std::string referenceSettings;                 // what it is, in words
  std::optional<ReferenceError> referenceError;  // of the reference itself, where its file tells
};

struct Comparison {
  std::vector<SceneRecord> scenes;
  // In the order scene, seed, samples, method, denoised; then, scene by scene, those at equal time.
  std::vector<Measurement> measurements;
};

// How far a comparison has come.
struct Outlook {
  int done = 0, total = 0;  // renderings, references included
  double secondsLeft = 0;   // by what similar ones took; 0 as long as that is not known
};

// Told of what is being done; its Progress is the one that rendering reports to.
class CompareObserver {
 public:
  virtual ~CompareObserver() = default;
  // Before the first reference: how long all of it may take, by one sample per pixel of the first scene.
  virtual void begin(const Outlook& /*outlook*/) {}
  virtual void start(const std::string& what, const Outlook& outlook) = 0;
  virtual void warnings(const std::string& scene, const render::Warnings& warnings) = 0;
  virtual render::Progress& progress() = 0;
};

// Renders what is not yet in folder/results.jsonl, to which each result is added as it comes. Methods take
// turns, so that a noisy machine is noisy for all. The images of seed 0 are kept in folder/images.
// Ends early, with what there is, if progress is cancelled. Throws SceneError, std::runtime_error.
Comparison compare(const CompareSettings& settings, CompareObserver& observer);

// A scene's name in tables and files: its file's stem, or its folder's name if that is only "scene".
std::string sceneName(const std::string& path);

}  // namespace odis::eval
