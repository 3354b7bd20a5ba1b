// What a rendering is asked for.
#pragma once

#include <odis/odis.hpp>

#include "render/film/film_settings.h"
#include "render/rivals/ppg_options.h"
#include "render/rivals/restir_options.h"
#include "render/sampler/sampler_kind.h"

namespace odis::render {

enum class IntegratorKind { path, odis, ppg, openpgl, restir };
enum class GuideKind { network, histogram, oracle };
enum class RouletteKind { throughput, formula };
enum class LightChoiceKind { hierarchy, formula, network };
enum class ShadowRayKind { all, roulette };
enum class SampleSpread { automatic, even, adaptive };

// How a rendering that may be killed is kept. Only `path` and `odis` can be.
struct SavingOptions {
  std::string file;         // where all that there is goes to; empty: nowhere
  double everySeconds = 0;  // how often; when the rendering is interrupted as well
  std::string resumeFrom;   // a file that the rendering goes on with; empty: it begins
  // What is rendered: lines of "name: value". A rendering goes on with a file of the same subject only.
  std::string subject;
};

// What operations cost that a guided frame decides about, in the time that a ray of an unguided path takes
// with all that is computed where it arrives.
struct OperationCosts {
  float guidedRay = 1;        // a ray of a guided path; 0: guides and refines in any case
  float builtCell = 70;       // building a cell of the guide
  float recordedRay = 0.15f;  // recording what one ray brings
};

struct RenderOptions {
  IntegratorKind integrator = IntegratorKind::odis;
  SamplerKind sampler = SamplerKind::sobol;
  // Filters that are not splatted (filmKindFor) are drawn from in any case.
  FilmKind film = FilmKind::pixels;
  int spp = 4;
  uint64_t seed = 0;
  int threads = 0;    // 0: one a core
  int maxDepth = -1;  // -1: unlimited; 1 is directly visible emission, as Mitsuba counts
  int rrDepth = 5;    // Russian roulette from this depth on
  // How the samples are spread over the pixels: as many for each, or more where the first ones differ more,
  // for about as many rays (odis/sample_counts.h). Automatic: adaptive for odis, even for others. Adaptive
  // needs 4 samples per pixel.
  SampleSpread samples = SampleSpread::automatic;
  double timeLimit = 0;   // seconds; 0: none. The image then has as many whole passes as fitted in.
  SavingOptions saving;   // path and odis only
  bool variance = false;  // also estimate the variance of each pixel
  bool features = false;  // also write albedo, normals, position, depth, roughness

  int guideBounces =
      -1;          // how many vertices of a path are guided, of those that may be; -1: all, 1: the first
  PpgOptions ppg;  // ppg only
  RestirOptions restir;  // restir only

  // odis only
  GuideKind guide = GuideKind::network;
  Model model;  // the networks, or what stands for them
  // The network for maps at pixels that comes with ODIS, by name; empty: that of `model`.
  std::string pixelNetwork;
  RouletteKind roulette = RouletteKind::formula;       // of the guided samples
  LightChoiceKind lights = LightChoiceKind::network;   // likewise
  ShadowRayKind shadowRays = ShadowRayKind::roulette;  // likewise
  // Guided samples per pixel that the guide learns from, too. It is rebuilt after 1, 3, 7, ... of them where
  // at least as many samples follow and rebuilding is worth its time.
  int refineSpp = 3;
  // Samples per pixel of the pilot; 0.25 is one sample per 2x2 pixels. 0: 0.25 where that is enough to
  // learn from (the image is large) and a whole sample would be dear (there are few), else 1.
  double pilotSpp = 0;
  int oracleSpp = 64;  // samples per pixel that the oracle's maps are made from
  GuideOptions guideOptions;
  OperationCosts costs;
  double pilotWeight = 0.6;  // of a pilot sample relative to a guided one
  // Whether paths may end with the cached radiance of cells, which biases the image. The error that they may
  // make is guideOptions.cachedError, or, where that is 0, one that falls with the number of samples.
  bool cached = false;
  bool records = false;  // keep the pilot's vertices in the result, for those who want to learn from them
  bool guideFeatures = false;  // with `features`, also what the guide decided
};

}  // namespace odis::render
