"""Settings of `odis` in Mitsuba: those of the library (odis.settings(); docs/settings.md), presets included."""

from dataclasses import dataclass

import odis

# Time of a ray of a guided path over that of a ray of another, in the kernels; and that of a cell, with its tables.
GUIDED_COST, BUILT_CELL_COST = 1.4, 150
# With fewer samples per pixel the time that many cells take is not made up for by what they know, unless paths end there.
FEW_SAMPLES, CELLS_OF_FEW_SAMPLES = 8, 24
PRESETS = next(setting for setting in odis.settings() if setting.name == "preset").values.split("|")


@dataclass
class GivenSettings:
    """What was set by name; what is not set is as the library has it."""

    text: str

    @classmethod
    def read(cls, preset, text):
        """Those of a preset, and of a text of words key=value, of which later ones win. Raises ValueError."""
        if preset not in PRESETS:
            raise ValueError(f"odis: preset: expected one of {', '.join(PRESETS)}, found {preset}")
        settings = cls(f"guided-cost={GUIDED_COST} built-cell-cost={BUILT_CELL_COST} preset={preset} {text}")
        try:
            oracle = "oracle" in (settings["guide"], settings["pixel-maps"])
        except odis.Error as error:
            raise ValueError(f"odis: settings: {error}") from None
        if oracle:
            raise ValueError("odis: settings: there is no oracle in Mitsuba")
        return settings

    def __getitem__(self, name):
        return odis.read_setting(self.text, name)

    def of_paths(self):
        """What the kernels are compiled for: fields of path.Settings."""
        return {"guide_bounces": int(self["guide-bounces"]), "learned_roulette": self["roulette"] == "formula",
                "shadow_roulette": self["shadow-rays"] == "roulette"}

    def frame_options(self, size, spp, seed, lights, cached, max_depth):
        """odis.FrameOptions of an image of this width and height. lights: LightTable; cached: whether paths may end with
        cached radiance; max_depth: Mitsuba's."""
        learned = {} if self["lights"] == "hierarchy" else {"light_groups": lights.groups, "light_parts": lights.parts}
        cells = f"cells={CELLS_OF_FEW_SAMPLES} " if spp < FEW_SAMPLES and not cached else ""
        return odis.FrameOptions(
            *size, samples_per_pixel=spp, seed=seed, guide=odis.GuideOptions(**learned),
            settings=f"{cells}{self.text} cached={'on' if cached else 'off'} max-depth={max(max_depth, 0)}")
