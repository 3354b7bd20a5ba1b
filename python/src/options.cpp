// GuideOptions and FrameOptions, whose fields are keyword arguments and attributes.
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <odis/odis.hpp>

#include "bindings.h"

namespace odis::python {

namespace {

using PriorSamples = std::array<float, ODIS_CELL_LEVELS>;
using Ranges = std::vector<std::pair<uint32_t, uint32_t>>;

PriorSamples priorSamples(const GuideOptions& options) {
  return std::to_array(options.priorSamples);
}
void setPriorSamples(GuideOptions& options, const PriorSamples& samples) {
  std::copy(samples.begin(), samples.end(), options.priorSamples);
}

Ranges lightParts(const GuideOptions& options) {
  Ranges ranges;
  for (const LightParts& parts : options.lightParts) ranges.emplace_back(parts.first, parts.count);
  return ranges;
}
void setLightParts(GuideOptions& options, const Ranges& ranges) {
  options.lightParts.clear();
  for (const auto& [first, count] : ranges) options.lightParts.push_back({first, count});
}

constexpr const char* kGuideOptions = R"(How guides are made of vertices; all fields are optional.

model: Model, by default the networks that come with the library
cells_per_diagonal: int >= 0 (32): the finest cells have an edge of (diagonal of what the first vertices
    span) / this; 0: there are no cells
prior_samples: four floats >= 0 (250, 250, 120, 30): weight of the coarser level when the formula blends its
    map with a finer one's, in samples, finest level first; the last is for the uniform map
floor: float in [0, 1] (0.03): share of the uniform distribution in every map
clamp: float > 0 (20): a sample counts at most this many times its neighbourhood's mean in maps
fixed_bsdf_fraction: float in [0, 1] (0): above 0 this BSDF sampling fraction everywhere, in place of the one
    by variance and cost
control_variate: bool (True): whether the mean outgoing radiance stands in for paths that roulette ends
cached_error: float >= 0 (0): above 0 paths may end with a cell's cached radiance, if they are off by less
    than this fraction of the pixel's value for it: images are biased then
pixel_maps: PixelMaps (NONE): what makes maps at pixels, which guide the first vertex of each path in frames
pixel_tile: int in [1, 16] (1): a map for each square of so many pixels a side
pixel_share: float in [0, 1] (1): share of a pixel's map; the rest is the map of its cell
pixel_direct_light: bool (True): whether histograms and oracles at pixels hold what next-event estimation
    covers
cosine_product: bool (True): whether maps are multiplied by the cosine at a vertex
max_depth: int (0): the host's limit of depth, for cached_error: vertices are scattered at depths 1 to
    max_depth - 1; 0: none
light_groups: int <= 32 (0): groups of lights that the vertices tell apart; 0: learn nothing about lights
light_parts: list of (first, count) ([]): groups that are equal parts of one light

Values out of their range raise Error (INVALID_ARGUMENT) where the options are used.)";

constexpr const char* kFrameOptions = R"(How an image is made; all fields but the size are optional.

width, height: int, of the image in pixels; below 2^31 pixels
samples_per_pixel: int >= 1 (4), pilot included
refinement_samples: int (3): guided samples per pixel that the guide learns from as well; it is rebuilt after
    1, 3, 7, ... of them where at least as many samples follow and rebuilding is worth its time; in frames
    with a `builder` whether it is worth it or not
seed: int (0), in [0, 2^64): chooses the pilot's pixels; the host's random numbers come from FramePass.seed
pilot_samples_per_pixel: float >= 0 (0): of the pilot; 0.25 is one sample in each 2 x 2 pixels; 0: 0.25 where
    that is enough to learn from, else 1
pilot_weight: float >= 0 (0.6): weight of a pilot sample relative to a guided one
oracle_samples: int (0): further samples per pixel that the guide is made from instead of the pilot's, and
    that are no part of the image
guided: bool (True); False: plain path tracing, without a pilot
adaptive: bool (True): whether pixels whose first samples differ more get more samples; from 4 samples per
    pixel on
guided_cost: float >= 0 (1): what a ray of a guided path takes, relative to one of an unguided path; where
    the first guided samples show that guiding does not pay, the others are not guided. 0: guides
    and refines in any case
built_cell_cost, recorded_ray_cost: float >= 0 (70, 0.15): what it takes to build a cell of the guide, and to
    record what one ray brings, in the time that a ray takes: whether refining pays
tile_offset_x, tile_offset_y: int in [0, 15] (0): tiles of 16 x 16 pixels begin this many pixels before the
    image's first column and row: 5 and 0 for a crop that begins at column 37 and row 16, so that its tiles
    are those of the whole image
guide: GuideOptions

Values out of their range raise Error (INVALID_ARGUMENT) where the options are used.)";

void bindGuideOptions(nb::module_& module) {
  const OdisGuideOptions defaults;
  nb::class_<GuideOptions>(module, "GuideOptions", kGuideOptions)
      .def(
          "__init__",
          [](GuideOptions* self, std::optional<Model> model, int32_t cellsPerDiagonal,
             const PriorSamples& samples, float floor, float clamp, float fixedBsdfFraction,
             bool controlVariate, float cachedError, OdisPixelMaps pixelMaps, uint32_t pixelTile,
             float pixelShare, bool pixelDirectLight, bool cosineProduct, uint32_t maxDepth,
             uint32_t lightGroups, const Ranges& parts) {
            new (self) GuideOptions{{}, model ? *model : Model(), {}};
            self->cellsPerDiagonal = cellsPerDiagonal;
            setPriorSamples(*self, samples);
            self->floor = floor;
            self->clamp = clamp;
            self->fixedBsdfFraction = fixedBsdfFraction;
            self->controlVariate = controlVariate;
            self->cachedError = cachedError;
            self->pixelMaps = pixelMaps;
            self->pixelTile = pixelTile;
            self->pixelShare = pixelShare;
            self->pixelDirectLight = pixelDirectLight;
            self->cosineProduct = cosineProduct;
            self->maxDepth = maxDepth;
            self->lightGroups = lightGroups;
            setLightParts(*self, parts);
          },
          nb::kw_only(), "model"_a = nb::none(), "cells_per_diagonal"_a = defaults.cellsPerDiagonal,
          "prior_samples"_a = std::to_array(defaults.priorSamples), "floor"_a = defaults.floor,
          "clamp"_a = defaults.clamp, "fixed_bsdf_fraction"_a = defaults.fixedBsdfFraction,
          "control_variate"_a = defaults.controlVariate, "cached_error"_a = defaults.cachedError,
          "pixel_maps"_a = ODIS_PIXEL_MAPS_NONE, "pixel_tile"_a = defaults.pixelTile,
          "pixel_share"_a = defaults.pixelShare, "pixel_direct_light"_a = defaults.pixelDirectLight,
          "cosine_product"_a = defaults.cosineProduct, "max_depth"_a = defaults.maxDepth,
          "light_groups"_a = defaults.lightGroups, "light_parts"_a = Ranges())
      .def_rw("model", &GuideOptions::model)
      .def_rw("cells_per_diagonal", &GuideOptions::cellsPerDiagonal)
      .def_prop_rw("prior_samples", priorSamples, setPriorSamples)
      .def_rw("floor", &GuideOptions::floor)
      .def_rw("clamp", &GuideOptions::clamp)
      .def_rw("fixed_bsdf_fraction", &GuideOptions::fixedBsdfFraction)
      .def_rw("control_variate", &GuideOptions::controlVariate)
      .def_rw("cached_error", &GuideOptions::cachedError)
      .def_prop_rw(
          "pixel_maps", [](const GuideOptions& self) { return OdisPixelMaps(self.pixelMaps); },
          [](GuideOptions& self, OdisPixelMaps maps) { self.pixelMaps = maps; })
      .def_rw("pixel_tile", &GuideOptions::pixelTile)
      .def_rw("pixel_share", &GuideOptions::pixelShare)
      .def_rw("pixel_direct_light", &GuideOptions::pixelDirectLight)
      .def_rw("cosine_product", &GuideOptions::cosineProduct)
      .def_rw("max_depth", &GuideOptions::maxDepth)
      .def_rw("light_groups", &GuideOptions::lightGroups)
      .def_prop_rw("light_parts", lightParts, setLightParts);
}

void bindFrameOptions(nb::module_& module) {
  const OdisFrameOptions defaults;
  nb::class_<FrameOptions>(module, "FrameOptions", kFrameOptions)
      .def(
          "__init__",
          [](FrameOptions* self, uint32_t width, uint32_t height, uint32_t samplesPerPixel,
             uint32_t refinementSamples, uint64_t seed, double pilotSamplesPerPixel, float pilotWeight,
             uint32_t oracleSamples, bool guided, bool adaptive, float guidedCost, float builtCellCost,
             float recordedRayCost, uint32_t tileOffsetX, uint32_t tileOffsetY,
             std::optional<GuideOptions> guide) {
            new (self) FrameOptions{{}, guide ? *guide : GuideOptions()};
            self->width = width;
            self->height = height;
            self->samplesPerPixel = samplesPerPixel;
            self->refinementSamples = refinementSamples;
            self->seed = seed;
            self->pilotSamplesPerPixel = pilotSamplesPerPixel;
            self->pilotWeight = pilotWeight;
            self->oracleSamples = oracleSamples;
            self->guided = guided;
            self->adaptive = adaptive;
            self->guidedCost = guidedCost;
            self->builtCellCost = builtCellCost;
            self->recordedRayCost = recordedRayCost;
            self->tileOffsetX = tileOffsetX;
            self->tileOffsetY = tileOffsetY;
          },
          "width"_a, "height"_a, nb::kw_only(), "samples_per_pixel"_a = defaults.samplesPerPixel,
          "refinement_samples"_a = defaults.refinementSamples, "seed"_a = defaults.seed,
          "pilot_samples_per_pixel"_a = defaults.pilotSamplesPerPixel,
          "pilot_weight"_a = defaults.pilotWeight, "oracle_samples"_a = defaults.oracleSamples,
          "guided"_a = defaults.guided, "adaptive"_a = defaults.adaptive,
          "guided_cost"_a = defaults.guidedCost, "built_cell_cost"_a = defaults.builtCellCost,
          "recorded_ray_cost"_a = defaults.recordedRayCost, "tile_offset_x"_a = defaults.tileOffsetX,
          "tile_offset_y"_a = defaults.tileOffsetY, "guide"_a = nb::none())
      .def_rw("width", &FrameOptions::width)
      .def_rw("height", &FrameOptions::height)
      .def_rw("samples_per_pixel", &FrameOptions::samplesPerPixel)
      .def_rw("refinement_samples", &FrameOptions::refinementSamples)
      .def_rw("seed", &FrameOptions::seed)
      .def_rw("pilot_samples_per_pixel", &FrameOptions::pilotSamplesPerPixel)
      .def_rw("pilot_weight", &FrameOptions::pilotWeight)
      .def_rw("oracle_samples", &FrameOptions::oracleSamples)
      .def_rw("guided", &FrameOptions::guided)
      .def_rw("adaptive", &FrameOptions::adaptive)
      .def_rw("guided_cost", &FrameOptions::guidedCost)
      .def_rw("built_cell_cost", &FrameOptions::builtCellCost)
      .def_rw("recorded_ray_cost", &FrameOptions::recordedRayCost)
      .def_rw("tile_offset_x", &FrameOptions::tileOffsetX)
      .def_rw("tile_offset_y", &FrameOptions::tileOffsetY)
      .def_rw("guide", &FrameOptions::guide);
}

}  // namespace

void bindOptions(nb::module_& module) {
  nb::enum_<OdisPixelMaps>(module, "PixelMaps", "What makes maps at pixels.")
      .value("NONE", ODIS_PIXEL_MAPS_NONE)
      .value("HISTOGRAM", ODIS_PIXEL_MAPS_HISTOGRAM)
      .value("NETWORK", ODIS_PIXEL_MAPS_NETWORK)
      .value("ORACLE", ODIS_PIXEL_MAPS_ORACLE);
  bindGuideOptions(module);
  bindFrameOptions(module);
}

}  // namespace odis::python
