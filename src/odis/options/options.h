// What a frame and its guide are asked for. The first fields of each are those of OdisFrameOptions and
// OdisGuideOptions; the others are set by name (odis/options/settings.h), and their defaults stand here
// alone.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "odis/models/model.h"
#include "odis/structs.h"
#include "odis/view.h"

namespace odis::core {

// What makes the maps of cells: the model's network, the formula that blends histograms, or that formula from
// samples that are no part of the image.
enum class GuideKind { network, histogram, oracle };
// What chooses lights by what the pilot saw: the model's network, a formula, or nothing.
enum class LightChoiceKind { network, formula, hierarchy };
// What makes maps at pixels: the pilot's samples around, a network that sees them (Bako et al. 2019), or each
// pixel's own samples of the oracle.
enum class PixelMapKind { none, histogram, network, oracle };
// Whether all pixels have as many samples. Automatic: unevenly where the frame is guided.
enum class SampleSpread { automatic, even, adaptive };

struct GuideOptions {
  std::optional<Model> model;  // none: the networks that come with the library
  uint32_t lightGroups = 0;    // that the vertices tell apart, <= 128; 0: learn nothing about lights
  std::vector<OdisLightParts> lightParts;
  OdisProgressFunction progressFunction = nullptr;
  void* progressUser = nullptr;

  GuideKind guide = GuideKind::network;
  LightChoiceKind lights = LightChoiceKind::network;
  int32_t cellsPerDiagonal = 32;
  // Weight of the coarser level when the formula blends its map with a finer one's, in samples, for each
  // level, finest first; the last one is for the uniform map.
  std::array<float, kCellLevels> priorSamples{250, 250, 120, 30};
  float floor = 0.03f;          // share of the uniform distribution in every map
  float clamp = 20;             // a sample counts at most this many times its neighbourhood's mean in maps
  float fixedBsdfFraction = 0;  // > 0: everywhere, in place of the one by variance and cost
  bool controlVariate = true;   // whether the mean outgoing radiance stands in for paths that roulette ends
  bool cached = false;          // whether paths may end with cached radiance
  float cachedError = 0;        // how far off they may be then, over the pixel's value; 0: by the samples
  uint32_t maxDepth = 0;        // of the host's paths; 0: none
  PixelMapKind pixelMaps = PixelMapKind::none;
  std::string pixelNetwork;      // by name; empty: the model's
  uint32_t pixelTile = 1;        // a map for each square of so many pixels a side
  float pixelShare = 1;          // of a pixel's map in what guides there; the rest is its cell's
  bool pixelDirectLight = true;  // whether maps at pixels tell of what next-event estimation covers
  bool alwaysMaps = false;       // whether there are maps of all cells even where they save little
  bool cosineProduct = true;     // whether maps are multiplied by the cosine at a vertex

  // Whether paths end with cached radiance.
  bool caches() const {
    return cached && cellsPerDiagonal > 0 && (maxDepth == 0 || maxDepth >= ODIS_LEAST_CACHED_MAX_DEPTH);
  }
};

struct FrameOptions {
  uint32_t width = 0, height = 0;
  uint32_t samplesPerPixel = OdisFrameOptions().samplesPerPixel;
  uint32_t mostSamplesPerPixel = 0;  // 0: samplesPerPixel
  uint64_t seed = 0;
  bool keepPixelMeans = true;
  uint32_t tileOffsetX = 0, tileOffsetY = 0;
  GuideOptions guide;  // of a frame without a builder of the host's

  bool guided = true;
  SampleSpread samples = SampleSpread::automatic;
  uint32_t refinementSamples = 3;
  double pilotSamplesPerPixel = 0;
  float pilotWeight = 0.6f;
  uint32_t oracleSpp = 64;  // of an oracle, where something is made from one
  bool keepPilotVertices = false;
  float guidedCost = 1, builtCellCost = 70, recordedRayCost = 0.15f;

  // How many samples per pixel decisions go by. Those for an unlimited number are those for a million.
  uint32_t most() const {
    const uint32_t most = mostSamplesPerPixel == ODIS_UNLIMITED ? 1u << 20 : mostSamplesPerPixel;
    return std::max(most, samplesPerPixel);
  }
  bool adaptive() const {
    return samples == SampleSpread::adaptive || (samples == SampleSpread::automatic && guided);
  }
  // Samples per pixel of the oracle.
  uint32_t oracleSamples() const {
    return guide.guide == GuideKind::oracle || guide.pixelMaps == PixelMapKind::oracle ? oracleSpp : 0;
  }
};

}  // namespace odis::core
