// GuideOptions and FrameOptions, whose fields are keyword arguments and attributes; the table of settings.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <odis/odis.hpp>

#include "printing.h"

namespace odis::python {

namespace {

using Ranges = std::vector<std::pair<uint32_t, uint32_t>>;

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

model: Model; None: the networks that come with the library
light_groups: int <= 128 (0): groups of lights that the vertices tell apart; 0: learn nothing about lights
light_parts: list of (first, count) ([]): groups that are equal parts of one light
settings: str (""): all that hardly any host changes, by name: words like "cells=64 map-floor=0.05" with
    blanks between them, of which later ones win (odis.settings() lists them)

Values out of their range raise Error (INVALID_ARGUMENT) where the options are used.)";

constexpr const char* kFrameOptions = R"(How an image is made; all fields but the size are optional.

width, height: int, of the image in pixels; below 2^31 pixels
samples_per_pixel: int >= 1 (4), pilot included
most_samples_per_pixel: int (0): how many Frame.extend may ask for later, with the same image as if they had
    been asked for at once: all decisions go by it; samples_per_pixel to 2^28, or UNLIMITED; 0:
    samples_per_pixel
seed: int (0), in [0, 2^64): chooses the pilot's pixels; the host's random numbers come from FramePass.seed
tile_offset_x, tile_offset_y: int in [0, 15] (0): tiles of 16 x 16 pixels begin this many pixels before the
    image's first column and row: 5 and 0 for a crop that begins at column 37 and row 16, so that its tiles
    are those of the whole image
guide: GuideOptions
settings: str (""): as in GuideOptions, those of frames and of guides

Values out of their range raise Error (INVALID_ARGUMENT) where the options are used.)";

void bindGuideOptions(nb::module_& module) {
  const GuideOptions defaults;
  nb::class_<GuideOptions> options(module, "GuideOptions", kGuideOptions);
  options
      .def(
          "__init__",
          [](GuideOptions* self, std::optional<Model> model, uint32_t lightGroups, const Ranges& parts,
             std::string settings) {
            new (self) GuideOptions();
            self->model = std::move(model);
            self->lightGroups = lightGroups;
            self->settings = std::move(settings);
            setLightParts(*self, parts);
          },
          nb::kw_only(), "model"_a = nb::none(), "light_groups"_a = defaults.lightGroups,
          "light_parts"_a = Ranges(), "settings"_a = "")
      .def_rw("model", &GuideOptions::model, nb::arg("value").none())
      .def_rw("light_groups", &GuideOptions::lightGroups)
      .def_prop_rw("light_parts", lightParts, setLightParts)
      .def_rw("settings", &GuideOptions::settings);
  printAttributes(options, {"model", "light_groups", "light_parts", "settings"});
}

void bindFrameOptions(nb::module_& module) {
  const FrameOptions defaults;
  nb::class_<FrameOptions> options(module, "FrameOptions", kFrameOptions);
  options
      .def(
          "__init__",
          [](FrameOptions* self, uint32_t width, uint32_t height, uint32_t samplesPerPixel,
             uint32_t mostSamplesPerPixel, uint64_t seed, uint32_t tileOffsetX, uint32_t tileOffsetY,
             const std::optional<GuideOptions>& guide, std::string settings) {
            new (self) FrameOptions();
            self->width = width;
            self->height = height;
            self->samplesPerPixel = samplesPerPixel;
            self->mostSamplesPerPixel = mostSamplesPerPixel;
            self->seed = seed;
            self->tileOffsetX = tileOffsetX;
            self->tileOffsetY = tileOffsetY;
            if (guide) self->guide = *guide;
            self->settings = std::move(settings);
          },
          "width"_a, "height"_a, nb::kw_only(), "samples_per_pixel"_a = defaults.samplesPerPixel,
          "most_samples_per_pixel"_a = defaults.mostSamplesPerPixel, "seed"_a = defaults.seed,
          "tile_offset_x"_a = defaults.tileOffsetX, "tile_offset_y"_a = defaults.tileOffsetY,
          "guide"_a = nb::none(), "settings"_a = "")
      .def_rw("width", &FrameOptions::width)
      .def_rw("height", &FrameOptions::height)
      .def_rw("samples_per_pixel", &FrameOptions::samplesPerPixel)
      .def_rw("most_samples_per_pixel", &FrameOptions::mostSamplesPerPixel)
      .def_rw("seed", &FrameOptions::seed)
      .def_rw("tile_offset_x", &FrameOptions::tileOffsetX)
      .def_rw("tile_offset_y", &FrameOptions::tileOffsetY)
      .def_rw("guide", &FrameOptions::guide)
      .def_rw("settings", &FrameOptions::settings);
  printAttributes(options, {"width", "height", "samples_per_pixel", "most_samples_per_pixel", "seed",
                            "tile_offset_x", "tile_offset_y", "guide", "settings"});
}

void bindSettings(nb::module_& module) {
  nb::enum_<OdisSettingOwner>(module, "SettingOwner", "What a setting is about.")
      .value("ALL", ODIS_SETTING_OF_ALL)
      .value("FRAMES", ODIS_SETTING_OF_FRAMES)
      .value("GUIDES", ODIS_SETTING_OF_GUIDES)
      .value("PATHS", ODIS_SETTING_OF_PATHS);
  nb::class_<Setting> setting(module, "Setting", R"(A row of the table of settings.

name: str
values: str, what it may be: "0 to 1", "roulette|all"
default: str
help: str, a line
owner: SettingOwner; settings of PATHS are read by the host (read_setting)
research: bool: it takes the method apart; users have no use for it)");
  setting.def_ro("name", &Setting::name)
      .def_ro("values", &Setting::values)
      .def_ro("default", &Setting::defaultValue)
      .def_ro("help", &Setting::help)
      .def_ro("owner", &Setting::owner)
      .def_ro("research", &Setting::research);
  printAttributes(setting, {"name", "values", "default", "help", "owner", "research"});
  module.def("settings", &odis::settings, "The table of all settings: a list of Setting.");
  module.def("read_setting", &odis::readSetting, "settings"_a, "name"_a,
             R"(The value that a text of settings gives to the one of this name, or its default.

Raises Error (INVALID_ARGUMENT) if there is no such setting, or a value in the text that is none.)");
}

}  // namespace

void bindOptions(nb::module_& module) {
  module.attr("UNLIMITED") = ODIS_UNLIMITED;
  bindSettings(module);
  bindGuideOptions(module);
  bindFrameOptions(module);
}

}  // namespace odis::python
