// Rendering a scene: options in, images and statistics out.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <odis/guide.h>
#include <odis/networks.h>

#include "render/rivals/ppg_options.h"
#include "render/rivals/restir_options.h"
#include "render/scene/scene.h"

namespace odis::render {

enum class IntegratorKind { path, odis, ppg, openpgl, restir };
enum class SamplerKind { sobol, independent };
enum class GuideKind { network, histogram, oracle };
enum class RouletteKind { throughput, formula, network };
enum class LightChoiceKind { hierarchy, formula, network };
enum class ShadowRayKind { all, roulette };
enum class SampleSpread { automatic, even, adaptive };

struct RenderOptions {
  IntegratorKind integrator = IntegratorKind::odis;
  SamplerKind sampler = SamplerKind::sobol;
  int spp = 4;
  uint64_t seed = 0;
  int threads = 0;    // 0: one a core
  int maxDepth = -1;  // -1: unlimited; 1 is directly visible emission, as Mitsuba counts
  int rrDepth = 5;    // Russian roulette from this depth on
  // How the samples are spread over the pixels: as many for each, or more where the first ones differ more, for about as
  // many rays (odis/sample_counts.h). Automatic: adaptive for odis, even for others. Adaptive needs 4 samples per pixel.
  SampleSpread samples = SampleSpread::automatic;
  double timeLimit = 0;   // seconds; 0: none. The image then has as many whole passes as fitted in.
  bool variance = false;  // also estimate the variance of each pixel
  bool features = false;  // also write albedo, normals, position, depth, roughness

  int guideBounces = -1;  // how many vertices of a path are guided; -1: all, 1: the first
  PpgOptions ppg;         // ppg only
  RestirOptions restir;   // restir only

  // odis only
  GuideKind guide = GuideKind::network;
  std::shared_ptr<const Networks> networks;            // null: those that come with the library
  RouletteKind roulette = RouletteKind::formula;       // of the guided samples
  LightChoiceKind lights = LightChoiceKind::network;   // likewise
  ShadowRayKind shadowRays = ShadowRayKind::roulette;  // likewise
  // Guided samples per pixel that the guide learns from, too: it is rebuilt after 1, 3, 7, ... if as many are left.
  int refineSpp = 3;
  // Samples per pixel of the pilot; 0.25 is one sample per 2x2 pixels. 0: 0.25 where that is enough to learn from (the
  // image is large) and a whole sample would be dear (there are few), else 1.
  double pilotSpp = 0;
  int oracleSpp = 64;  // samples per pixel that the oracle's maps are made from
  GuideOptions guideOptions;
  double pilotWeight = -1;  // of a pilot sample relative to a guided one; -1: by predicted variance
  bool records = false;     // keep the pilot's vertices in the result, for those who want to learn from them
  bool guideFeatures = false;  // with `features`, also what the guide decided
};

// Told of progress from the rendering threads; asked whether to stop. Stopping ends after the current pass of
// tiles, with what there is.
class Progress {
 public:
  virtual ~Progress() = default;
  virtual void begin(const std::string& /*stage*/, uint64_t /*totalSamples*/) {}
  virtual void advance(uint64_t /*samples*/) {}
  virtual void end() {}
  virtual bool cancelled() const { return false; }
};

// Per-pixel images of the crop window, row 0 at the top.
struct Frame2D {
  int x = 0, y = 0, width = 0, height = 0;  // the crop, in pixels of the full image
  std::vector<Rgb> color;
  std::vector<Rgb> variance;  // of the pixel's mean; empty unless asked for
  std::vector<Rgb> albedo;    // features at the first non-delta vertex; empty unless asked for
  std::vector<Vec3> normal, geometricNormal, position;
  std::vector<float> depth, roughness;
  // What the guide has decided at that vertex: share of the BSDF, entropy of the map in bits, survival, cell; and how many
  // samples the pixel has. Empty unless asked for.
  std::vector<float> guideAlpha, guideEntropy, guideSurvival, guideCell, guideSamples;
};

struct RenderStats {
  double secondsPilot = 0, secondsBuild = 0,
         secondsGuided = 0;  // without a pilot: all but the build in the last
  uint64_t samples = 0, pilotSamples = 0, rays = 0, shadowRays = 0;
  uint64_t pilotVertices = 0, cells = 0;
  uint64_t bytesBuild = 0;  // held at most until the guide is built: pilot vertices and what is made of them
  uint64_t bytesMaps = 0, bytesLights = 0;
  double pilotWeight = 0;  // of the pilot's mean in the image
  double spp = 0;          // samples per pixel really taken
  // The time of a guided sample in that of a pilot sample, recording included; 0 if there was none of either.
  double guidedCost() const {
    const uint64_t guided = samples - pilotSamples;
    if (pilotSamples == 0 || guided == 0 || !(secondsPilot > 0)) return 0;
    return secondsGuided / double(guided) / (secondsPilot / double(pilotSamples));
  }
  bool interrupted = false;
};

struct RenderResult {
  Frame2D frame;
  RenderStats stats;
  // If asked for: the pilot's vertices, in the order of the tiles, and the emission that its camera rays met
  // (summed over a pixel's samples).
  std::vector<PilotVertex> records;
  std::vector<Rgb> pilotEmitted;
};

RenderResult render(const Scene& scene, const RenderOptions& options, Progress& progress);

// Traces the one path of `render` with these options that belongs to a pixel of the full image and a sample,
// and describes each of its vertices, a line each.
std::string replay(const Scene& scene, const RenderOptions& options, Vec2i pixel, int sample);

}  // namespace odis::render
