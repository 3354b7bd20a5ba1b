// What a rendering is asked for.
#pragma once

#include <odis/odis.hpp>

#include <optional>
#include <string>

#include "render/film/film_settings.h"
#include "render/rivals/ppg_options.h"
#include "render/rivals/restir_options.h"
#include "render/sampler/sampler_kind.h"

namespace odis::render {

enum class IntegratorKind { path, odis, ppg, openpgl, restir };

// How a rendering that may be killed is kept. Only `path` and `odis` can be.
struct SavingOptions {
  std::string file;         // where all that there is goes to; empty: nowhere
  double everySeconds = 0;  // how often; when the rendering is interrupted as well
  std::string resumeFrom;   // a file that the rendering goes on with; empty: it begins
  // What is rendered: lines of "name: value". A rendering goes on with a file of the same subject only.
  std::string subject;
};

struct RenderOptions {
  IntegratorKind integrator = IntegratorKind::odis;
  SamplerKind sampler = SamplerKind::sobol;
  // Filters that are not splatted (filmKindFor) are drawn from in any case.
  FilmKind film = FilmKind::pixels;
  int spp = 4;
  uint64_t seed = 0;
  int threads = 0;        // 0: one a core
  int maxDepth = -1;      // -1: unlimited; 1 is directly visible emission, as Mitsuba counts
  int rrDepth = 5;        // Russian roulette from this depth on
  double timeLimit = 0;   // seconds; 0: none. The image then has as many whole passes as fitted in.
  SavingOptions saving;   // path and odis only
  bool variance = false;  // also estimate the variance of each pixel
  bool features = false;  // also write albedo, normals, position, depth, roughness

  // What is set by name, as "samples=even guide-bounces=1" (odis/odis.h; docs/settings.md). path heeds
  // `samples`, ppg and openpgl `guide-bounces`, odis all of it.
  std::string settings;
  PpgOptions ppg;        // ppg only
  RestirOptions restir;  // restir only

  // odis only
  std::optional<Model> model;  // none: the networks that come with the library
  bool records = false;  // keep the pilot's vertices in the result, for those who want to learn from them
  bool guideFeatures = false;  // with `features`, also what the guide decided

  // Sets more by name; wins over what was set before.
  void set(const std::string& text) { settings += (settings.empty() ? "" : " ") + text; }
  // What is set, or its default.
  std::string setting(const std::string& name) const { return readSetting(settings, name); }
  double settingNumber(const std::string& name) const { return std::stod(setting(name)); }
};

}  // namespace odis::render
